# SPDX-License-Identifier: GPL-2.0-or-later
"""A hopper from STL that runs empty, for the tests of the bits; run in processes of their own."""

from __future__ import annotations

from halves import Halves
from saving_cases import numbers
from vessels import hopper_from_anywhere

_halves = Halves(lambda: hopper_from_anywhere(200), numbers, first=90, second=50)
straight, until_half, from_half = _halves.straight, _halves.until_half, _halves.from_half
