# SPDX-License-Identifier: GPL-2.0-or-later
"""Balls and blocks on an incline, and a ball that slides until it rolls: textbook accelerations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Quaternion, Vector3

from scenes import G, box, contact, dumbbell, equip, floor, grain, material, state, steps, vec

H = 1e-3
NUMBER = 400
# Constant forces: the scheme is exact, v_n = n h a. Roundings of a gap of 1e-16 m divided by h = 1e-3 s enter as
# 1e-13 m/s a step into velocities of some m/s, and the solver's tolerance is 1e-12.
EXACT = 1e-9


def inclined(angle: float, turned: bool, friction: float, block: str = "") -> tuple[int, np.ndarray, np.ndarray]:
    """A ball on a plane: either the plane is turned or gravity is. Returns id, downhill direction and normal."""
    material(friction)
    if turned:
        axis = Quaternion(Vector3(0, 1, 0), angle)
        rotate = np.array([[math.cos(angle), 0, math.sin(angle)], [0, 1, 0], [-math.sin(angle), 0, math.cos(angle)]])
        down, normal = rotate @ [1, 0, 0], rotate @ [0, 0, 1]
        box(-normal, (500, 500, 1), orientation=axis)
        gravity = (0, 0, -G)
    else:
        down, normal = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
        floor(500)
        gravity = (G * math.sin(angle), 0, -G * math.cos(angle))
    ball = grain(normal)
    state(ball).blockedDOFs = block
    equip(H, gravity=gravity, tolerance=1e-12)
    return ball, down, normal


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("slope, friction", [(0.5, 0.4), (1.0, 0.3), (0.5, 0.5 / 3.5 * 1.02), (1.0, 1 / 3.5 * 1.001)])
def test_ball_rolls(slope: float, friction: float, turned: bool) -> None:
    """tan(theta) < 3.5 mu: a = 5/7 g sin(theta), omega = v / r, and the reaction is inside of the cone."""
    angle = math.atan(slope)
    ball, down, normal = inclined(angle, turned, friction)
    steps(NUMBER)
    speed = 5 / 7 * G * math.sin(angle) * NUMBER * H
    assert np.abs(vec(state(ball).vel) - speed * down).max() <= EXACT * speed
    assert np.abs(vec(state(ball).angVel) - np.cross(normal, speed * down)).max() <= EXACT * speed
    i = contact(0, ball)
    assert i.phys.status == "sticking"
    assert i.phys.shearForce.norm() == pytest.approx(2 / 7 * state(ball).mass * G * math.sin(angle), rel=1e-8)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("slope, friction", [(1.0, 0.1), (0.5, 0.0), (1.0, 1 / 3.5 * 0.98), (2.0, 0.5)])
def test_ball_slips(slope: float, friction: float, turned: bool) -> None:
    """tan(theta) > 3.5 mu: a = g (sin(theta) - mu cos(theta)), angular acceleration 5/2 mu g cos(theta) / r."""
    angle = math.atan(slope)
    ball, down, normal = inclined(angle, turned, friction)
    steps(NUMBER)
    speed = G * (math.sin(angle) - friction * math.cos(angle)) * NUMBER * H
    spin = 2.5 * friction * G * math.cos(angle) * NUMBER * H
    assert np.abs(vec(state(ball).vel) - speed * down).max() <= EXACT * speed
    assert np.abs(vec(state(ball).angVel) - np.cross(normal, spin * down)).max() <= EXACT * speed
    assert contact(0, ball).phys.status == ("sliding" if friction else contact(0, ball).phys.status)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("ratio", [0.5, 0.99, 0.9999])
def test_block_sticks(ratio: float, turned: bool) -> None:
    """A body that cannot turn stays where it is if tan(theta) < mu."""
    friction = 0.6
    ball, down, normal = inclined(math.atan(ratio * friction), turned, friction, block="XYZ")
    start = vec(state(ball).pos)
    steps(NUMBER)
    assert np.abs(vec(state(ball).pos) - start).max() <= 1e-10
    assert contact(0, ball).phys.status == "sticking"


@pytest.mark.parametrize("block", ["XYZ", "yXYZ"])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("ratio", [1.0001, 1.01, 2.0])
def test_block_slides(ratio: float, turned: bool, block: str) -> None:
    """It slides with g (sin(theta) - mu cos(theta)) if tan(theta) > mu; also when the motion is confined to a plane."""
    friction = 0.6
    angle = math.atan(ratio * friction)
    ball, down, _ = inclined(angle, turned, friction, block)
    steps(NUMBER)
    speed = G * (math.sin(angle) - friction * math.cos(angle)) * NUMBER * H
    # The difference of nearly equal numbers: relative to the speed without friction.
    assert np.abs(vec(state(ball).vel) - speed * down).max() <= EXACT * G * NUMBER * H
    assert contact(0, ball).phys.status == "sliding"


@pytest.mark.parametrize("ratio, moves", [(0.98, False), (1.02, True)])
@pytest.mark.parametrize("block", ["", "yXZ", "XYZ"])
def test_clump_of_four_sticks_or_slides(ratio: float, moves: bool, block: str) -> None:
    """A block of four balls on four points, free to turn or not; wide enough not to topple."""
    friction = 0.5
    angle = math.atan(ratio * friction)
    material(friction)
    floor(500)
    number, _ = dumbbell([(x, y, 1) for x in (-3, 3) for y in (-3, 3)])
    state(number).blockedDOFs = block
    equip(H, gravity=(G * math.sin(angle), 0, -G * math.cos(angle)), tolerance=1e-10, maxIterations=100000)
    steps(200)
    speed = max(0.0, G * (math.sin(angle) - friction * math.cos(angle)) * 200 * H)
    # Four contacts are solved by iteration: 1e-10 of g h in each of 200 steps, and a condition number below 100.
    assert abs(state(number).vel[0] - speed) <= 200 * 100 * 1e-10 * G * H
    assert state(number).vel.norm() == pytest.approx(speed, abs=1e-6)


@pytest.mark.parametrize("friction", [0.05, 0.3, 2.0])
def test_billiard_ball_keeps_five_sevenths_of_its_speed(friction: float) -> None:
    """Sliding turns into rolling after 2 v0 / (7 mu g); the momentum about the contact point is kept: v = 5/7 v0."""
    v0 = 3.0
    material(friction)
    floor(500)
    ball = grain((0, 0, 1), velocity=(v0, 0, 0))
    equip(H, tolerance=1e-12)
    duration = 2 * v0 / (7 * friction * G)
    last_slip = 0
    for k in range(1, int(1.2 * duration / H) + 20):
        O.step()
        if contact(0, ball).phys.status == "sliding":
            last_slip = k
            assert state(ball).vel[0] == pytest.approx(v0 - friction * G * k * H, rel=EXACT)
    assert abs(last_slip * H - duration) <= H
    # Every impulse acts at a lever arm that differs from the radius by roundings only.
    assert state(ball).vel[0] == pytest.approx(5 / 7 * v0, rel=EXACT)
    assert state(ball).angVel[1] == pytest.approx(5 / 7 * v0, rel=EXACT)


def test_billiard_ball_with_backspin_comes_back() -> None:
    """v = (5 v0 + 2 r omega0) / 7 with omega0 against the motion."""
    material(0.4)
    floor(500)
    ball = grain((0, 0, 1), velocity=(2, 0, 0), spin=(0, -10, 0))
    equip(H, tolerance=1e-12)
    steps(3000)
    assert state(ball).vel[0] == pytest.approx((5 * 2 - 2 * 10) / 7, rel=EXACT)


def test_billiard_ball_with_sidespin_curves() -> None:
    """Spin about the path: each component of the momentum about the contact point is kept."""
    material(0.4)
    floor(500)
    ball = grain((0, 0, 1), velocity=(2, 0, 0), spin=(5, 0, 3))
    equip(H, tolerance=1e-12)
    steps(3000)
    # v_y ends where 7/5 v_y = -2/5 omega_x r of the start; the spin about the vertical is untouched.
    assert vec(state(ball).vel)[:2] == pytest.approx([5 / 7 * 2, -2 / 7 * 5], rel=1e-8)
    assert state(ball).angVel[2] == pytest.approx(3, rel=1e-12)
