# SPDX-License-Identifier: GPL-2.0-or-later
"""One pour of random polyhedra; prints one line of JSON. Started by blocks.py beside it.

    PYTHONPATH=build/python yade -n -x [-jN] scripts/benchmarks/blocks_job.py BODIES SEED LONGEST
"""

import json
import math
import random
import sys
import time

from yade import polyhedra_utils
from yade.utils import *

import contactdynamics

SIZE = 0.05  # of the ellipsoids in which the random polyhedra are made [m]
G = 9.81


def build(count, seed):
    """Walls, and the bodies on a lattice between them, turned at random and free of each other; returns ids of both and the height."""
    stone = O.materials[O.materials.append(FrictMat(density=2600, frictionAngle=math.atan(0.5), young=1e9, poisson=0.2))]
    rng = random.Random(seed)
    bodies = [polyhedra_utils.polyhedra(stone, size=(SIZE, SIZE, SIZE), seed=rng.randrange(10**6)) for _ in range(count)]
    cell = 2.02 * max(vertex.norm() for body in bodies for vertex in body.shape.v)
    side = math.ceil(count ** (1 / 3))
    walls = [O.bodies.append(wall(position, axis, sense=sense, material=stone)) for position, axis, sense in ((0, 2, 1), (0, 0, 1), (cell * side, 0, -1), (0, 1, 1), (cell * side, 1, -1))]
    for k, body in enumerate(bodies):
        body.state.pos = Vector3(*(cell * (0.5 + n) for n in (k % side, k // side % side, k // side**2)))
        body.state.ori = Quaternion((rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)), rng.uniform(0, 3)) * body.state.ori
        body.state.vel = Vector3(rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), 0)
    return walls, [O.bodies.append(body) for body in bodies], cell * side


def main(count, seed, longest):
    walls, bodies, height = build(count, seed)
    O.engines = contactdynamics.engines(gravity=(0, 0, -G), onNonConvergence="ignore")
    O.dt = 0.05 * math.sqrt(0.5 * SIZE / G)
    mass = sum(O.bodies[i].state.mass for i in bodies)
    weight = G * mass
    clock = time.process_time if O.numThreads == 1 else time.perf_counter
    spent = iterations = unconverged = 0
    quiet = 0  # looks in a row at which nothing moved; once may be the turning point of a body that rocks
    while quiet < 3 and O.time < longest * math.sqrt(height / G):
        start = clock()
        for _ in range(20):
            O.step()
            iterations += cd.iterations
            unconverged += not cd.converged
        spent += clock() - start
        quiet = quiet + 1 if kineticEnergy() < 1e-20 * weight * SIZE else 0
        print(f"step {O.iter}: kinetic energy / (weight size) {kineticEnergy() / (weight * SIZE):.1e}, {cd.activeContacts} loaded points, "
              f"{iterations / O.iter:.0f} sweeps and {1e3 * spent / O.iter:.0f} ms a step, {unconverged} not converged", file=sys.stderr, flush=True)
    steps = O.iter
    after = clock()
    O.run(100, True)
    resting = (clock() - after) / 100
    active = [i for i in O.interactions if i.isReal and i.phys.normalForce.norm() > 0]
    overlaps = [max(0.0, -gap) for i in active for gap, force in zip(i.geom.gaps, i.phys.pointForces) if force.norm() > 0]
    support = -sum((i.phys.normalForce + i.phys.shearForce)[2] * (1 if i.id1 not in walls else -1) for i in active if i.id1 in walls or i.id2 in walls)
    print("RESULT " + json.dumps({
        "bodies": count, "size_m": SIZE, "seed": seed, "threads": O.numThreads, "dt_s": O.dt, "steps": steps, "at_rest": quiet == 3,
        "ms_per_step": 1e3 * spent / steps, "ms_per_step_at_rest": 1e3 * resting, "sweeps_per_step": iterations / steps, "steps_not_converged": unconverged,
        "touching_pairs": len(active), "points": cd.contacts, "loaded_points": cd.activeContacts,
        "mean_overlap_over_size": sum(overlaps) / len(overlaps) / SIZE, "max_overlap_over_size": max(overlaps) / SIZE,
        "support_over_weight": support / weight, "kinetic_energy_over_weight_size": kineticEnergy() / (weight * SIZE),
    }))


main(int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]))
