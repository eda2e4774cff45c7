# SPDX-License-Identifier: GPL-2.0-or-later
"""A turning drum, for the tests of the bits; run in processes of their own."""

from __future__ import annotations

from yade import O, RotationEngine

from halves import Halves
from saving_cases import numbers
from vessels import drum


def build() -> None:
    """Balls that fall into the drum and then tumble in it."""
    drum(60, lambda ids: RotationEngine(ids=ids, rotationAxis=(0, 1, 0), angularVelocity=2, rotateAroundZero=True))


def bits() -> str:
    """Of bodies, contacts and the energy balance."""
    return numbers() + " ".join(f"{name} {float(O.energy[name]).hex()}" for name in sorted(O.energy.keys()) if name.startswith("contact")) + "\n"


_halves = Halves(build, bits, first=320, second=60)
straight, until_half, from_half = _halves.straight, _halves.until_half, _halves.from_half
