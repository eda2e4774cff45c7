# SPDX-License-Identifier: GPL-2.0-or-later
"""Triaxial compression of one packing with Contact Dynamics and with YADE's soft law.

    PYTHONPATH=build/python yade -n -x scripts/validation/triaxial.py pack FILE [grains=5000] [friction=0.5] [seed=1] [steps=600] [sweeps=500]
    PYTHONPATH=build/python yade -n -x scripts/validation/triaxial.py cd FILE [strain=0.36] [rate=5e-3] [h=0.05]
    PYTHONPATH=build/python yade -n -x scripts/validation/triaxial.py soft FILE [strain=0.36] [rate=5e-3] [stiffness=1000] [damping=0] [out=CONFINED]

`pack` confines a gas of balls with Contact Dynamics and saves it. `soft` confines it once more, which leaves it a bit denser because the soft walls never
quite rest, and saves it as CONFINED: `cd CONFINED` then starts from the same packing. Both load a packing, bring it to the confinement, and compress along z at the rate
`rate` / t_i, t_i = d sqrt(density / pressure), with constant lateral stress and steps of `h` t_i. The soft contacts have k = `stiffness` x pressure x diameter (so the
overlap under the confinement is about 1 / `stiffness` of a diameter), the law of Cundall and Strack and YADE's TriaxialStressController.
Without damping: as a force against the motion it adds to the friction that is to be measured (0.2 makes 22.3 degrees, 0.02 19.1, at strains of 0.04 to 0.12 in a packing of 5000). Compression goes
on until the packing, loose at first, flows at constant volume: what it was confined by is forgotten then.
Printed: axial and volumetric strain, lateral stress against its goal, mobilised friction angle; last the means from a third of the strain on, and the
peak of the angle averaged over 1 % of strain.
"""

import math
import sys
import time

import numpy as np
from yade import (
    FrictMat, ForceResetter, Bo1_Box_Aabb, Bo1_Sphere_Aabb, Ig2_Box_Sphere_ScGeom, Ig2_Sphere_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack, NewtonIntegrator, O, TriaxialStressController, Vector3, pack, utils, wrapper,
)

from contactdynamics import triaxial

what, file = sys.argv[1:3]
options = dict(grains="5000", friction="0.5", seed="1", strain="0.36", rate="5e-3", h="0.05", stiffness="1000", out="", damping="0", steps="600", sweeps="500")
options.update(argument.split("=", 1) for argument in sys.argv[3:])
radius, density, pressure = 0.01, 2600.0, 1e3
inertial = 2 * radius * math.sqrt(density / pressure)
rate, target = float(options["rate"]) / inertial, float(options["strain"])
start = time.process_time()
# Axial strain, volumetric strain, mean lateral stress over goal, angle [degree], stress over goal on the walls that hold it along x and y.
rows: list[tuple[float, ...]] = []


def record(strain, stress, held) -> None:
    """Take a row; compression is positive here."""
    lateral, axial = -0.5 * (stress[0] + stress[1]), -stress[2]
    angle = math.degrees(math.asin((axial - lateral) / (axial + lateral)))
    rows.append((-strain[2], -sum(strain), lateral / pressure, angle, -held[0] / pressure, -held[1] / pressure))


def tell(step: int, more: str = "") -> None:
    print(f"{step:7d}  strain {rows[-1][0]:.4f}  volumetric {rows[-1][1]:+.5f}  lateral/goal {rows[-1][2]:.4f}  held {rows[-1][4]:.4f} {rows[-1][5]:.4f}  angle {rows[-1][3]:.2f}  {more}"
          f"  cpu {time.process_time() - start:.0f} s", flush=True)


def conclude() -> None:
    data = np.array(rows)
    late = data[data[:, 0] > target / 3]
    window = max(1, int(0.01 / target * len(data)))
    smooth = {column: np.convolve(part[:, column], np.ones(window) / window, "valid") for column, part in ((2, late), (3, data))}
    print(f"{what}: from strain {target / 3:.3f} on: angle {late[:, 3].mean():.2f} degree (fluctuation {late[:, 3].std():.2f}), lateral stress / goal"
          f" {late[:, 2].mean():.5f} (rms {late[:, 2].std():.5f}; mean over 1 % of strain {smooth[2].min():.4f} ... {smooth[2].max():.4f}), on the walls that hold it"
          f" {late[:, 4:].mean():.5f} (rms {late[:, 4:].std():.5f}, within {np.abs(late[:, 4:] - 1).max():.4f}); peak of the angle over 1 % of strain {smooth[3].max():.2f} degree; cpu {time.process_time() - start:.0f} s")


