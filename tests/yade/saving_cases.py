# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene with impacts, sliding and clumps, and the exact numbers it leads to; run in processes of their own."""

from __future__ import annotations

import numpy as np
from yade import O, Vector3

from halves import Halves
from scenes import box, cd, contacts, dumbbell, equip, grain, material, state, steps

FIRST, SECOND = 120, 60


def build() -> None:
    """160 spheres and 20 dumbbells fall into a box."""
    generator = np.random.default_rng(6)
    material(friction=0.4)
    box((0, 0, -1), (20, 20, 1))
    for sign in (-1, 1):
        box((7 * sign, 0, 0), (1, 20, 60))
        box((0, 7 * sign, 0), (20, 1, 60))
    for k in range(160):
        place = 2.5 * np.array([k % 4, k // 4 % 4, k // 16]) + [-3.75, -3.75, 1.5]
        place = place + generator.uniform(-0.1, 0.1, 3)
        grain(place, radius=generator.uniform(0.7, 1), velocity=generator.uniform(-3, 3, 3))
    for k in range(20):
        place = np.array([3.5 * (k % 3) - 3.5, 3.0 * (k // 3 % 3) - 3, 28 + 2.5 * (k // 9)])
        number, _ = dumbbell([place, place + [1.2, 0.3, 0.2]], radius=0.7)
        state(number).vel = Vector3(*generator.uniform(-3, 3, 3))
    equip(1.5e-2, tolerance=1e-4, maxIterations=3000, onNonConvergence="ignore")


def crowd() -> None:
    """2744 spheres fly together: enough contacts at once (over 5000) for the solver to share them out to its threads.

    Every tenth body has three different moments of inertia, so that both kinds of contacts occur.
    """
    generator = np.random.default_rng(13)
    material(friction=0.4)
    for k in range(14**3):
        place = 2.02 * (np.array([k % 14, k // 14 % 14, k // 196]) - 6.5)
        radius, velocity = generator.uniform(0.9, 1), -0.5 * place + generator.uniform(-1, 1, 3)
        number = grain(place, radius=radius, velocity=velocity)
        if k % 10 == 0:
            O.bodies[number].aspherical = True
            state(number).inertia = Vector3(*(generator.uniform(0.7, 1.3, 3) * state(number).inertia[0]))
    equip(1.5e-2, gravity=(0, 0, 0), tolerance=1e-4, maxIterations=300, onNonConvergence="ignore")


def together(result: str) -> None:
    """A few steps of the crowd."""
    crowd()
    most = 0
    for _ in range(20):
        steps(1)
        most = max(most, cd().activeContacts)
    assert most > 5000, f"only {most} contacts"
    with open(result, "w") as file:
        file.write(numbers())


def numbers() -> str:
    """Every position, orientation, velocity and impulse, written so that equal text means equal bits."""
    lines = []
    for b in O.bodies:
        s = b.state
        values = [*s.pos, s.ori[0], s.ori[1], s.ori[2], s.ori[3], *s.vel, *s.angVel, *s.angMom]
        lines.append(f"{b.id} " + " ".join(float(v).hex() for v in values))
    for i in sorted(contacts(), key=lambda c: (min(c.id1, c.id2), max(c.id1, c.id2))):
        lines.append(f"{i.id1} {i.id2} {i.phys.status} " + " ".join(float(v).hex() for v in i.phys.impulse))
    return "\n".join(lines) + "\n"


_halves = Halves(build, numbers, FIRST, SECOND, fewest=100)
straight, until_half, from_half = _halves.straight, _halves.until_half, _halves.from_half
