# SPDX-License-Identifier: GPL-2.0-or-later
"""What penetration repair costs and brings in a pour: the same steps with and without it, in turn. Called by ``scripts/bench repair``.

    PYTHONPATH=build/python yade -n -x scripts/benchmarks/repair.py [grains, default 2000] [steps between two samples, default 300] [samples]

At some moments of a pour the scene is kept in memory, and the next steps are made twice from there: with repairRate = 0 and with the default. What is
printed for both: processor time a step, the share of repair in the engine, overlaps, and energy that was lost (kinetic and potential).
"""

import math
import sys
import time

from yade import pack, timing
from yade.utils import *

import contactdynamics
from contactdynamics import report

RADIUS, GRAVITY, SAMPLE = 1e-3, 9.81, 40


def buildScene(number):
    width = 2 * RADIUS * (0.6 * number) ** (1 / 3)
    O.materials.append(FrictMat(density=2500, frictionAngle=math.atan(0.3)))
    O.bodies.append([wall(0, axis=2)] + [wall(place, axis=axis) for axis in (0, 1) for place in (0, width)])
    cloud = pack.SpherePack()
    cloud.makeCloud((0, 0, 0), (width, width, 4 * width), rMean=RADIUS, rRelFuzz=0.2, num=number, seed=4)
    cloud.toSimulation()
    O.engines = contactdynamics.engines(gravity=(0, 0, -GRAVITY))
    O.dt = 0.05 * math.sqrt(RADIUS / GRAVITY)


def energy():
    """Kinetic and potential energy per grain in units of (mean weight x mean radius)."""
    grains = report.grains()
    height = sum(body.state.mass * body.state.pos[2] for body in grains) / sum(body.state.mass for body in grains)
    return report.kineticEnergyPerGrain(GRAVITY), height / report.meanRadius()


def sample(rate):
    """Some steps from the scene kept in memory: processor time a step, share of the repair in it, overlaps in radii, and energies."""
    O.loadTmp("start")
    cd.repairRate = rate
    cd.onNonConvergence = "ignore"
    O.timingEnabled = True
    timing.reset()
    start = time.process_time()
    O.run(SAMPLE, True)
    processor = (time.process_time() - start) / SAMPLE
    parts = {name: nsec for name, nsec, _ in cd.timingDeltas.data}
    total = sum(engine.execTime for engine in O.engines)
    kinetic, height = energy()
    print(
        f"{O.iter:6} {rate:5} {1e3 * processor:9.2f} {100 * parts['repair'] / total:8.2f} {cd.activeContacts:9} {cd.iterations:7}"
        f" {cd.meanPenetration / RADIUS:13.3e} {cd.maxPenetration / RADIUS:13.3e} {kinetic:12.4e} {height:12.7f}",
        flush=True,
    )


def main(number, between, samples):
    buildScene(number)
    print(f"{'step':>6} {'rate':>5} {'ms/step':>9} {'repair %':>8} {'contacts':>9} {'sweeps':>7} {'mean overlap/r':>13} {'max/r':>13} {'kinetic':>12} {'height/r':>12}")
    for _ in range(samples):
        cd.tolerance, cd.maxIterations = 1e-3, 100  # only to get there
        O.run(between, True)
        cd.tolerance, cd.maxIterations = 1e-4, 1000
        O.saveTmp("start")
        for rate in (0, 0.1):
            sample(rate)


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:]]
    main(*(given + [2000, 300, 6][len(given):]))