def confine() -> None:
    count = int(options["grains"])
    edge = (count * 4 / 3 * math.pi * radius**3 / 0.3) ** (1 / 3)
    walls = triaxial.box((0, 0, 0), (edge, edge, edge))
    balls = pack.SpherePack()
    made = balls.makeCloud((0, 0, 0), (edge, edge, edge), rMean=radius, rRelFuzz=0.1, num=count, seed=int(options["seed"]))
    balls.toSimulation(material=FrictMat(density=density, frictionAngle=math.atan(float(options["friction"])), poisson=0.3))
    O.engines = triaxial.engines(walls, stress=-pressure, maxStrainRate=0.3 / inertial, maxIterations=int(options["sweeps"]))
    O.dt = 0.03 * inertial
    print(made, "grains", flush=True)
    for step in range(1, int(options["steps"]) + 1):
        O.step()
        if step % 100 == 0:
            found = triaxial.report()
            print(f"{step:6d}  stress/goal {' '.join(f'{-s / pressure:.5f}' for s in found.wallStress)}  imbalance {found.imbalance:.1e}  fraction"
                  f" {found.packingFraction:.4f}  sweeps {cd.iterations}  cpu {time.process_time() - start:.0f} s", flush=True)
    O.save(file)


def hard() -> None:
    O.load(file)
    steps = 0
    if not any(isinstance(engine, wrapper.ContactDynamicsEngine) for engine in O.engines):
        O.interactions.clear()
        for body in O.bodies:
            body.state.vel = body.state.angVel = Vector3(0, 0, 0)
        O.engines = triaxial.engines(range(6), stress=-pressure, maxStrainRate=0.3 / inertial, maxIterations=int(options["sweeps"]))
    cd.onNonConvergence, O.dt = "ignore", float(options["h"]) * inertial
    for _ in range(20):
        O.step()
    triaxial.shear(-rate)
    while not rows or rows[-1][0] < target:
        O.step()
        steps += 1
        found = triaxial.report()
        record(found.strain, found.wallStress, found.movingWallStress)
        if steps % 100 == 0:
            tell(steps, f"fraction {found.packingFraction:.4f}  sweeps {cd.iterations}  overlap/r {cd.maxPenetration / radius:.1e}")
    conclude()


def soft() -> None:
    O.load(file)
    walls = triaxial.controller().walls
    O.interactions.clear()
    for number in walls:
        O.bodies[number].state.blockedDOFs = "xyzXYZ"
        O.bodies[number].state.vel = Vector3(0, 0, 0)
    for body in O.bodies:
        body.material.young, body.material.poisson = 2 * float(options["stiffness"]) * pressure, 0.3
    ends = dict(zip(("left", "right", "bottom", "top", "back", "front"), walls))
    control = TriaxialStressController(
        thickness=0, internalCompaction=False, stressMask=7, goal1=-pressure, goal2=-pressure, goal3=-pressure, max_vel=0.1 * radius / inertial,
        stressDamping=0.25, **{f"wall_{name}_id": number for name, number in ends.items()})
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
        control,
        NewtonIntegrator(damping=float(options["damping"])),
    ]
    O.dt = 0.5 * utils.PWaveTimeStep()

    def stresses() -> list[float]:
        return [0.5 * (control.stress(i)[axis] + control.stress(j)[axis]) for axis, (i, j) in enumerate(((0, 1), (2, 3), (4, 5)))]

    for _ in range(100):
        O.run(50, True)
        print("confining", [f"{-s / pressure:.4f}" for s in stresses()], f"unbalanced {utils.unbalancedForce():.2e}  fraction {1 - control.porosity:.4f}", flush=True)
        if max(abs(-s / pressure - 1) for s in stresses()) < 0.01:  # no longer than needed: the walls never quite rest, and shake the packing denser
            break
    if options["out"]:
        O.save(options["out"])
    origin = [float(e) for e in control.strain]
    control.stressMask, control.goal3 = 3, -rate
    every = max(1, int(1e-4 / (rate * O.dt)))
    while not rows or rows[-1][0] < target:
        O.run(every, True)
        found = stresses()
        record([float(e) - o for e, o in zip(control.strain, origin)], found, found)
        if len(rows) % 100 == 0:
            tell(O.iter, f"fraction {1 - control.porosity:.4f}")
    conclude()


{"pack": confine, "cd": hard, "soft": soft}[what]()
