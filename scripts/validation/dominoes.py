# SPDX-License-Identifier: GPL-2.0-or-later
"""Speed of the wave in a row of dominoes for smaller and smaller time steps.

    PYTHONPATH=build/python:scripts/validation yade -n -x scripts/validation/dominoes.py [DOMINOES [STEP ...]]

The wave passes a domino when that one has turned by LEAN; between two steps the angle is taken as linear. (The step in which a domino is
struck is a poor clock: it counts in whole steps, 2 % of the time from one domino to the next at 4 ms.) The speed is the slope of a line through place and time of
all dominoes in the second half of the row, where the wave has forgotten how it began. Where in a step an impact falls is a matter of chance, and the line averages
that out.
"""

import math
import sys

import numpy as np

from masonry import *

LEAN = 0.15  # rad; the dominoes strike their neighbours at 0.36


def waveSpeed(h, count, height=1.0, thickness=0.15, distance=0.5):
    """Speed of the wave in the second half of the row [sqrt(g height)]."""
    O.reset()
    material = stone(0.3)
    O.bodies.append(wall(0, 2, material=material))
    outline = lambda x: [(x, 0), (x + thickness, 0), (x, height), (x + thickness, height)]  # noqa: E731
    row = [prism(outline(k * distance), material, depth=0.5) for k in range(count)]
    # The first one turns about its lower right edge.
    spin = 1.0
    first = O.bodies[row[0]].state
    first.angVel = (0, spin, 0)
    first.angMom = angularMomentum(first, spin)
    first.vel = Vector3(0, spin, 0).cross(first.pos - Vector3(thickness, 0, 0))
    equip(h)
    upright = [Quaternion(O.bodies[i].state.ori) for i in row]
    passed, angles = [None] * count, [0.0] * count
    front = 0  # the first domino that the wave has not passed
    while front < count and O.time < 60:
        O.step()
        for k in range(front, min(front + 3, count)):
            angle = lean(O.bodies[row[k]].state.ori, upright[k])
            if passed[k] is None and angle >= LEAN:
                passed[k] = O.time - h * (angle - LEAN) / (angle - angles[k])
            angles[k] = angle
        while front < count and passed[front] is not None:
            front += 1
    middle = range(count // 2, count - 2)  # the last ones fall on nothing
    return distance / np.polyfit(middle, [passed[k] for k in middle], 1)[0] / math.sqrt(G * height)


def lean(now, before):
    """Angle by which a body has turned [rad]."""
    difference = now * before.conjugate()
    return 2 * math.asin(math.hypot(difference[0], difference[1], difference[2]))


def angularMomentum(state, spin):
    """Of a body that turns about the y axis."""
    axes = state.ori.toRotationMatrix()
    return axes * Vector3(*(state.inertia[i] * (axes.transpose() * Vector3(0, spin, 0))[i] for i in range(3)))


count = int(sys.argv[1]) if len(sys.argv) > 1 else 30
speeds = []
for h in [float(a) for a in sys.argv[2:]] or (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4):
    speeds.append(waveSpeed(h, count))
    change = f", change {speeds[-1] - speeds[-2]:+.5f}" if len(speeds) > 1 else ""
    print(f"h = {h:.2e} s: wave speed {speeds[-1]:.5f} sqrt(g H){change}", flush=True)
