# SPDX-License-Identifier: GPL-2.0-or-later
"""Several fixed planes at once, made of boxes, walls or facets: the kind of shape does not matter."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3, utils

from scenes import G, active, box, cd, contact, dumbbell, equip, grain, material, state, steps, vec

H = 1e-3
KINDS = ["box", "wall", "facet"]


def plane(kind: str, axis: int) -> int:
    """A fixed plane through the origin across `axis`, its outside on the positive side."""
    if kind == "wall":
        return O.bodies.append(utils.wall(0, axis, material=O.materials[0]))
    if kind == "box":
        center, half = np.zeros(3), np.full(3, 60.0)
        center[axis], half[axis] = -1, 1
        return box(center, half)
    corners = [np.zeros(3) for _ in range(3)]
    for corner, (a, b) in zip(corners, ((-50, -40), (60, -45), (0, 80))):
        corner[(axis + 1) % 3], corner[(axis + 2) % 3] = a, b
    return O.bodies.append(utils.facet([Vector3(*c) for c in corners], material=O.materials[0]))


@pytest.mark.parametrize("kind", KINDS)
def test_ball_in_a_corner(kind: str) -> None:
    """Three planes without friction carry one component of the weight each."""
    material(friction=0)
    planes = [plane(kind, axis) for axis in range(3)]
    ball = grain((1, 1, 1))
    gravity = np.array([-3.0, -5, -G])
    equip(H, gravity=gravity, tolerance=1e-12, maxIterations=10000)
    steps(5)
    for axis, number in enumerate(planes):
        assert vec(O.forces.f(number))[axis] == pytest.approx(state(ball).mass * gravity[axis], rel=1e-9)
    assert vec(state(ball).vel) == pytest.approx([0, 0, 0], abs=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_ball_flies_into_a_corner(kind: str) -> None:
    """Without friction every plane takes the component of the velocity across it, whenever it is reached."""
    material(friction=0)
    for axis in range(3):
        plane(kind, axis)
    ball = grain((1.1, 1.2, 1.05), velocity=(-3, -4, -5))
    equip(H, gravity=(0, 0, 0), tolerance=1e-12, maxIterations=10000)
    steps(100)
    assert vec(state(ball).pos) == pytest.approx([1, 1, 1], abs=1e-11)
    assert vec(state(ball).vel) == pytest.approx([0, 0, 0], abs=1e-11)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("friction", [0.1, 0.6])
def test_ball_leans_on_a_wall_and_rolls_down(kind: str, friction: float) -> None:
    """A ball pushed against a vertical plane: it falls with g - 2/7 g if it can roll, otherwise with g - mu p / m.

    Rolling needs 2/7 m g of friction; the wall is pushed with p = 0.7 m g.
    """
    material(friction)
    wall = plane(kind, 0)
    ball = grain((1, 0, 3))
    equip(H, gravity=(-0.7 * G, 0, -G), tolerance=1e-12)
    number = 300
    steps(number)
    rolls = friction * 0.7 > 2 / 7
    fall = (5 / 7 if rolls else 1 - 0.7 * friction) * G * number * H
    assert state(ball).vel[2] == pytest.approx(-fall, rel=1e-9)
    drag = min(2 / 7, 0.7 * friction) * G
    assert abs(state(ball).angVel[1]) == pytest.approx(2.5 * drag * number * H, rel=1e-9)
    assert contact(wall, ball).phys.status == ("sticking" if rolls else "sliding")


@pytest.mark.parametrize("kind", KINDS)
def test_dumbbell_slides_flat(kind: str) -> None:
    """A dumbbell that slides on both ends, along its axis: v = v0 - mu g t, and it does not turn over.

    Friction acts a radius below the axis; its moment shifts weight to the front end: N = m g / 2 (1 +- mu r / a).
    """
    material(friction=0.3)
    plane(kind, 2)
    half = 2.0
    number, (rear, front) = dumbbell([(-half, 0, 1), (half, 0, 1)])
    state(number).vel = Vector3(5, 0, 0)
    equip(H, tolerance=1e-12, maxIterations=100000)
    steps(300)
    # Two coupled contacts, solved to 1e-12 a step; the gap is kept by velocities, so errors of g h 1e-12 add up.
    assert vec(state(number).vel) == pytest.approx([5 - 0.3 * G * 300 * H, 0, 0], abs=1e-8)
    weight = state(number).mass * G
    loads = {i.id2: i.phys.normalForce.norm() for i in active()}
    assert loads[front] == pytest.approx(weight / 2 * (1 + 0.3 / half), rel=1e-6)
    assert loads[rear] == pytest.approx(weight / 2 * (1 - 0.3 / half), rel=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_ladder_between_floor_and_wall(kind: str) -> None:
    """A dumbbell leans on a wall without friction at its upper end and stands on the floor with friction.

    Statics in the plane: moments about the contact of the foot give the force on the wall, and the friction of the
    floor is as large.
    """
    smooth = material(friction=0)
    floor, side = plane(kind, 2), plane(kind, 0)
    rough = material(friction=0.8)
    O.bodies[floor].material = rough
    phi, length = math.radians(50), 5.0
    low = np.array([1 + length * math.cos(phi), 0, 1.0])
    high = np.array([1.0, 0, 1 + length * math.sin(phi)])
    number, (foot, head) = dumbbell([low, high], material=rough)
    state(number).blockedDOFs = "yXZ"
    assert O.bodies[side].material.id == smooth.id
    equip(H, tolerance=1e-12, maxIterations=100000)
    O.step()
    weight = state(number).mass * G
    # The foot's contact lies a radius below its centre: m g L/2 cos(phi) = P (L sin(phi) + r).
    push = weight * length / 2 * math.cos(phi) / (length * math.sin(phi) + 1)
    assert cd().converged
    assert contact(side, head).phys.normalForce.norm() == pytest.approx(push, rel=1e-8)
    assert contact(floor, foot).phys.normalForce.norm() == pytest.approx(weight, rel=1e-8)
    assert contact(floor, foot).phys.shearForce.norm() == pytest.approx(push, rel=1e-8)
