# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts without restitution (e = 0) against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3

from scenes import (
    G,
    active,
    ball_inertia,
    ball_mass,
    cd,
    contact,
    dumbbell,
    equip,
    floor,
    grain,
    impulse_on,
    material,
    rotation,
    state,
    steps,
    vec,
)

# One contact is solved in closed form, whatever the tolerance: what is left are roundings. The gap of about 1e-16 m
# of two bodies that touch is divided by h = 1e-3 s and gives velocities of 1e-13 m/s.
H = 1e-3
CLOSED_FORM = 1e-12


@pytest.mark.parametrize("part", [0.0, 0.3, 0.999])
def test_ball_dropped_on_a_floor_stops_in_two_steps(part: float) -> None:
    """Law (25): the first step closes the gap exactly, U_N = -g/h, the second one stops the ball.

    `part` is the gap at the beginning of the first of the two steps, as a fraction of what the ball would travel. The
    impulse of both steps together is the momentum of the ball and two steps of its weight.
    """
    speed = 3.0
    material()
    floor()
    ball = grain((0, 0, 1 + part * (speed + G * H) * H), velocity=(0, 0, -speed))
    equip(H)
    total = 0.0
    for _ in range(2):
        O.step()
        total += impulse_on(ball)[2]
    assert abs(state(ball).vel[2]) <= CLOSED_FORM
    assert abs(state(ball).pos[2] - 1) <= CLOSED_FORM
    assert total == pytest.approx(state(ball).mass * (speed + 2 * G * H), rel=CLOSED_FORM)
    steps(10)
    assert abs(state(ball).vel[2]) <= CLOSED_FORM and abs(state(ball).pos[2] - 1) <= CLOSED_FORM


def test_ball_dropped_from_a_height() -> None:
    """The whole fall: every impulse until rest adds up to the weight times the time."""
    material()
    floor()
    ball = grain((0, 0, 1.37))
    equip(H)
    total, first = 0.0, None
    for k in range(500):
        O.step()
        push = impulse_on(ball)[2]
        if push > 0 and first is None:
            first = k
        total += push
        if first is not None and k > first:
            assert abs(state(ball).vel[2]) <= CLOSED_FORM
    # The ball covers 0.37 m in sqrt(2 * 0.37 / g) = 0.2746 s; leapfrog falls within a step of that.
    assert abs(first * H - math.sqrt(2 * 0.37 / G)) <= 2 * H
    assert total == pytest.approx(state(ball).mass * G * 500 * H, rel=CLOSED_FORM)


@pytest.mark.parametrize(
    "law, speed",
    [
        ("quasiInelasticShock", -4.0),  # closes the gap of 4 mm in this step
        ("velocitySignorini", 0.0),  # a contact that is forecast stops the approach at once, (23)
        ("signorini", -4.0),  # (24)
    ],
)
def test_laws_at_a_gap_that_closes(law: str, speed: float) -> None:
    material()
    floor()
    ball = grain((0, 0, 1.004), velocity=(0, 0, -10))
    equip(H, contactLaw=law)
    O.step()
    assert state(ball).vel[2] == pytest.approx(speed, abs=1e-11)


@pytest.mark.parametrize("law", ["quasiInelasticShock", "velocitySignorini", "signorini"])
def test_laws_at_a_gap_that_stays_open(law: str) -> None:
    """Nothing happens to a ball that does not arrive in this step."""
    material()
    floor()
    ball = grain((0, 0, 1.011), velocity=(0, 0, -10))
    equip(H, gravity=(0, 0, 0), contactLaw=law)
    O.step()
    assert state(ball).vel[2] == -10
    assert impulse_on(ball) == pytest.approx([0, 0, 0], abs=0)


@pytest.mark.parametrize("law, speed", [("quasiInelasticShock", 0.0), ("velocitySignorini", 0.0), ("signorini", 2.0)])
def test_laws_at_an_overlap(law: str, speed: float) -> None:
    """An overlap of 2 mm: only `signorini` removes it, in one step of 1 ms."""
    material()
    floor()
    ball = grain((0, 0, 0.998), velocity=(0, 0, -1))
    equip(H, contactLaw=law)
    O.step()
    assert state(ball).vel[2] == pytest.approx(speed, abs=1e-11)
    assert cd().maxPenetration == pytest.approx(2e-3, abs=1e-14)


