# SPDX-License-Identifier: GPL-2.0-or-later
"""Semicircular voussoir arch under its own weight: thickness over mean radius at which it stops standing (0.1075 in theory).

    PYTHONPATH=build/python:scripts/validation yade -n -x scripts/validation/arch.py [VOUSSOIRS [t/R ...]]
"""

import math
import sys

from masonry import *


def crownDrops(thickness, voussoirs, seconds=4.0, h=2e-3):
    """Way of the crown [R] in an arch of mean radius 1; ends early when it falls."""
    O.reset()
    material = stone(0.8)
    O.bodies.append(wall(0, 2, material=material))
    blocks = []
    for k in range(voussoirs):
        angles = (math.pi * k / voussoirs, math.pi * (k + 1) / voussoirs)
        outline = [(r * math.cos(a), r * math.sin(a)) for r in (1 - thickness / 2, 1 + thickness / 2) for a in angles]
        blocks.append(prism(outline, material, depth=0.5))
    equip(h, maxIterations=10000)
    crown = blocks[voussoirs // 2]
    place = Vector3(O.bodies[crown].state.pos)
    while O.time < seconds and moved(crown, place) < 0.2:
        O.run(50, True)
    return moved(crown, place), O.time


voussoirs = int(sys.argv[1]) if len(sys.argv) > 1 else 45
for thickness in [float(a) for a in sys.argv[2:]] or [0.11, 0.105]:
    way, when = crownDrops(thickness, voussoirs)
    print(f"{voussoirs} voussoirs, t/R = {thickness}: crown moved {way:.2e} R after {when:.2f} s:", "falls" if way > 0.1 else "stands" if way < 1e-3 else "undecided", flush=True)
