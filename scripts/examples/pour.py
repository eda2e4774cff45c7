# SPDX-License-Identifier: GPL-2.0-or-later
"""Pour a packing of spheres into a box and let Contact Dynamics bring it to rest.

    PYTHONPATH=build/python yade -n -x scripts/examples/pour.py [folder for the results, default out/quickstart]

The grains are the packing ``checkJCFpm.spheres`` that ships with YADE among its check data. It is shaken loose (the spacing grows,
every grain gets a random velocity), falls into a box and settles. Start from here: change the grains, the box, the friction.
"""

import math
import os
import random
import sys
import time

import yade.tests
from tqdm import tqdm
from yade.utils import *

import contactdynamics
from contactdynamics import forcenetwork, report

GRAVITY = 9.81  # m/s2
REST = 1e-4  # mean net force on a grain / mean contact force below which the packing counts as balanced


def shippedPacking():
    """Centres [m] and radii [m] of the spheres that ship with YADE: a cylinder, 14 mm wide and 38 mm high."""
    path = os.path.join(os.path.dirname(yade.tests.__file__), "checks", "data", "checkJCFpm.spheres")
    with open(path) as lines:
        numbers = [[float(word) for word in line.split()] for line in lines if not line.startswith("#")]
    return [Vector3(*row[:3]) for row in numbers], [row[3] for row in numbers]


def buildScene(material, seed=1):
    """Put an open box and the loosened packing into an empty scene; returns ids of floor and walls, ids of the grains.

    The same seed gives the same random velocities, so two contact laws can be compared from the same start.
    """
    O.reset()
    O.materials.append(material)
    centres, radii = shippedPacking()
    spacing, shake = Vector3(1.15, 1.15, 1.6), 0.2  # more room mostly upwards; largest velocity component in m/s
    half, height = 0.010, 0.080  # the box is 20 mm wide inside
    floor = spacing[2] * min(centre[2] for centre in centres) - 2 * max(radii)
    boxes = aabbWalls(((-half, -half, floor), (half, half, floor + height)), thickness=0.002, oversizeFactor=1.2)
    walls = O.bodies.append(boxes[:5])  # the sixth box would be the lid
    generator = random.Random(seed)
    grains = []
    for centre, radius in zip(centres, radii):
        grain = sphere([factor * x for factor, x in zip(spacing, centre)], radius)
        grain.state.vel = [generator.uniform(-shake, shake) for _ in range(3)]
        grains.append(O.bodies.append(grain))
    return walls, grains


def atRest():
    """True when the forces balance and next to nothing moves. Ask twice in a row: a packing may look calm between two slips.

    Not by the velocities alone: a grain may roll on the floor for ever, because nothing resists rolling.
    The contacts count as well, because the grains are slow and touch nothing at the start.
    """
    held = len(report.loadedContacts()) > len(report.grains())
    return held and unbalancedForce() < REST and report.kineticEnergyPerGrain(GRAVITY) < 1e-4


def main(folder):
    walls, grains = buildScene(FrictMat(density=2500, frictionAngle=math.atan(0.3)))

    # What differs from a script with soft contacts: the engines, and a time step that the motion chooses, not the stiffness.
    O.engines = contactdynamics.engines(gravity=(0, 0, -GRAVITY), maxIterations=5000)
    radius = report.meanRadius()
    O.dt = 0.05 * math.sqrt(radius / GRAVITY)

    os.makedirs(folder, exist_ok=True)
    # multiblock, because YADE 2023.02a crashes when it writes interactions ("intr") to single files outside an MPI run.
    recorder = VTKRecorder(fileName=os.path.join(folder, "pour-"), recorders=["spheres", "velocity", "boxes", "intr"], multiblock=True)
    most, per_frame = 4000, 20  # steps
    iterations = unconverged = calm = 0
    deepest = wall_time = worst = 0.0
    recorder()
    with tqdm(total=most, desc="pouring", unit="step", dynamic_ncols=True) as bar:
        while O.iter < most and calm < 2:
            start = time.perf_counter()
            for _ in range(per_frame):
                O.step()
                iterations += cd.iterations
                unconverged += not cd.converged
                worst = max(worst, cd.residual)
                deepest = max(deepest, cd.maxPenetration)
            wall_time += time.perf_counter() - start
            calm = calm + 1 if atRest() else 0
            recorder()
            bar.update(per_frame)
            bar.set_postfix(contacts=cd.activeContacts, iterations=cd.iterations, residual=f"{cd.residual:.1e}")
        bar.total = bar.n  # the bar counts to the longest run allowed; it is full when the packing rests

    packing = report.packing(GRAVITY)
    weight = GRAVITY * sum(O.bodies[i].state.mass for i in grains)
    print("\nAt rest." if calm >= 2 else f"\nNot at rest after {most} steps.")
    print(report.table([
        ("grains", len(grains)),
        ("time step [s]", O.dt),
        ("steps", O.iter),
        ("simulated time [s]", O.time),
        ("wall time in the steps [s]", wall_time),
        ("contacts that carry force", packing.contacts),
        ("iterations per step", iterations / O.iter),
        ("steps that missed the tolerance", unconverged),
        ("residual: last, worst (tolerance)", f"{cd.residual:.2e}, {worst:.2e} ({cd.tolerance:g})"),
        ("mean overlap / radius", packing.meanOverlap),
        ("max overlap / radius", packing.maxOverlap),
        ("max overlap / radius in the whole pour", deepest / radius),
        ("force on floor and walls / weight", f"{-report.supportForce(walls)[2] / weight:.6f}"),
    ]))

    forcenetwork.draw(os.path.join(folder, "force-network.png"))
    forcenetwork.draw(os.path.join(folder, "force-network-slab.png"), slab=(-radius, radius), thickest=0.6)
    O.save(os.path.join(folder, "scene.yade.gz"))
    print(f"\nWritten to {folder}/: scene.yade.gz (O.load), pour-*.vtm (ParaView), force-network.png, force-network-slab.png")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else os.path.join("out", "quickstart"))
