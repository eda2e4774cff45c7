# SPDX-License-Identifier: GPL-2.0-or-later
"""Aspherical bodies: contact errors shrink with the time step, in first order."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3

from scenes import G, active, ball_inertia, ball_mass, dumbbell, equip, floor, material, state, vec

HALF, FIRST, LAST = 2.0, math.radians(75), math.radians(25)


def fall(h: float) -> dict[str, float]:
    """A dumbbell stands on one end on a floor without friction and falls over; largest errors on the way.

    Without friction the mass centre only moves up and down, z = r + a sin(phi), and energy gives
    phi'^2 = 2 m g a (sin(phi_0) - sin(phi)) / (I + m a^2 cos(phi)^2).
    """
    O.reset()
    material(friction=0)
    floor()
    axis = np.array([math.cos(FIRST), 0, math.sin(FIRST)])
    centre = np.array([0, 0, 1 + HALF * math.sin(FIRST)])
    number, (low, high) = dumbbell([centre - HALF * axis, centre + HALF * axis])
    mass, inertia = 2 * ball_mass(1), 2 * (ball_inertia(1) + ball_mass(1) * HALF**2)
    equip(h, tolerance=1e-12, maxIterations=10000)
    errors = {"rate": 0.0, "gap": 0.0, "normal velocity": 0.0}
    angle = FIRST
    while angle > LAST:
        O.step()
        across = vec(state(high).pos) - vec(state(low).pos)
        angle = math.atan2(across[2], math.hypot(across[0], across[1]))
        fallen = 2 * mass * G * HALF * (math.sin(FIRST) - math.sin(angle))
        rate = math.sqrt(max(0, fallen / (inertia + mass * (HALF * math.cos(angle)) ** 2)))
        errors["rate"] = max(errors["rate"], abs(state(number).angVel.norm() - rate))
        errors["gap"] = max(errors["gap"], abs(state(low).pos[2] - 1))
        if active():
            # Velocity of the lowest point from what YADE reports after the step.
            s = state(number)
            arm = vec(state(low).pos) - [0, 0, 1] - vec(s.pos)
            speed = (vec(s.vel) + np.cross(vec(s.angVel), arm))[2]
            errors["normal velocity"] = max(errors["normal velocity"], abs(speed))
    return errors


def test_errors_of_a_falling_dumbbell_are_of_first_order() -> None:
    """Halving the step halves the errors: ratios near 2, taken as above 1.7 because the errors are largest values."""
    results = [fall(h) for h in (4e-3, 2e-3, 1e-3)]
    for what in results[0]:
        e = [r[what] for r in results]
        assert e[0] / e[1] > 1.7 and e[1] / e[2] > 1.7, f"{what}: {e}"
    # And they are small already: g h = 1e-2 m/s is the natural size of an error of velocity.
    assert results[-1]["rate"] < 0.05 and results[-1]["gap"] < 1e-2


def spinning_on_its_ends(h: float) -> float:
    """A dumbbell lies on a floor and spins about the vertical with friction: worst sinking within a second."""
    O.reset()
    material(friction=0.3)
    floor()
    number, members = dumbbell([(-HALF, 0, 1), (HALF, 0, 1)])
    s = state(number)
    inertia = 2 * (ball_inertia(1) + ball_mass(1) * HALF**2)
    s.angVel, s.angMom = Vector3(0, 0, 6), Vector3(0, 0, 6 * inertia)
    equip(h, tolerance=1e-10, maxIterations=10000)
    worst = 0.0
    for _ in range(round(1 / h)):
        O.step()
        worst = max(worst, max(abs(state(m).pos[2] - 1) for m in members))
    return worst


def test_spinning_dumbbell_stays_on_the_floor() -> None:
    """Rotation about a principal axis: no first-order error of the orientation enters the gap at all."""
    assert spinning_on_its_ends(2e-3) <= 1e-8


def test_friction_stops_a_spinning_dumbbell_in_time() -> None:
    """Both ends slide in a circle: I alpha = mu m g a, so it stands still after I omega / (mu m g a).

    The friction of each end acts against its own velocity, across the arm a to its contact point below the centre.
    """
    material(friction=0.3)
    floor()
    number, _ = dumbbell([(-HALF, 0, 1), (HALF, 0, 1)])
    s = state(number)
    mass, inertia = 2 * ball_mass(1), 2 * (ball_inertia(1) + ball_mass(1) * HALF**2)
    s.angVel, s.angMom = Vector3(0, 0, 3), Vector3(0, 0, 3 * inertia)
    h = 1e-3
    equip(h, tolerance=1e-10, maxIterations=10000)
    duration = inertia * 3 / (0.3 * mass * G * HALF)
    for k in range(1, int(duration / h) - 5):
        O.step()
        expected = 3 * inertia - 0.3 * mass * G * HALF * k * h
        # The direction of sliding is taken with the arm at the start of a step: relative error of order (omega h)^2.
        assert s.angMom[2] == pytest.approx(expected, abs=2 * (3 * h) * 0.3 * mass * G * HALF * k * h + 1e-6 * inertia)
    for _ in range(20):
        O.step()
    assert s.angVel.norm() <= 1e-8