@pytest.mark.parametrize("law", ["quasiInelasticShock", "velocitySignorini", "signorini"])
def test_bodies_that_part_are_not_held(law: str) -> None:
    material()
    floor()
    ball = grain((0, 0, 1), velocity=(0, 0, 2))
    equip(H, gravity=(0, 0, 0), contactLaw=law)
    O.step()
    assert state(ball).vel[2] == 2


def two_balls(friction: float, generator: np.random.Generator) -> None:
    """Balls of different size and weight touch in a random direction with random velocities and spins."""
    O.reset()
    one, two = material(friction, density=2000), material(friction, density=3500)
    n = generator.normal(size=3)
    n /= np.linalg.norm(n)
    r1, r2 = generator.uniform(0.5, 1.5, 2)
    grain((0, 0, 0), r1, velocity=generator.uniform(-1, 1, 3) + n, spin=generator.uniform(-1, 1, 3), material=one)
    grain((r1 + r2) * n, r2, velocity=generator.uniform(-1, 1, 3) - n, spin=generator.uniform(-1, 1, 3), material=two)
    equip(H, gravity=(0, 0, 0), tolerance=1e-12)


@pytest.mark.parametrize("friction", [0.0, 0.05, 0.2, 0.5, 1.0, 3.0])
def test_oblique_impact_of_two_balls(friction: float) -> None:
    """Closed form for solid balls with e = 0.

    With W_N = 1/m1 + 1/m2 and W_T = 7/2 W_N the normal impulse is P_N = -U_N/W_N; the tangential one is -U_T/W_T if
    that is inside of the cone, otherwise mu P_N against U_T. Impulses act at the point of contact: the spins change.
    """
    generator = np.random.default_rng(8)
    kinds = set()
    for _ in range(20):
        two_balls(friction, generator)
        v = [vec(state(k).vel) for k in (0, 1)]
        w = [vec(state(k).angVel) for k in (0, 1)]
        r = [O.bodies[k].shape.radius for k in (0, 1)]
        m = [ball_mass(r[0], 2000), ball_mass(r[1], 3500)]
        inertia = [ball_inertia(r[0], 2000), ball_inertia(r[1], 3500)]
        n = vec(state(1).pos) - vec(state(0).pos)
        n /= np.linalg.norm(n)
        u = v[1] - np.cross(w[1], r[1] * n) - v[0] - np.cross(w[0], r[0] * n)
        un, ut = u @ n, u - (u @ n) * n
        if un > 0:
            continue
        wn = 1 / m[0] + 1 / m[1]
        push, drag = -un / wn, -ut / (3.5 * wn)
        if np.linalg.norm(drag) > friction * push:
            drag *= friction * push / np.linalg.norm(drag)
            kinds.add("sliding")
        else:
            kinds.add("sticking")
        impulse = push * n + drag
        O.step()
        size = np.abs(np.concatenate([*v, *w])).max()
        found = contact(0, 1)
        sign = 1 if found.id2 == 1 else -1
        assert np.abs(sign * vec(found.phys.impulse) - impulse).max() <= CLOSED_FORM * max(m) * size
        for k, direction in ((0, -1), (1, 1)):
            velocity = v[k] + direction * impulse / m[k]
            spin = w[k] + direction * np.cross(-direction * r[k] * n, impulse) / inertia[k]
            assert np.abs(vec(state(k).vel) - velocity).max() <= CLOSED_FORM * size * max(m) / min(m)
            assert np.abs(vec(state(k).angVel) - spin).max() <= CLOSED_FORM * size * max(m) / min(m)
        status = "sliding" if np.linalg.norm(drag) >= friction * push * (1 - 1e-9) and friction * push > 0 else None
        if status:
            assert found.phys.status == status
    # Directions are random, so weak friction mostly leads to sliding and strong friction mostly to sticking.
    assert kinds and (friction > 0.3 or "sliding" in kinds) and (friction < 0.3 or "sticking" in kinds)


def dumbbell_over_floor(friction: float, tilt: float, velocity, spin) -> tuple[int, float, np.ndarray]:
    """A dumbbell whose lower end touches the floor; returns id, mass, inverse inertia in global axes (closed form)."""
    material(friction)
    floor()
    half = 1.5
    axis = np.array([math.cos(tilt), 0, math.sin(tilt)])
    centre = np.array([0, 0, 1 + half * math.sin(tilt)])
    number, _ = dumbbell([centre - half * axis, centre + half * axis])
    m = ball_mass(1)
    along, across = 2 * ball_inertia(1), 2 * (ball_inertia(1) + m * half**2)
    inertia = across * np.eye(3) + (along - across) * np.outer(axis, axis)
    s = state(number)
    s.vel, s.angVel = Vector3(*velocity), Vector3(*spin)
    s.angMom = Vector3(*(inertia @ np.array(spin)))
    return number, 2 * m, np.linalg.inv(inertia)


