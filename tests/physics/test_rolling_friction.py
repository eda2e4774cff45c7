# SPDX-License-Identifier: GPL-2.0-or-later
"""Rolling and twisting friction of balls against closed forms."""

from __future__ import annotations

import math
import random

import pytest
from yade import O, Vector3, utils

from scenes import EPS, G, cd, contact, equip, floor, grain, law, state, steps


@pytest.mark.parametrize("h", [1e-3, 4e-3])
def test_ball_stops_after_the_closed_form_distance(h: float) -> None:
    """A solid ball that rolls decelerates by 5/7 mu_r g, so it stops after 7 v^2 / (10 mu_r g), here to a step of its motion."""
    rolling, speed, radius = 0.05, 2.0, 0.5
    law(rollingFriction=rolling)
    floor()
    ball = grain((0, 0, radius), radius, velocity=(speed, 0, 0), spin=(0, speed / radius, 0))
    equip(h, tolerance=1e-10)
    count = 0
    while state(ball).vel[0] > 1e-6:
        O.step()
        count += 1
        assert count < 20000
    assert state(ball).pos[0] == pytest.approx(7 * speed**2 / (10 * rolling * G), abs=speed * h)
    assert count * h == pytest.approx(speed / (5 / 7 * rolling * G), abs=2 * h)


@pytest.mark.parametrize("part, rests", [(0.99, True), (1.01, False)])
def test_ball_on_a_slope(part: float, rests: bool) -> None:
    """Rests up to tan = mu_r without creep; beyond, it rolls with 5/7 g (sin - mu_r cos)."""
    rolling = 0.1
    law(rollingFriction=rolling)
    floor()
    ball = grain((0, 0, 1))
    slope = math.atan(part * rolling)
    equip(1e-3, gravity=(G * math.sin(slope), 0, -G * math.cos(slope)), tolerance=1e-10)
    steps(200)
    expected = 0 if rests else 0.2 * 5 / 7 * G * (math.sin(slope) - rolling * math.cos(slope))
    # The torques are found to 1e-10 of what holds the ball, g h a step.
    assert state(ball).vel[0] == pytest.approx(expected, abs=1e-8)


def test_spinning_top_stops() -> None:
    """Torque mu_t r m g about the normal: time I w / (mu_t r m g) = 0.4 r w / (mu_t g)."""
    twisting, spin = 0.2, 3.0
    law(twistingFriction=twisting)
    floor()
    ball = grain((0, 0, 1), spin=(0, 0, spin))
    equip(1e-3, tolerance=1e-10)
    steps(100)
    assert state(ball).angVel[2] == pytest.approx(spin - 0.1 * twisting * G / 0.4, rel=1e-9)
    steps(1000)
    assert abs(state(ball).angVel[2]) < 1e-8


def test_two_balls_use_the_reduced_radius() -> None:
    """r1 r2 / (r1 + r2) times the coefficient, and opposite torques on the two."""
    law(rollingFriction=0.1, frictionAngle=0)
    one, two = grain((0, 0, 0), 1.0, fixed=True), grain((0, 0, 1.5), 0.5, spin=(0, 2, 0))
    equip(1e-3, gravity=(0, 0, 0), tolerance=1e-12)
    O.forces.setPermF(two, Vector3(0, 0, -1000))
    O.step()
    assert contact(one, two).phys.rollingArm == pytest.approx(0.1 / 3)
    assert O.forces.t(two)[1] == pytest.approx(-1000 * 0.1 / 3, rel=1e-9)
    assert O.forces.t(one)[1] == pytest.approx(1000 * 0.1 / 3, rel=1e-9)


def test_stopping_is_no_failure_of_the_solve() -> None:
    """In the step in which a rolling ball stops its torque goes to zero; the residual is relative to all impulses, not to that torque."""
    law(rollingFriction=0.1, frictionAngle=0.7)
    floor()
    ball = grain((0, 0, 1), velocity=(2, 0, 0), spin=(0, 2, 0))
    equip(2e-3, tolerance=1e-12, onNonConvergence="raise")
    # 7 v^2 / (10 mu_r g) = 2.85 m at a deceleration of 5/7 mu_r g: 1427 steps.
    steps(1500)
    assert state(ball).vel.norm() < 1e-10


@pytest.mark.parametrize("rolling", [0.1, 0.01, 0.001])
def test_packing_that_comes_to_rest(rolling: float) -> None:
    """The steps of a pour are solved like those without rolling friction, with no torque beyond its limit.

    Coulomb's law alone leaves one step in two thousand above the tolerance after 20,000 sweeps; here one in a hundred may be. Torques and impulses
    solved in turn left a third and more.
    """
    law(rollingFriction=rolling, twistingFriction=rolling / 2, frictionAngle=math.atan(0.5))
    generator = random.Random(1)
    radius, pitch = 0.01, 0.022
    for axis in (0, 1, 2):
        O.bodies.append(utils.wall(0, axis=axis, sense=1))
        if axis < 2:
            O.bodies.append(utils.wall(3 * pitch, axis=axis, sense=-1))
    for k in range(60):
        place = [(i + 0.5) * pitch + generator.uniform(-1e-3, 1e-3) for i in (k % 3, k // 3 % 3, k // 9)]
        grain(place, radius * generator.uniform(0.8, 1))
    O.trackEnergy = True
    equip(0.05 * math.sqrt(radius / G), maxIterations=20000, onNonConvergence="ignore")
    beyond, missed = [], []

    def judge() -> None:
        missed.append(not cd().converged)
        for each in O.interactions:
            torque, normal = each.phys.torqueImpulse, each.geom.normal
            pressed = each.phys.impulse.dot(normal)
            along = torque.dot(normal)
            # A torque is scaled to its limit. Some roundings of it and of the impulse, which is as large as (1 + mu) times its normal part.
            beyond.append((torque - along * normal).norm() - each.phys.rollingArm * pressed * (1 + 16 * EPS))
            beyond.append(abs(along) - each.phys.twistingArm * pressed * (1 + 16 * EPS))

    steps(800, judge)
    assert sum(missed) <= 8
    assert max(beyond) <= 0
    assert O.energy["contactRolling"] > 0
