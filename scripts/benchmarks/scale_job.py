# SPDX-License-Identifier: GPL-2.0-or-later
"""A pour of N spheres with YADE, whole steps timed engine by engine; or the memory that Contact Dynamics takes in such a scene.

Prints one line of JSON. Started by scale.py beside it, the second way in a process of its own.

    PYTHONPATH=build/python yade -n -x -jTHREADS scripts/benchmarks/scale_job.py time SPHERES SEED WARMING_UP STEPS SCENE
    PYTHONPATH=build/python yade -n -x -jTHREADS scripts/benchmarks/scale_job.py memory SCENE
"""

import json
import math
import os
import random
import sys
import time

from yade import timing
from yade.utils import *

import contactdynamics

RADIUS = 1e-3  # m, mean


def residentBytes():
    """Memory of this process that is in use, from the kernel."""
    with open("/proc/self/statm") as numbers:
        return int(numbers.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def buildScene(spheres, seed):
    """A box twice as high as wide, filled with a lattice whose neighbours nearly touch: contacts from the first steps on."""
    generator = random.Random(seed)
    O.materials.append(FrictMat(density=2500, frictionAngle=math.atan(0.3)))
    side = max(1, round((spheres / 2) ** (1 / 3)))
    pitch = 2.1 * RADIUS
    width = side * pitch
    boxes = aabbWalls(((0, 0, 0), (width, width, 4 * width)), thickness=0.01 * width, oversizeFactor=1.2)
    O.bodies.append(boxes[:5])
    grains = []
    for i in range(spheres):
        place = [(k + 0.5) * pitch + generator.uniform(-0.02, 0.02) * RADIUS for k in (i % side, i // side % side, i // side**2)]
        grain = sphere(place, RADIUS * generator.uniform(0.8, 1.02))
        grain.state.vel = [generator.uniform(-0.05, 0.05) for _ in range(3)]
        grains.append(grain)
    O.bodies.append(grains)


def takeTime(spheres, seed, warming, steps, scene):
    """Times whole steps, and leaves the scene in a file."""
    buildScene(spheres, seed)
    O.engines = contactdynamics.engines(onNonConvergence="ignore")
    O.dt = 0.05 * math.sqrt(RADIUS / 9.81)
    for _ in range(warming):
        O.step()
    O.timingEnabled = True
    timing.reset()
    start, sweeps, missed, worst = time.perf_counter(), 0, 0, 0.0
    for _ in range(steps):
        O.step()
        sweeps += cd.iterations
        missed += not cd.converged
        worst = max(worst, cd.residual)
    wall = time.perf_counter() - start
    share = {type(engine).__name__: 1e-9 * engine.execTime for engine in O.engines}
    parts = {name: 1e-9 * nanoseconds for name, nanoseconds, _ in cd.timingDeltas.data}
    print("RESULT " + json.dumps({
        "spheres": spheres, "threads": O.numThreads, "seed": seed, "steps": steps, "contacts": cd.contacts, "active": cd.activeContacts,
        "sweeps_per_step": sweeps / steps, "missed": missed, "worst_residual": worst, "max_overlap_over_r": cd.maxPenetration / RADIUS,
        "ms_per_step": 1e3 * wall / steps, **{f"ms_{name}": 1e3 * seconds / steps for name, seconds in {**share, **parts}.items()},
        "collect_apply_share": (parts["collect"] + parts["apply"]) / sum(share.values()),
    }))
    O.save(scene)


def takeMemory(scene):
    """What the process grows by when ContactDynamicsEngine and NewtonIntegrator join the engines that make the interactions.

    Interactions with geometry and physics are in the file and exist before.
    """
    O.load(scene)
    engines = list(O.engines)
    O.engines = engines[:3]
    O.step()
    before = residentBytes()
    O.engines = engines
    O.step()
    O.step()
    solver = next(e for e in engines if type(e).__name__ == "ContactDynamicsEngine")
    print("RESULT " + json.dumps({"bytes_per_contact": (residentBytes() - before) / max(1, solver.contacts)}))


if sys.argv[1] == "memory":
    takeMemory(sys.argv[2])
else:
    takeTime(*(int(word) for word in sys.argv[2:6]), sys.argv[6])
