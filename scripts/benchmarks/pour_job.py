# SPDX-License-Identifier: GPL-2.0-or-later
"""One pour to rest, with Contact Dynamics or with YADE's soft law; prints one line of JSON. Started by pour.py beside it.

    PYTHONPATH=build/python:scripts/examples yade -n -x scripts/benchmarks/pour_job.py cd|soft REPEAT SEED YOUNG_MODULUS
"""

import json
import math
import sys
import time

from yade.utils import *

import contactdynamics
import pour
from contactdynamics import report

GRAVITY = (0, 0, -pour.GRAVITY)
LONGEST = 3.0  # simulated seconds after which a run counts as not at rest
SAMPLE = 0.005  # simulated seconds between two looks at the scene, the same for both laws


def hard():
    """Contact Dynamics as a user gets it: every option at its default, time step from the motion."""
    O.engines = contactdynamics.engines(gravity=GRAVITY)
    O.dt = 0.05 * math.sqrt(report.meanRadius() / pour.GRAVITY)


def soft():
    """YADE's soft contacts as its gravity-deposition tutorial sets them up: local damping 0.4, collider with its default stride.

    The damping is part of the soft method: without it the springs would bounce for ever. It also brakes the fall a little.
    """
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]
        ),
        NewtonIntegrator(damping=0.4, gravity=GRAVITY),
    ]
    O.dt = 0.3 * PWaveTimeStep()


def main(law, repeat, seed, young):
    material = FrictMat(density=2500, young=young, poisson=0.3, frictionAngle=math.atan(0.3))
    walls, grains = pour.buildScene(material, seed)
    {"cd": hard, "soft": soft}[law]()
    steps = max(1, round(SAMPLE / O.dt))
    wall_time = processor_time = deepest = 0.0
    iterations = worst = calm = 0
    while calm < 2 and O.time < LONGEST:
        # Only the steps are timed; looking at the scene costs both laws the same and would blur the ratio.
        start, processor_start = time.perf_counter(), time.process_time()
        if law == "soft":
            O.run(steps, True)
        else:
            for _ in range(steps):
                O.step()
                iterations += cd.iterations
                worst = max(worst, cd.residual)
        wall_time += time.perf_counter() - start
        processor_time += time.process_time() - processor_start
        packing = report.packing(pour.GRAVITY)
        deepest = max(deepest, packing.maxOverlap)
        calm = calm + 1 if pour.atRest() else 0

    weight = pour.GRAVITY * sum(O.bodies[i].state.mass for i in grains)
    radius = report.meanRadius()
    floor = O.bodies[walls[4]].state.pos[2] + 0.001
    heights = sorted(O.bodies[i].state.pos[2] for i in grains)
    inset, top = 0.010 - 2 * radius, heights[int(0.8 * len(heights))]
    print("RESULT " + json.dumps({
        "law": law, "repeat": repeat, "seed": seed, "grains": len(grains), "young_Pa": young if law == "soft" else "",
        "dt_s": O.dt, "steps": O.iter, "at_rest": calm >= 2, "time_to_rest_s": O.time, "wall_s": wall_time, "processor_s": processor_time,
        "wall_per_simulated_s": wall_time / O.time,
        "contacts": packing.contacts, "mean_overlap_over_r": packing.meanOverlap, "max_overlap_over_r": packing.maxOverlap,
        "max_overlap_over_r_in_pour": deepest, "coordination": packing.coordination, "rattlers": packing.rattlers,
        "packing_fraction": report.solidFraction((-inset, -inset, floor + 2 * radius), (inset, inset, top)),
        "support_over_weight": -report.supportForce(walls)[2] / weight, "kinetic_energy": packing.kineticEnergy,
        "iterations_per_step": iterations / O.iter if law == "cd" else "", "worst_residual": worst if law == "cd" else "",
    }))


main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4]))
