# SPDX-License-Identifier: GPL-2.0-or-later
"""Bonds break at their strength, and blocks start at the static friction angle."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3

from scenes import G, contact, engine, equip, floor, grain, law, state, steps, vec

H = 1e-3
PART = 1e-6  # loads this much below and above the strength; the solve is exact to 1e-10


def pull(number: int, force) -> None:
    O.forces.setPermF(number, Vector3(*force))
    O.step()


@pytest.mark.parametrize("stress", [0.0, 300.0])
def test_pull_off_force(stress: float) -> None:
    """Strength F_c + c A / mu; in the step of the break the force is the strength, afterwards nothing."""
    law(cohesionForce=1000, cohesionStress=stress, frictionAngle=math.atan(0.5))
    one, two = grain((0, 0, 0), fixed=True), grain((0, 0, 2))
    strength = 1000 + stress * math.pi / 0.5
    equip(H, gravity=(0, 0, 0), tolerance=1e-10)
    for part in (0, 0.5, 1 - PART):
        pull(two, (0, 0, part * strength))
        i = contact(one, two)
        assert i.phys.bond == "intact"
        assert i.phys.normalForce[2] == pytest.approx(-part * strength, abs=1e-8 * strength)
        assert abs(state(two).vel[2]) < 1e-12
    pull(two, (0, 0, (1 + PART) * strength))
    assert i.phys.bond == "broken" and i.phys.normalForce[2] == pytest.approx(-strength, rel=1e-12)
    before = state(two).vel[2]
    pull(two, (0, 0, 10))
    assert contact(one, two) is None or contact(one, two).phys.normalForce.norm() == 0
    assert state(two).vel[2] - before == pytest.approx(10 * H / state(two).mass, rel=1e-9)


@pytest.mark.parametrize("normal", [0.0, 700.0, -300.0])
def test_mohr_coulomb_shear_strength(normal: float) -> None:
    """c A + mu N, pulled (N < 0) or pressed; A is the cross-section of the ball, and afterwards there is friction only."""
    mu, c, radius = 0.5, 400.0, 1.0
    law(cohesionStress=c, frictionAngle=math.atan(mu))
    plate = floor()
    ball = grain((0, 0, radius), radius)
    state(ball).blockedDOFs = "XYZ"
    equip(H, gravity=(0, 0, 0), tolerance=1e-11)
    strength = c * math.pi * radius**2 + mu * normal
    for part in (0.0, 0.7, 1 - PART):
        pull(ball, (part * strength, 0, -normal))
        assert contact(plate, ball).phys.bond == "intact"
        assert np.linalg.norm(vec(state(ball).vel)) < 1e-12
    pull(ball, ((1 + PART) * strength, 0, -normal))
    i = contact(plate, ball)
    assert i.phys.bond == "broken"
    assert i.phys.shearForce.norm() == pytest.approx(strength, rel=1e-9)
    if normal > 0:
        pull(ball, (strength, 0, -normal))
        assert i.phys.shearForce.norm() == pytest.approx(mu * normal, rel=1e-9)


def test_bond_forms_at_touch_not_at_a_distance() -> None:
    law(cohesionForce=1e5)
    plate = floor()
    ball = grain((0, 0, 1.02), velocity=(0, 0, -1))
    equip(H, gravity=(0, 0, 0))
    steps(10)
    assert contact(plate, ball).phys.bond == "none" and state(ball).vel[2] == -1
    steps(20)
    assert contact(plate, ball).phys.bond == "intact"
    pull(ball, (0, 0, 9e4))
    assert abs(state(ball).vel[2]) < 1e-9


def test_no_bonds_where_switched_off() -> None:
    law(cohesionForce=1e5)
    plate = floor()
    ball = grain((0, 0, 1))
    equip(H)
    engine("InteractionLoop").physDispatcher.functors[1].bonding = False
    steps(3)
    pull(ball, (0, 0, 2 * G * state(ball).mass))
    assert state(ball).vel[2] == pytest.approx(G * H, rel=1e-9) and contact(plate, ball).phys.bond == "none"


@pytest.mark.parametrize("steeper, moves", [(-1e-6, False), (1e-6, True)])
def test_block_starts_at_the_static_angle(steeper: float, moves: bool) -> None:
    """A block (a ball that cannot turn) on a slope: rests up to tan = mu_s, then slides with g (sin - mu_d cos)."""
    static, dynamic = 0.6, 0.4
    law(frictionAngle=math.atan(dynamic), staticFrictionAngle=math.atan(static))
    floor()
    ball = grain((0, 0, 1))
    state(ball).blockedDOFs = "XYZ"
    slope = math.atan(static) + steeper
    equip(H, gravity=(G * math.sin(slope), 0, -G * math.cos(slope)), tolerance=1e-12)
    steps(10)
    if not moves:
        assert abs(state(ball).vel[0]) < 1e-13
        return
    before = state(ball).vel[0]
    steps(100)
    gained = 100 * H * G * (math.sin(slope) - dynamic * math.cos(slope))
    assert state(ball).vel[0] - before == pytest.approx(gained, rel=1e-9)


def test_sliding_block_keeps_sliding_between_the_angles_and_stays_once_at_rest() -> None:
    """Between the two angles the history decides: a block that moves slides on, slower, one that has stopped stays."""
    static, dynamic, speed = 0.6, 0.4, 0.5
    law(frictionAngle=math.atan(dynamic), staticFrictionAngle=math.atan(static))
    floor()
    ball = grain((0, 0, 1), velocity=(speed, 0, 0))
    state(ball).blockedDOFs = "XYZ"
    slope = math.atan(0.3)
    equip(H, gravity=(G * math.sin(slope), 0, -G * math.cos(slope)), tolerance=1e-12)
    deceleration = G * (dynamic * math.cos(slope) - math.sin(slope))
    count = 0
    while state(ball).vel[0] > 1e-9:
        O.step()
        count += 1
        assert count < 2000
    # One step at mu_s at the beginning and one at the end, out of some 500.
    assert count * H == pytest.approx(speed / deceleration, abs=3 * H)
    steps(5)
    assert abs(state(ball).vel[0]) < 1e-13 and contact(0, ball).phys.status == "sticking"
