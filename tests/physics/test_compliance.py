# SPDX-License-Identifier: GPL-2.0-or-later
"""Compliant contacts: frequency, damping, static deflection and the rigid limit."""

from __future__ import annotations

import math

import pytest
from yade import O, Vector3

from scenes import G, contact, equip, floor, grain, impulse_on, law, state, steps

K = 1e6


def ball_on_spring(h: float, kn: float = K, **more) -> int:
    law(kn=kn, **more)
    floor(material=law())  # rigid: the spring is that of the ball alone
    ball = grain((0, 0, 1))
    equip(h, tolerance=1e-12)
    return ball


def test_natural_frequency() -> None:
    """Within 1 % at 50 steps a period (the average rule is off by (omega h)^2/12 = 0.13 %), and no loss of amplitude."""
    ball = ball_on_spring(1)
    sag = state(ball).mass * G / K
    O.dt = 2 * math.pi * math.sqrt(state(ball).mass / K) / 50
    heights = []
    steps(1000, lambda: heights.append(state(ball).pos[2] - 1 + sag))
    rises = [i + heights[i] / (heights[i] - heights[i + 1]) for i in range(999) if heights[i] <= 0 < heights[i + 1]]
    assert (rises[-1] - rises[0]) / (len(rises) - 1) == pytest.approx(50, rel=2e-3)
    # p of ShiftedContacts is 2.5e-4 here, the damping ratio p omega h / 2 = 1.6e-5, over 19 periods 0.2 %.
    assert -min(heights[-60:]) == pytest.approx(sag, rel=1e-2)


def test_damped_oscillation_comes_to_the_static_deflection() -> None:
    """Logarithmic decrement 2 pi z / sqrt(1 - z^2) of a dashpot with damping ratio z = d / (2 sqrt(k m)); then m g / k."""
    ball = ball_on_spring(1, normalDamping=0)
    mass = state(ball).mass
    z = 0.1
    O.materials[0].normalDamping = 2 * z * math.sqrt(K * mass)
    O.dt = 2 * math.pi * math.sqrt(mass / K) / 200
    sag, heights = mass * G / K, []
    steps(600, lambda: heights.append(state(ball).pos[2] - 1 + sag))
    dips = [-heights[i] for i in range(1, 599) if heights[i - 1] > heights[i] <= heights[i + 1]]
    # Implicit damping is first order in omega h = 0.03.
    assert math.log(dips[0] / dips[1]) == pytest.approx(2 * math.pi * z / math.sqrt(1 - z**2), rel=5e-2)
    steps(8000)
    assert state(ball).pos[2] - 1 == pytest.approx(-sag, rel=1e-6)
    assert contact(0, ball).phys.normalForce.norm() == pytest.approx(mass * G, rel=1e-6)


def test_infinite_stiffness_is_rigid() -> None:
    """The same motion as the rigid ball of condition (24), the closer the stiffer."""

    def track(kn: float, contactLaw: str) -> list[float]:
        O.reset()
        law(kn=kn)
        floor()
        ball = grain((0, 0, 1.01), velocity=(1, 0, -0.5), spin=(0, 3, 0))
        equip(1e-3, contactLaw=contactLaw, tolerance=1e-12)
        seen = []
        steps(60, lambda: seen.extend([*state(ball).pos, *state(ball).vel]))
        return seen

    rigid = track(0, "signorini")
    errors = [max(abs(a - b) for a, b in zip(track(kn, "quasiInelasticShock"), rigid)) for kn in (1e13, 1e15)]
    # kn h^2 / m = 1e3 and 1e5: the deviation of the velocity (1 m/s) is of the order of its inverse.
    assert errors[0] < 1e-2 and errors[1] < 1e-4


def test_tangential_spring_oscillates() -> None:
    """A ball that cannot turn on a tangential spring: period 2 pi sqrt(m / ks), and the force ks times the stretch."""
    law(ks=K, frictionAngle=math.atan(100))
    plate = floor(material=law(frictionAngle=math.atan(100)))
    ball = grain((0, 0, 1), velocity=(1e-3, 0, 0))
    state(ball).blockedDOFs = "XYZ"
    equip(2 * math.pi * math.sqrt(state(ball).mass / K) / 50, tolerance=1e-12)
    places = []
    steps(400, lambda: places.append(state(ball).pos[0]))
    assert impulse_on(ball)[2] > 0
    rises = [i + places[i] / (places[i] - places[i + 1]) for i in range(399) if places[i] <= 0 < places[i + 1]]
    assert (rises[-1] - rises[0]) / (len(rises) - 1) == pytest.approx(50, rel=2e-3)
    assert contact(plate, ball).phys.stretch[0] == pytest.approx(state(ball).pos[0], abs=1e-9)


def test_mortars_in_series() -> None:
    law(kn=3e6)
    floor(material=law(kn=6e6))
    ball = grain((0, 0, 1))
    equip(1e-3)
    O.step()
    assert contact(0, ball).phys.kn == pytest.approx(2e6)


@pytest.mark.parametrize("contact_law", ["quasiInelasticShock", "velocitySignorini", "signorini"])
def test_open_contact_has_no_stretch_and_no_torque(contact_law: str) -> None:
    """Also where it stays a candidate, and whether it takes part in the solve or not."""
    law(kn=1e6, ks=1e5, rollingFriction=0.1, frictionAngle=math.atan(5))
    plate = floor()
    ball = grain((0, 0, 1))
    equip(1e-3, tolerance=1e-12, contactLaw=contact_law)
    steps(200)
    state(ball).vel = Vector3(0.3, 0, 0)
    steps(20)
    phys = contact(plate, ball).phys
    assert phys.stretch.norm() > 1e-4 and phys.torqueImpulse.norm() > 0
    state(ball).pos, state(ball).vel, state(ball).angVel = Vector3(0, 0, 1.01), Vector3(0, 0, 1), Vector3(0, 0, 0)
    steps(2)
    phys = contact(plate, ball).phys
    assert phys.status == "none" and phys.gap > 0
    assert phys.stretch == Vector3(0, 0, 0) and phys.torqueImpulse == Vector3(0, 0, 0)
