# SPDX-License-Identifier: GPL-2.0-or-later
"""Periodic assembly of hard balls: compressed to a pressure, then sheared at that pressure.

    PYTHONPATH=build/python yade -n -x scripts/validation/periodic.py [grains=5000] [friction=0] [steps=2500] [shear=0] [seed=1] [sweeps=300] [h=0.05] [last=50] [in=FILE] [out=FILE]

Compression starts from a gas (packing fraction 0.3) of balls with radii 0.9 ... 1.1, at three equal pressures and without shear; its rate is bounded
to 0.3 / t_i, t_i = d sqrt(density / pressure). The first 200 steps are made at the default tolerance with h = 0.03 t_i, the others at 1e-5 with `h` t_i and
at most `sweeps` sweeps: the packing settles over many steps, and each goes on where the last one stopped. The `last` steps may take all the sweeps that they
need; their stress and coordination are the result. Then `shear` steps of simple shear at the rate 1e-3 / t_i at constant normal stress in all three
directions. `out` saves the compressed packing, `in` starts from such a file (steps=0 for shear alone). Printed: stress against its goal, packing fraction, coordination number
without rattlers (contacts per grain, grains with fewer than 4 contacts, with friction 2, left out until none is left).
"""

import math
import sys
import time

import numpy as np
from yade import FrictMat, Matrix3, O, Vector3, pack, utils

import contactdynamics

options = dict(grains="5000", friction="0", steps="2500", shear="0", seed="1", sweeps="300", h="0.05", last="50", out="")
options["in"] = ""
options.update(argument.split("=", 1) for argument in sys.argv[1:])
count, friction, seed = int(options["grains"]), float(options["friction"]), int(options["seed"])
radius, density, pressure = 0.01, 2600.0, 1e3
inertial = 2 * radius * math.sqrt(density / pressure)


def coordination(least: int) -> tuple[float, int]:
    """Contacts per grain without rattlers, and their number."""
    pairs = np.array([(c.id1, c.id2) for c in O.interactions if c.isReal and c.phys.normalForce.squaredNorm() > 0])
    alive = np.ones(len(O.bodies), bool)
    while True:
        kept = pairs[alive[pairs].all(axis=1)]
        contacts = np.bincount(kept.ravel(), minlength=len(alive))
        loose = alive & (contacts < least)
        if not loose.any():
            return contacts.sum() / alive.sum(), int((~alive).sum())
        alive &= ~loose


def tell(step: int) -> None:
    """One line on the present step."""
    stress = utils.getStress()
    z, rattlers = coordination(4 if friction == 0 else 2)
    print(
        f"{step:6d}  stress/goal {' '.join(f'{-stress[i, i] / pressure:.5f}' for i in range(3))}  shear stress/p {stress[0, 1] / pressure:+.4f}"
        f"  fraction {1 - utils.porosity():.5f}  z {z:.3f}  rattlers {rattlers}  residual {cd.residual:.1e}"
        f"  overlap/r {cd.maxPenetration / radius:.1e}  cpu {time.process_time() - start:.0f} s",
        flush=True,
    )


def gas() -> None:
    """Balls apart from each other in a periodic cell under pressure."""
    length = (count * 4 / 3 * math.pi * radius**3 / 0.3) ** (1 / 3)
    O.periodic = True
    O.cell.setBox(length, length, length)
    O.materials.append(FrictMat(density=density, frictionAngle=math.atan(friction)))
    balls = pack.SpherePack()
    made = balls.makeCloud(Vector3(0, 0, 0), Vector3(length, length, length), rMean=radius, rRelFuzz=0.1, num=count, periodic=True, seed=seed)
    balls.toSimulation(material=O.materials[0])
    control = contactdynamics.ContactDynamicsCellController(
        stress=Matrix3(-pressure, 0, 0, 0, -pressure, 0, 0, 0, -pressure), maxStrainRate=0.3 / inertial, label="control"
    )
    O.engines = contactdynamics.engines(gravity=(0, 0, 0), maxIterations=5000)
    O.engines = O.engines[:-2] + [control] + O.engines[-2:]
    O.dt = 0.03 * inertial
    print(f"{made} grains, friction {friction}", flush=True)
    for _ in range(200):
        O.step()
    tell(200)


start = time.process_time()
if options["in"]:
    O.load(options["in"])
else:
    gas()
cd.tolerance, cd.onNonConvergence, O.dt = 1e-5, "ignore", float(options["h"]) * inertial
steps, last = int(options["steps"]), int(options["last"])
for step in range(1, steps + 1):
    cd.maxIterations = int(options["sweeps"]) if step <= steps - last else 20000
    O.step()
    if step % 100 == 0 or step == steps:
        tell(step)
if options["out"]:
    O.save(options["out"])

deviations, ratios = [], []
cd.tolerance, cd.maxIterations = 1e-4, 500
for step in range(1, int(options["shear"]) + 1):
    control.velGrad = Matrix3(0, 1e-3 / inertial, 0, 0, 0, 0, 0, 0, 0)
    O.cell.flipFlippable = True
    O.step()
    stress = utils.getStress()
    deviations.append([-stress[i, i] / pressure - 1 for i in range(3)])
    ratios.append(stress[0, 1] / pressure)
    if step % max(1, int(options["shear"]) // 20) == 0:
        tell(step)
if deviations:
    late = np.array(deviations[len(deviations) // 4 :])
    print(
        f"shear: mean deviation of the normal stresses {late.mean(axis=0)}, root mean square {late.std(axis=0)}, largest {np.abs(late).max(axis=0)},"
        f" of the pressure: mean {late.mean():.2e}, rms {late.mean(axis=1).std():.2e}, largest {np.abs(late.mean(axis=1)).max():.2e};"
        f" shear stress over pressure {np.mean(ratios[len(ratios) // 4 :]):.4f}"
    )