def test_inertia_of_the_dumbbell_is_that_of_yade() -> None:
    """The closed form above describes the body that YADE moves."""
    number, mass, inverse = dumbbell_over_floor(0, 0.4, (0, 0, 0), (0, 0, 0))
    r = rotation(number)
    assert state(number).mass == pytest.approx(mass, rel=1e-12)
    found = r @ np.diag(1 / vec(state(number).inertia)) @ r.T
    assert np.allclose(found, inverse, rtol=0, atol=1e-11 * np.abs(inverse).max())


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.3, 1.0, 5.0])
@pytest.mark.parametrize(
    "velocity, spin", [((0, 0, -2), (0, 0, 0)), ((1, 0.5, -2), (0.3, -0.5, 0.2)), ((-2, 1, -1), (0, -1, 3))]
)
def test_one_end_of_a_dumbbell_hits_the_floor(friction: float, velocity, spin) -> None:
    """A contact that couples normal and tangential directions, W full.

    The reaction is checked against the law itself, evaluated here: velocities after the impact from the impulse and the
    inertia in closed form, U_N = 0, impulse inside of the cone, and either U_T = 0 or sliding against the impulse.
    """
    number, mass, inverse = dumbbell_over_floor(friction, 0.6, velocity, spin)
    centre = vec(state(number).pos)
    arm = np.array([centre[0] - 1.5 * math.cos(0.6), 0, 0]) - centre
    equip(H, gravity=(0, 0, 0), tolerance=1e-12, maxIterations=10000)
    moment = vec(state(number).angMom)
    O.step()
    (found,) = active()
    impulse = vec(found.phys.impulse)
    v = np.array(velocity) + impulse / mass
    w = np.array(spin) + inverse @ np.cross(arm, impulse)
    u = v + np.cross(w, arm)
    size = np.linalg.norm(velocity) + 3 * np.linalg.norm(spin)
    # Inverse inertia from YADE's eigenvectors and lever arms carry roundings of some 1e-15 of their size.
    allowed = 1e-11 * size
    assert np.abs(vec(state(number).vel) - v).max() <= allowed
    assert np.abs(vec(state(number).angMom) - moment - np.cross(arm, impulse)).max() <= 1e-12 * mass * size * 3
    assert abs(u[2]) <= allowed
    drag = np.linalg.norm(impulse[:2])
    assert drag <= friction * impulse[2] * (1 + 1e-12) + 1e-12
    slip = np.linalg.norm(u[:2])
    if found.phys.status == "sticking":
        assert slip <= allowed
    else:
        assert drag == pytest.approx(friction * impulse[2], rel=1e-11, abs=1e-12)
        assert np.linalg.norm(impulse[:2] * slip + drag * u[:2]) <= 1e-10 * max(drag, 1) * size
    if friction == 0:
        across = np.cross(arm, [0, 0, 1])
        expected = -(np.array(velocity) + np.cross(spin, arm))[2] / (1 / mass + across @ inverse @ across)
        assert impulse[2] == pytest.approx(expected, rel=1e-11)
    if friction == 5.0:
        assert found.phys.status == "sticking"
        cross = np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
        delassus = np.eye(3) / mass - cross @ inverse @ cross
        expected = -np.linalg.solve(delassus, np.array(velocity) + np.cross(spin, arm))
        assert np.abs(impulse - expected).max() <= 1e-10 * np.abs(expected).max()


def test_dumbbell_lands_flat() -> None:
    """Both ends carry half of the momentum, then half of the weight; nothing turns."""
    number, mass, _ = dumbbell_over_floor(0.5, 0.0, (0, 0, -2), (0, 0, 0))
    equip(H, tolerance=1e-12, maxIterations=10000)
    O.step()
    assert [vec(i.phys.impulse)[2] for i in active()] == pytest.approx([mass * (2 + G * H) / 2] * 2, rel=1e-9)
    steps(20)
    assert [i.phys.normalForce.norm() for i in active()] == pytest.approx([mass * G / 2] * 2, rel=1e-9)
    assert vec(state(number).vel) == pytest.approx([0, 0, 0], abs=1e-10)
    assert vec(state(number).angVel) == pytest.approx([0, 0, 0], abs=1e-10)
