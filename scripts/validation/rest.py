# SPDX-License-Identifier: GPL-2.0-or-later
"""A packing at rest stays at rest: many steps, kinetic energy, overlaps and creep against the start. Results are in doc/validation.rst.

    PYTHONPATH=build/python yade -n -x scripts/validation/rest.py [grains, default 2000] [steps, default 100000] [repairRate]

Spheres of radii 0.8 to 1.2 mm are poured into a box of walls without friction, get mu = 0.5 and settle; then nothing is touched any more.
"""

import math
import sys

import numpy as np
from yade import pack
from yade.utils import *

import contactdynamics
from contactdynamics import report

RADIUS, GRAVITY, FRICTION = 1e-3, 9.81, 0.5


def buildScene(number):
    """Walls and a cloud of smooth grains above the floor, twelve grain diameters wide."""
    width = 24 * RADIUS
    O.materials.append(FrictMat(density=2500, frictionAngle=0))
    O.bodies.append([wall(0, axis=2)] + [wall(place, axis=axis) for axis in (0, 1) for place in (0, width)])
    cloud = pack.SpherePack()
    cloud.makeCloud((0, 0, 0), (width, width, 60 * RADIUS * number / 2000), rMean=RADIUS, rRelFuzz=0.2, num=number, seed=4)
    cloud.toSimulation()
    return number


def settle():
    """Let smooth grains come down, give them friction, and stop them every 40 steps until they lie still.

    Poured with friction, some grains end up on two others, between which they can roll: nothing resists rolling, so they rock for ever (one of 2,000 did, with a
    period of 60,000 steps). A smooth grain rests on three or more, and with friction added then it is held by all of them.
    """
    cd.tolerance, cd.maxIterations = 1e-3, 100  # while they fall
    while O.iter < 1000 or (report.kineticEnergyPerGrain(GRAVITY) > 2e-4 and O.iter < 4000):
        O.run(50, True)
    O.materials[0].frictionAngle = math.atan(FRICTION)
    for contact in O.interactions:
        if contact.isReal:
            contact.phys.tangensOfFrictionAngle = FRICTION
    cd.tolerance, cd.maxIterations = 1e-4, 5000
    still = Vector3(0, 0, 0)
    for _ in range(200):
        for body in report.grains():
            body.state.vel = body.state.angVel = still
        O.run(40, True)
        # A body with the acceleration that this allows moves 1e-9 radii in 1e5 steps.
        if max(body.state.vel.norm() for body in report.grains()) < 3e-15 * GRAVITY * 40 * O.dt:
            return
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
