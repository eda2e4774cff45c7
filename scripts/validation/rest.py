# SPDX-License-Identifier: GPL-2.0-or-later
"""A packing at rest stays at rest: many steps, kinetic energy, overlaps and creep against the start. Results are in doc/validation.rst.

    PYTHONPATH=build/python yade -n -x scripts/validation/rest.py [grains, default 2000] [steps, default 100000] [repairRate]

Spheres of radii 0.8 to 1.2 mm with mu = 0.5 are poured into a box of walls and settle; then nothing is touched any more.
"""

import math
import sys

import numpy as np
from yade import pack
from yade.utils import *

import contactdynamics
from contactdynamics import report

RADIUS, GRAVITY = 1e-3, 9.81


def buildScene(number):
    """Walls and a cloud of grains above the floor, twelve grain diameters wide."""
    width = 24 * RADIUS
    O.materials.append(FrictMat(density=2500, frictionAngle=math.atan(0.5)))
    O.bodies.append([wall(0, axis=2)] + [wall(place, axis=axis) for axis in (0, 1) for place in (0, width)])
    cloud = pack.SpherePack()
    cloud.makeCloud((0, 0, 0), (width, width, 60 * RADIUS * number / 2000), rMean=RADIUS, rRelFuzz=0.2, num=number, seed=4)
    cloud.toSimulation()
    return number


def settle():
    """Step until the grains lie still, stopping them every 40 steps.

    Nothing resists rolling: a ball alone on the floor would roll on, one in a hollow of others rock, for ever, with whatever speed settling left it.
    """
    cd.tolerance, cd.maxIterations = 1e-3, 300  # while they fall
    while O.iter < 1000 or report.kineticEnergyPerGrain(GRAVITY) > 1e-2:
        O.run(50, True)
    cd.tolerance, cd.maxIterations = 1e-4, 5000
    still = Vector3(0, 0, 0)
    for _ in range(200):
        O.run(40, True)
        # At this speed a ball rolls 1e-7 radii in 1e5 steps.
        if max(body.state.vel.norm() for body in report.grains()) < 4e-10 * GRAVITY * O.dt:
            return
        for body in report.grains():
            body.state.vel = body.state.angVel = still
    print("not still after 8000 steps; going on", flush=True)


def look(start):
    """Largest and mean distance from the places `start` in radii, kinetic energy of translation per grain over m g r, overlaps."""
    places = np.array([body.state.pos for body in report.grains()])
    moved = np.linalg.norm(places - start, axis=1) / RADIUS
    return moved.max(), moved.mean(), report.kineticEnergyPerGrain(GRAVITY), cd.meanPenetration / RADIUS, cd.maxPenetration / RADIUS


def main(number, steps, **options):
    buildScene(number)
    O.engines = contactdynamics.engines(gravity=(0, 0, -GRAVITY), **options)
    O.dt = 0.05 * math.sqrt(RADIUS / GRAVITY)
    settle()
    print(f"at rest after {O.iter} steps, {cd.activeContacts} contacts carry force", flush=True)
    first = O.iter
    start = np.array([body.state.pos for body in report.grains()])
    print(f"{'step':>8} {'largest way/r':>14} {'mean way/r':>12} {'E/(m g r)':>12} {'mean overlap/r':>15} {'largest/r':>12} {'sweeps':>7}")
    for part in [0, 10, 100, 1000] + [steps * k // 20 for k in range(1, 21)]:
        if part > O.iter - first:
            O.run(part - (O.iter - first), True)
        way, mean, energy, overlap, largest = look(start)
        print(f"{O.iter - first:8} {way:14.3e} {mean:12.3e} {energy:12.3e} {overlap:15.6e} {largest:12.4e} {cd.iterations:7}", flush=True)


if __name__ == "__main__":
    given = [float(word) for word in sys.argv[1:]]
    main(int(given[0]) if given else 2000, int(given[1]) if given[1:] else 100000, **({"repairRate": given[2]} if given[2:] else {}))
