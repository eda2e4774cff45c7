# SPDX-License-Identifier: GPL-2.0-or-later
"""Statics: forces that follow from equilibrium alone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, utils

from scenes import G, ball_mass, cd, contact, equip, floor, grain, material, state, steps, vec

H = 1e-3


@pytest.mark.parametrize("number", [1, 5, 20])
@pytest.mark.parametrize("kind", ["floor of a box", "wall"])
def test_column(number: int, kind: str) -> None:
    """The k-th contact carries the weight above it.

    Tolerance 1e-12 of the solver, relative to the impulses in the W norm; the operator of a column of n equal balls has
    a condition number of about n^2, hence 1e-12 * n^2 < 1e-9.
    """
    material()
    base = floor() if kind != "wall" else O.bodies.append(utils.wall(0, 2, material=O.materials[0]))
    balls = [grain((0, 0, 1 + 2 * k)) for k in range(number)]
    equip(H, tolerance=1e-12, maxIterations=500000)
    for done in (1, 4):
        steps(done)
        assert cd().converged
        for k, ball in enumerate(balls):
            i = contact(base if k == 0 else balls[k - 1], ball)
            weight = (number - k) * ball_mass(1) * G
            assert i.phys.normalForce.norm() == pytest.approx(weight, rel=1e-9)
            assert i.phys.shearForce.norm() <= 1e-9 * weight


def test_column_of_unequal_balls() -> None:
    """Different sizes and densities, the heavy ones on top."""
    floor(material=material())
    height, masses, balls = 0.0, [], []
    for k in range(8):
        radius, density = 0.5 + 0.1 * k, 1000.0 * (k + 1)
        balls.append(grain((0, 0, height + radius), radius, material=material(density=density)))
        masses.append(ball_mass(radius, density))
        height += 2 * radius
    equip(H, tolerance=1e-12, maxIterations=500000)
    steps(3)
    assert cd().converged
    for k, ball in enumerate(balls):
        i = contact(0 if k == 0 else balls[k - 1], ball)
        # The masses span a factor of 100, which the condition number of the operator inherits: 1e-12 * 8^2 * 100.
        assert i.phys.normalForce.norm() == pytest.approx(sum(masses[k:]) * G, rel=1e-8)


@pytest.mark.parametrize("friction, stands", [(0.25, False), (0.28, False), (0.29, True), (0.5, True)])
def test_pyramid_of_three_discs(friction: float, stands: bool) -> None:
    """One ball on two that do not touch each other, motion in a plane: statically determinate.

    The line of centres is inclined by a to the vertical, sin(a) = 1.05 / 2. Balance of the lower ball about its contact
    with the floor: the upper contact carries a force through that point, inclined by a/2 to its normal. So the pile
    stands if mu > tan(a/2) = 0.2836; the upper normal force is half of the ball's weight, and the friction at both
    contacts of a lower ball is tan(a/2) times that.
    """
    material(friction)
    floor()
    half = math.tan(math.asin(1.05 / 2) / 2)
    height = 1 + 2 * math.cos(math.asin(1.05 / 2))
    low = [grain((-1.05, 0, 1)), grain((1.05, 0, 1))]
    top = grain((0, 0, height))
    for ball in (*low, top):
        state(ball).blockedDOFs = "yXZ"
    equip(H, tolerance=1e-10, maxIterations=100000)
    steps(200)
    moved = abs(state(top).pos[2] - height)
    if not stands:
        assert moved > 1e-5
        return
    assert moved <= 1e-9
    weight = state(top).mass * G
    # Tolerance of the solver times the condition number of five contacts, below 1e3.
    for ball in low:
        assert contact(0, ball).phys.normalForce.norm() == pytest.approx(1.5 * weight, rel=1e-7)
        assert contact(0, ball).phys.shearForce.norm() == pytest.approx(0.5 * weight * half, rel=1e-7)
        assert contact(ball, top).phys.normalForce.norm() == pytest.approx(0.5 * weight, rel=1e-7)
        assert contact(ball, top).phys.shearForce.norm() == pytest.approx(0.5 * weight * half, rel=1e-7)


def test_ball_in_a_groove() -> None:
    """Two fixed balls carry a third without friction: each m g / (2 cos 30 deg)."""
    material(friction=0)
    left, right = grain((-1, 0, 0), fixed=True), grain((1, 0, 0), fixed=True)
    top = grain((0, 0, math.sqrt(3)))
    equip(H, tolerance=1e-12, maxIterations=10000)
    steps(3)
    expected = state(top).mass * G / (2 * math.cos(math.radians(30)))
    for side in (left, right):
        assert contact(side, top).phys.normalForce.norm() == pytest.approx(expected, rel=1e-9)


def test_weight_is_felt_by_the_floor_whatever_the_mass_ratio() -> None:
    """A ball ten thousand times heavier than the one below it."""
    floor(material=material())
    grain((0, 0, 1))
    heavy = grain((0, 0, 3), material=material(density=2.6e7))
    equip(H, tolerance=1e-12, maxIterations=500000)
    steps(2)
    weight = (ball_mass(1) + state(heavy).mass) * G
    # Condition number about twice the mass ratio: 1e-12 * 2e4.
    assert vec(O.forces.f(0)) == pytest.approx(np.array([0, 0, -weight]), rel=1e-7, abs=1e-7 * weight)
