# SPDX-License-Identifier: GPL-2.0-or-later
"""A small heap in motion, whose problem is looked at from outside of the solver."""

from __future__ import annotations

import numpy as np
from yade import Vector3

from scenes import box, cd, dumbbell, equip, floor, grain, state, steps


def heap(**engine) -> None:
    """Balls and clumps in a bin, stopped in the middle of an impact, so that they roll and slide and errors are there to be measured."""
    floor(20)
    for centre, half in (((-2.2, 1, 5), (1, 5, 5)), ((6.6, 1, 5), (1, 5, 5)), ((2, -2.2, 5), (5, 1, 5)), ((2, 4.4, 5), (5, 1, 5))):
        box(centre, half)
    random = np.random.default_rng(2)
    for i in range(12):
        grain((2.2 * (i % 3), 2.2 * (i // 3 % 2), 1.2 + 2.3 * (i // 6)), radius=random.uniform(0.8, 1.1), velocity=random.normal(size=3))
    for k in range(2):
        number, _ = dumbbell([(1 + k, 1, 7 + 2.5 * k), (2.5 + k, 1, 7.3 + 2.5 * k)])
        state(number).vel = Vector3(0, 0, -5)
    equip(dt=5e-3, onNonConvergence="ignore", **engine)
    steps(150)
    assert cd().activeContacts > 12
