# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks for the tests: YADE's own polyhedra, and their scenes."""

from __future__ import annotations

import itertools
import math
from typing import Sequence

import numpy as np
from yade import O, Quaternion, Vector3, polyhedra_utils

from scenes import G, Triple, equip, material, state, vec


def corners(half: Triple) -> list[Vector3]:
    """Corners of a cuboid around the origin."""
    return [Vector3(*(sign * side for sign, side in zip(signs, half))) for signs in itertools.product((-1, 1), repeat=3)]


def polyhedron(points: Sequence, position: Triple | None = None, turn: Quaternion | None = None, **more) -> int:
    """Append the convex hull of `points` as a Polyhedra body; `position` and `turn` place the centroid and rotate the body about it."""
    more.setdefault("material", O.materials[0] if len(O.materials) else material())
    body = polyhedra_utils.polyhedra(v=[Vector3(*point) for point in points], **more)
    if position is not None:
        body.state.pos = Vector3(*position)
    if turn is not None:
        body.state.ori = turn * body.state.ori
    return O.bodies.append(body)


def block(position: Triple, half: Triple = (0.5, 0.5, 0.5), **more) -> int:
    """A cuboid as a Polyhedra body."""
    return polyhedron(corners(half), position, **more)


def slope(tangent: float, dt: float, **more) -> None:
    """Engines of a scene whose floor is inclined: gravity leans along +x by an angle of this tangent."""
    angle = math.atan(tangent)
    equip(dt, gravity=(G * math.sin(angle), 0, -G * math.cos(angle)), **more)


def vertices(number: int) -> np.ndarray:
    """Where the vertices of a Polyhedra body are, one a row."""
    s = state(number)
    return np.array([vec(s.pos + s.ori * vertex) for vertex in O.bodies[number].shape.v])


def turned(number: int, before: Quaternion) -> float:
    """Angle by which the body has turned since its orientation was `before` [rad]."""
    # The vector part: 2 acos of the scalar part would lose angles below 1e-8 to round-off.
    difference = O.bodies[number].state.ori * before.conjugate()
    return 2 * math.asin(min(1.0, math.hypot(difference[0], difference[1], difference[2])))
