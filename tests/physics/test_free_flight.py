# SPDX-License-Identifier: GPL-2.0-or-later
"""Motion without contact."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3

from scenes import EPS, G, equip, grain, material, state, steps, vec


def test_free_fall() -> None:
    """v_n = v_0 + n h g and x_n = x_0 + n h v_0 + h^2 g n (n + 1) / 2: YADE's leapfrog for a constant acceleration."""
    number, h, v0 = 1000, 1e-3, np.array([1.0, -2, 3])
    gravity = np.array([0.5, 0.25, -G])
    material()
    ball = grain((1, 2, 3), velocity=v0, spin=(3, 0, 1))
    equip(h, gravity=gravity)
    steps(number)
    # Each step rounds once; the errors add up to at most n roundings of the largest value.
    velocity = v0 + number * h * gravity
    assert np.abs(vec(state(ball).vel) - velocity).max() <= number * EPS * np.abs(velocity).max()
    place = np.array([1.0, 2, 3]) + number * h * v0 + h**2 * gravity * number * (number + 1) / 2
    path = np.abs(place).max() + number * h * np.abs(velocity).max()
    assert np.abs(vec(state(ball).pos) - place).max() <= number * EPS * path
    assert tuple(state(ball).angVel) == (3, 0, 1)


def test_orbit_of_two_grains_that_do_not_touch() -> None:
    """The engine leaves a ball alone under a force that turns: circular motion keeps its radius to order h^2."""
    h, rate, radius = 1e-3, 2 * math.pi, 5.0
    material()
    ball = grain((radius, 0, 0))
    # Leapfrog velocities belong to half steps: start with the velocity at -h/2.
    state(ball).vel = Vector3(radius * rate * math.sin(rate * h / 2), radius * rate * math.cos(rate * h / 2), 0)
    equip(h, gravity=(0, 0, 0))
    for _ in range(1000):
        O.forces.setPermF(ball, -(rate**2) * state(ball).mass * state(ball).pos)
        O.step()
    # Leapfrog: relative error of the phase is (rate h)^2 / 24 per radian, here 1.6e-6 * 2 pi in all.
    expected = np.array([radius, 0, 0])
    assert np.abs(vec(state(ball).pos) - expected).max() <= 2 * radius * 2 * math.pi * (rate * h) ** 2 / 24


@pytest.mark.parametrize("dofs", ["z", "xy"])
def test_blocked_directions_do_not_fall(dofs: str) -> None:
    """Blocked translations keep their velocity."""
    material()
    ball = grain((0, 0, 0), velocity=(1, 2, 3))
    state(ball).blockedDOFs = dofs
    equip(1e-3, gravity=(1, 1, -G))
    steps(100)
    for axis, name in enumerate("xyz"):
        change = 0 if name in dofs else 0.1 * (1, 1, -G)[axis]
        assert state(ball).vel[axis] == pytest.approx((1, 2, 3)[axis] + change, rel=1e-12)
