# SPDX-License-Identifier: GPL-2.0-or-later
"""A cube at rest and a stack of 20 cubes for 100,000 steps: how far they move and turn.

    PYTHONPATH=build/python:scripts/validation yade -n -x scripts/validation/stack.py [STEPS]
"""

import math
import sys
import time

from masonry import *


def rest(cubes, steps, tolerance):
    """Largest way [m] and turn [rad] of `cubes` unit cubes on each other, seen ten times in as many steps; processor time a step [s]."""
    O.reset()
    material = stone(0.3)
    O.bodies.append(box((0, 0, -1), (20, 20, 1), fixed=True, material=material))
    square = [(-0.5, 0), (0.5, 0), (-0.5, 1), (0.5, 1)]
    stack = [prism([(x, z + k) for x, z in square], material) for k in range(cubes)]
    equip(1e-3, tolerance=tolerance, maxIterations=5000)
    O.run(20, True)
    before = [(Vector3(O.bodies[i].state.pos), Quaternion(O.bodies[i].state.ori)) for i in stack]
    way = turn = 0.0
    start = time.process_time()
    for _ in range(10):
        O.run(steps // 10, True)
        for i, (place, orientation) in zip(stack, before):
            way = max(way, moved(i, place))
            difference = O.bodies[i].state.ori * orientation.conjugate()
            turn = max(turn, 2 * math.hypot(difference[0], difference[1], difference[2]))
    return way, turn, (time.process_time() - start) / steps


steps = int(sys.argv[1]) if len(sys.argv) > 1 else 100000
for cubes, tolerance in ((1, 1e-4), (20, 1e-4)):
    way, turn, spent = rest(cubes, steps, tolerance)
    print(f"{cubes} cube(s), tolerance {tolerance:g}, {steps} steps: moved {way:.2e} m, turned {turn:.2e} rad, {1e3 * spent:.2f} ms a step", flush=True)
