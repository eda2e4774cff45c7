# SPDX-License-Identifier: GPL-2.0-or-later
"""Rolling and twisting friction of balls against closed forms."""

from __future__ import annotations

import math

import pytest
from yade import O, Vector3

from scenes import G, cd, contact, equip, floor, grain, law, state, steps


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
    """In the step in which a rolling ball stops its torque goes to zero; the bound of the torque is the measure then, not the torque."""
    law(rollingFriction=0.1, frictionAngle=0.7)
    floor()
    ball = grain((0, 0, 1), velocity=(2, 0, 0), spin=(0, 2, 0))
    equip(2e-3, tolerance=1e-12, onNonConvergence="raise")
    # 7 v^2 / (10 mu_r g) = 2.85 m at a deceleration of 5/7 mu_r g: 1427 steps.
    steps(1500)
    assert state(ball).vel.norm() < 1e-10


def test_passes_share_the_sweeps_of_a_step() -> None:
    """Each pass over the torques is a solve; maxIterations is the bound of all of them, told by the count and by the status."""
    law(rollingFriction=0.2, twistingFriction=0.1, frictionAngle=0.5)
    floor()
    for k in range(27):
        grain((2.02 * (k % 3) + 0.1 * (k // 9), 2.02 * (k // 3 % 3), 1 + 1.99 * (k // 9)), velocity=(1, 0.3 * (k % 3), -1), spin=(0, 1, 0.5))
    equip(1e-3, tolerance=1e-10, maxIterations=20, onNonConvergence="ignore")
    swept, missed = [], []
    steps(40, lambda: (swept.append(cd().iterations), missed.append(not cd().converged)))
    assert max(swept) == 20 and all(sweeps == 20 for sweeps, miss in zip(swept, missed) if miss) and any(missed)
