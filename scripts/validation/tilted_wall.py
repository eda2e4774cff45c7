# SPDX-License-Identifier: GPL-2.0-or-later
"""Dry running-bond wall tilted in its plane: stands below the angle of limit analysis, falls above it.

    PYTHONPATH=build/python:scripts/validation yade -n -x scripts/validation/tilted_wall.py [COURSES [BRICKS [FRICTION]]]

Limit analysis is a linear programme (static theorem) for the largest tangent of the tilt at which some forces between the bricks are in balance
with their weights; solved by scipy (python3-scipy), with nothing of Contact Dynamics in it. The theorem holds for associated friction only, so for
Coulomb's the programme gives an upper bound: it lets bricks wedge each other at their heads, to any degree that would help, though nothing makes them. Without
forces at the heads it gives a second figure. Where both agree, as for 10 courses of 4 bricks with friction 0.5 (0.2 %) or 16 of 2 (1.8 %), the limit is known;
the wall has to stand at 0.98 of the smaller one and to fall at 1.02 of the larger one. High friction sets them apart (8 3 1.5: by 30 %), and the wall falls
in between.
"""

import math
import sys

import numpy as np
from scipy.optimize import linprog

from masonry import *

LENGTH, HEIGHT = 0.4, 0.2


def bond(courses, bricks):
    """Left and right end and course of every brick; odd courses start and end with half a brick."""
    wall = []
    for course in range(courses):
        ends = [0.0] + [LENGTH * (k + (0.5 if course % 2 else 1)) for k in range(bricks if course % 2 else bricks - 1)] + [LENGTH * bricks]
        wall += [(left, right, course) for left, right in zip(ends, ends[1:])]
    return wall


def limitTangent(wall, friction, heads):
    """Largest tangent of the tilt for which there is a balance of forces; `heads` tells whether bricks of a course press each other."""
    joints = []  # (lower brick or -1, upper brick, place, direction of the normal on the upper one)
    for upper, (left, right, course) in enumerate(wall):
        if course == 0:
            joints += [(-1, upper, (x, 0.0), (0, 1)) for x in (left, right)]
        for lower, (l2, r2, c2) in enumerate(wall):
            low, high = max(left, l2), min(right, r2)
            if c2 == course - 1 and high > low + 1e-9:
                joints += [(lower, upper, (x, course * HEIGHT), (0, 1)) for x in (low, high)]
            if heads and c2 == course and abs(r2 - left) < 1e-9:
                joints += [(lower, upper, (left, course * HEIGHT + z), (1, 0)) for z in (0, HEIGHT)]
    # Unknowns: normal and tangential force at each point, and the tangent. Downhill is +x.
    A = np.zeros((3 * len(wall), 2 * len(joints) + 1))
    b = np.zeros(3 * len(wall))
    for brick, (left, right, course) in enumerate(wall):
        weight = right - left
        A[3 * brick, -1] = weight
        b[3 * brick + 1] = weight
    for j, (lower, upper, place, normal) in enumerate(joints):
        for column, direction in ((2 * j, normal), (2 * j + 1, (normal[1], -normal[0]))):
            for brick, sign in ((upper, 1), (lower, -1)):
                if brick < 0:
                    continue
                left, right, course = wall[brick]
                arm = (place[0] - (left + right) / 2, place[1] - (course + 0.5) * HEIGHT)
                A[3 * brick : 3 * brick + 3, column] += sign * np.array([direction[0], direction[1], arm[0] * direction[1] - arm[1] * direction[0]])
    cone = np.zeros((2 * len(joints), A.shape[1]))
    for j in range(len(joints)):
        cone[2 * j, 2 * j : 2 * j + 2] = (-friction, 1)
        cone[2 * j + 1, 2 * j : 2 * j + 2] = (-friction, -1)
    bounds = [(0, None), (None, None)] * len(joints) + [(0, None)]
    cost = np.zeros(A.shape[1])
    cost[-1] = -1
    solution = linprog(cost, A_ub=cone, b_ub=np.zeros(len(cone)), A_eq=A, b_eq=b, bounds=bounds, method="highs")
    if solution.status != 0:
        raise RuntimeError(solution.message)
    return solution.x[-1]


def stands(wall, friction, tangent, seconds=3.0, h=2e-3):
    """How far the brick that moved most went [m], and how many steps did not converge."""
    O.reset()
    material = stone(friction)
    O.bodies.append(utils.wall(0, 2, material=material))
    bricks = [prism([(x, z) for x in (left, right) for z in (course * HEIGHT, (course + 1) * HEIGHT)], material, depth=0.2) for left, right, course in wall]
    angle = math.atan(tangent)
    equip(h, gravity=(G * math.sin(angle), 0, -G * math.cos(angle)), maxIterations=5000)
    places = [Vector3(O.bodies[i].state.pos) for i in bricks]
    way, unconverged = 0.0, 0
    while O.time < seconds and way < 0.5 * HEIGHT:
        for _ in range(25):
            O.step()
            unconverged += not cd.converged
        way = max(moved(i, place) for i, place in zip(bricks, places))
    return way, unconverged


courses = int(sys.argv[1]) if len(sys.argv) > 1 else 10
bricks = int(sys.argv[2]) if len(sys.argv) > 2 else 4
friction = float(sys.argv[3]) if len(sys.argv) > 3 else 0.5
wall = bond(courses, bricks)
lower, upper = limitTangent(wall, friction, False), limitTangent(wall, friction, True)
print(f"{courses} courses of {bricks} bricks, mu = {friction}: limit tangent {upper:.5f}, without forces at heads {lower:.5f}", flush=True)
for tangent in (0.98 * lower, 1.02 * upper):
    way, unconverged = stands(wall, friction, tangent)
    verdict = "falls" if way > 0.05 else "stands" if way < 1e-3 else "undecided"
    print(f"tangent {tangent:.5f}: moved {way:.2e} m: {verdict} ({unconverged} steps of {O.iter} not converged)", flush=True)
