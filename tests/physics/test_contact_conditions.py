# SPDX-License-Identifier: GPL-2.0-or-later
"""What the paper says of its three contact conditions: (22)/(24), (23) and (25)."""

from __future__ import annotations

import numpy as np
import pytest
from yade import O

from scenes import cd, equip, floor, grain, impulse_on, kinetic_energy, law, material, state, steps, vec

H = 1e-3
LAWS = ["quasiInelasticShock", "velocitySignorini", "signorini"]


def collide(gap: float, generator: np.random.Generator, mu: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Two balls at this gap that would close it; total impulse of two steps, approach velocity in the frame, W_N."""
    O.reset()
    material(friction=mu)
    r1, r2 = generator.uniform(0.5, 1.5, 2)
    velocity = [generator.uniform(-1, 1, 3) for _ in range(4)]
    one = grain((0, 0, 0), r1, velocity=velocity[0] + [0, 0, 3], spin=velocity[1])
    two = grain((0, 0, r1 + r2 + gap), r2, velocity=velocity[2] - [0, 0, 3], spin=velocity[3])
    equip(H, gravity=(0, 0, 0), tolerance=1e-13)
    n = np.array([0, 0, 1.0])
    u = vec(state(two).vel) - np.cross(vec(state(two).angVel), r2 * n)
    u -= vec(state(one).vel) + np.cross(vec(state(one).angVel), r1 * n)
    w = 1 / state(one).mass + 1 / state(two).mass
    total = np.zeros(3)
    for _ in range(2):
        O.step()
        total += impulse_on(two)
    return total, u, w


@pytest.mark.parametrize("mu", [0.05, 0.4, 3.0])
@pytest.mark.parametrize("gap", [0.0, 1e-3, 3e-3])
def test_shock_in_two_steps_has_the_impulse_of_one(mu: float, gap: float) -> None:
    """(25) closes the gap first and ends the approach in the next step; with a spherical W the sum is the plastic shock.

    The bodies move by some millimetres between the steps, which turns the normal: 1e-2 relative.
    """
    total, u, w = collide(gap, np.random.default_rng(5), mu)
    normal, tangential = -u[2] / w, -u[:2] / (3.5 * w)
    size = np.linalg.norm(tangential)
    tangential *= min(1, mu * normal / size)
    assert total == pytest.approx([*tangential, normal], abs=(1e-2 if gap > 0 else 1e-11) * normal)


def test_signorini_corrects_itself_at_the_price_of_energy() -> None:
    """(24): an overlap d is gone after one step, and the ball leaves with d/h and half m (d/h)^2 of energy from nowhere."""
    overlap = 2e-3
    law()
    floor()
    ball = grain((0, 0, 1 - overlap))
    equip(H, gravity=(0, 0, 0), contactLaw="signorini")
    steps(1)
    assert state(ball).pos[2] == pytest.approx(1, abs=1e-15)
    assert kinetic_energy() == pytest.approx(0.5 * state(ball).mass * (overlap / H) ** 2, rel=1e-12)


@pytest.mark.parametrize("contact_law", LAWS[:2])
def test_the_velocity_conditions_leave_an_overlap_and_add_no_energy(contact_law: str) -> None:
    law()
    floor()
    ball = grain((0, 0, 0.998))
    equip(H, gravity=(0, 0, 0), contactLaw=contact_law, repairRate=0)
    steps(10)
    assert state(ball).pos[2] == 0.998 and kinetic_energy() == 0
    cd().repairRate = 0.1
    steps(10)
    assert state(ball).pos[2] > 0.998 and kinetic_energy() == 0


def test_forecast_of_velocity_signorini() -> None:
    """(23): forecast by the velocity of now or by the free velocity, and stopped where that finds the ball."""
    for height, speed, gravity, stops in ((1.004, 5.0, 0.0, True), (1.006, 5.0, 0.0, False), (1.004, 3.9, 200.0, True)):
        O.reset()
        law()
        floor()
        ball = grain((0, 0, height), velocity=(0, 0, -speed))
        equip(H, gravity=(0, 0, -gravity), contactLaw="velocitySignorini")
        O.step()
        assert (abs(state(ball).vel[2]) < 1e-12) == stops


@pytest.mark.parametrize("contact_law", LAWS)
def test_consistency_no_oscillation_of_one_step(contact_law: str) -> None:
    """(35): contact in two consecutive steps means normal velocity zero; force and velocity are those of rest in each."""
    law()
    floor()
    ball = grain((0, 0, 1))
    equip(H, contactLaw=contact_law)
    forces = []
    for _ in range(100):
        O.step()
        # h g = 1e-2 m/s and positions near 1 m rounded to 1e-16, over h.
        assert abs(state(ball).vel[2]) < 1e-12
        forces.append(impulse_on(ball)[2])
    assert np.ptp(forces) < 1e-9 * forces[0]
