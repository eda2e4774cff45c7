# SPDX-License-Identifier: GPL-2.0-or-later
"""A heap of polyhedra, boxes and balls, and the exact numbers it leads to; run in processes of their own."""

from __future__ import annotations

import numpy as np
from yade import O, Quaternion, Vector3, utils

from blocks import block, polyhedron
from scenes import box, contacts, equip, grain, material, state, steps


def build() -> None:
    generator = np.random.default_rng(4)
    material(0.4)
    box((0, 0, -1), (20, 20, 1))
    O.bodies.append(utils.facet([Vector3(-9, -9, -0.1), Vector3(9, -9, 0.4), Vector3(0, 9, 0.2)], material=O.materials[0], fixed=True))
    O.bodies.append(utils.wall(-4, 0, material=O.materials[0]))
    for k in range(36):
        place = 2.2 * np.array([k % 3, k // 3 % 3, k // 9]) + [-2, -2, 1.2]
        turn = Quaternion(Vector3(*generator.uniform(-1, 1, 3)), generator.uniform(0, 3))
        if k % 4 == 0:
            number = polyhedron(generator.uniform(-1, 1, (12, 3)), place, turn=turn)
        elif k % 4 == 1:
            number = block(place, generator.uniform(0.4, 0.9, 3), turn=turn)
        elif k % 4 == 2:
            number = O.bodies.append(utils.box(place, generator.uniform(0.4, 0.9, 3), orientation=turn, fixed=False, material=O.materials[0]))
        else:
            number = grain(place, radius=0.9)
        state(number).vel = Vector3(*generator.uniform(-1, 1, 3))
    equip(5e-3, tolerance=1e-4, maxIterations=2000, onNonConvergence="ignore")


def numbers() -> str:
    lines = []
    for b in O.bodies:
        s = b.state
        lines.append(" ".join(float(x).hex() for v in (s.pos, s.vel, s.angVel, s.angMom) for x in v))
    for i in sorted(contacts(), key=lambda i: (min(i.id1, i.id2), max(i.id1, i.id2))):
        sign = 1 if i.id1 < i.id2 else -1  # YADE may load a pair the other way round
        points = i.phys.pointImpulses if hasattr(i.phys, "pointImpulses") else [i.phys.impulse]
        lines.append(f"{min(i.id1, i.id2)} {max(i.id1, i.id2)} {i.phys.status} " + " ".join(float(sign * x).hex() for p in points for x in p))
    return "\n".join(lines)


def prepare(scene: str) -> None:
    """The scene to start from, as a file: YADE's own calculation of a polyhedron's inertia differs by round-off from process to process."""
    build()
    O.save(scene)


def straight(scene: str, result: str) -> None:
    O.load(scene)
    steps(100)
    with open(result, "w") as file:
        file.write(numbers())


def halves(scene: str, half: str, result: str) -> None:
    O.load(scene)
    steps(60)
    O.save(half)
    O.reset()
    O.load(half)
    steps(40)
    with open(result, "w") as file:
        file.write(numbers())
