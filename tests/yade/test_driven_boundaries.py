# SPDX-License-Identifier: GPL-2.0-or-later
"""Boundaries moved by YADE's kinematic engines, by hand or as a clump carry what lies on them with the velocity of their surface."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import (
    HarmonicMotionEngine,
    HelixEngine,
    InterpolatingHelixEngine,
    O,
    RotationEngine,
    ServoPIDController,
    TranslationEngine,
    Vector3,
)

from scenes import G, box, cd, contact, dumbbell, engine, equip, floor, grain, kinetic_energy, law, material, state, steps, vec
from test_detection import _target, facet

H = 1e-3
PLACES = {"before the collider": 1, "behind the loop": 3, "behind the integrator": 5, "first": 0}


def put(engine, place: str) -> None:
    """Insert an engine into the list of `equip`."""
    engines = list(O.engines)
    O.engines = engines[: PLACES[place]] + [engine] + engines[PLACES[place] :]


def plate(kind: str) -> list[int]:
    """A floor at z = 0 of 20 m, as one box, two facets, or a clump of these facets; returns what an engine has to move."""
    if kind == "box":
        return [box((0, 0, -1), (10, 10, 1))]
    a, b, c, d = (-10, -10, 0), (10, -10, 0), (10, 10, 0), (-10, 10, 0)
    ids = [facet((a, b, c)), facet((a, c, d))]
    if kind == "facets":
        return ids
    for number in ids:  # YADE cannot make a clump of bodies without mass
        state(number).mass, state(number).inertia = 1, Vector3(1, 1, 1)
    clump = O.bodies.clump(ids)
    state(clump).blockedDOFs = "xyzXYZ"
    return [clump]


KINDS = ["box", "facets", "clump"]


def rider(place=(3.0, 0.4, 1.0)) -> int:
    """A ball that slides or sticks but does not roll."""
    ball = grain(place)
    state(ball).blockedDOFs = "XYZ"
    return ball


def surface_velocity(moved: int, at: np.ndarray) -> np.ndarray:
    """Velocity of the surface of a driven body at a point, from the state that the integrator used in the last step."""
    s = state(moved)
    before = vec(s.pos) - H * vec(s.vel)
    return vec(s.vel) + np.cross(vec(s.angVel), at - before)


def turning(rate: float, axis_at: tuple):
    """Velocity of a boundary at the point (x, y) as the engine means it, without the error of the chord."""
    return lambda x, y: np.array([-rate * (y - axis_at[1]), rate * (x - axis_at[0]), 0])


CASES = {
    "translation": (lambda ids: TranslationEngine(ids=ids, translationAxis=(3, 0, 4), velocity=0.5), lambda x, y: np.array([0.3, 0, 0.4])),
    "rotation about its centre": (
        lambda ids: RotationEngine(ids=ids, rotationAxis=(0, 0, 2), angularVelocity=0.3, rotateAroundZero=True),
        turning(0.3, (0, 0)),
    ),
    "rotation off the centre": (
        lambda ids: RotationEngine(ids=ids, rotationAxis=(0, 0, 1), angularVelocity=0.3, rotateAroundZero=True, zeroPoint=(1, -2, 7)),
        turning(0.3, (1, -2)),
    ),
    "helix": (
        lambda ids: HelixEngine(ids=ids, rotationAxis=(0, 0, 1), angularVelocity=0.3, linearVelocity=0.7, zeroPoint=(1, -2, 0)),
        lambda x, y: turning(0.3, (1, -2))(x, y) + [0, 0, 0.7],
    ),
    "interpolated helix": (
        lambda ids: InterpolatingHelixEngine(
            ids=ids, rotationAxis=(0, 0, 1), times=[0, 100], angularVelocities=[0.3, 0.3], slope=2, zeroPoint=(1, -2, 0)
        ),
        lambda x, y: turning(0.3, (1, -2))(x, y) + [0, 0, 0.6],
    ),
    "two engines in one": (
        lambda ids: TranslationEngine(ids=ids, translationAxis=(1, 0, 0), velocity=0.5)
        + RotationEngine(ids=ids, rotationAxis=(0, 0, 1), angularVelocity=0.3, rotateAroundZero=True),
        lambda x, y: turning(0.3, (0, 0))(x, y) + [0.5, 0, 0],
    ),
}


@pytest.mark.parametrize("place", list(PLACES))
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("case", list(CASES))
def test_sticking_ball_follows(case: str, kind: str, place: str) -> None:
    """Friction without limit: the ball has the velocity of the surface under it from the first step in which the boundary moves.

    The engines turn a position about the axis and give the body the velocity of the chord, which differs from that of the arc by half a step's turn,
    w^2 R h / 2 with R the distance from the axis, and the contact is that of the start of the step, another w^2 R h.
    """
    make, meant = CASES[case]
    material(friction=1e3)
    moved = plate(kind)
    ball = rider()
    equip(H, tolerance=1e-12)
    put(make(moved), place)
    # An engine behind the integrator acts on the step after; starting with the second step all places are alike.
    steps(2)
    for _ in range(20):
        at = vec(state(ball).pos)
        O.step()
        expected = meant(at[0], at[1])
        assert np.abs(vec(state(ball).vel) - expected).max() <= 2 * 0.3**2 * 12 * H
        assert cd().maxPenetration <= 1e-9
    # and exactly that of the velocities in the scene, wherever the surface is one rigid body
    if kind != "facets" and place != "behind the integrator" and place != "first":
        exact = surface_velocity(moved[0], np.array([at[0], at[1], at[2] - 1]))
        assert vec(state(ball).vel) == pytest.approx(exact, abs=1e-10)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("case", list(CASES))
def test_sliding_ball_gets_friction_along_the_slip(case: str, kind: str) -> None:
    """One step from rest on a surface that slips away: mu (g h + rise of the surface) along the slip, by Coulomb's law."""
    make, meant = CASES[case]
    mu = 0.01
    material(friction=mu)
    moved = plate(kind)
    ball = rider()
    equip(H, tolerance=1e-12)
    put(make(moved), "before the collider")
    O.step()
    slip = meant(3.0, 0.4)
    speed = mu * (G * H + slip[2])
    along = slip[:2] / np.linalg.norm(slip[:2])
    # The chord turns the direction by half the turn of a step, 1.5e-4.
    assert vec(state(ball).vel)[:2] == pytest.approx(speed * along, abs=4e-4 * speed)
    assert state(ball).vel[2] == pytest.approx(slip[2], abs=1e-9)


def test_interpolated_speed_is_that_of_the_time() -> None:
    """The rate grows from 0 to 2 rad/s in one second; the ball on the axis of a screw is lifted by slope times the angle."""
    material(friction=0)
    moved = plate("facets")
    ball = rider(place=(0.2, -0.1, 1))
    equip(H, tolerance=1e-12)
    put(InterpolatingHelixEngine(ids=moved, rotationAxis=(0, 0, 1), times=[0, 1], angularVelocities=[0, 2], slope=0.5), "before the collider")
    for _ in range(50):
        time = O.time
        O.step()
        assert state(ball).vel[2] == pytest.approx(0.5 * 2 * time, abs=1e-10)


@pytest.mark.parametrize("kind", KINDS)
def test_servo_moves_the_ball_with_it(kind: str) -> None:
    """A plate under a controller that wants 90 % of the ball's weight w: the ball follows with the plate's velocity in every step.

    The velocity is k times the sum of the errors e = F - 0.9 w, so the acceleration is k e / h and F = w + m k e / h: with
    k = -0.05 g h / w the error tends to 0.1 w / 1.05, by a factor of 0.05 in every step.
    """
    material(friction=0.5)
    moved = plate(kind)
    ball = rider()
    weight = state(ball).mass * G
    equip(H, tolerance=1e-12)
    servo = ServoPIDController(ids=moved, axis=(0, 0, 1), maxVelocity=10, target=0.9 * weight, iterPeriod=1, kI=-0.05 * G * H / weight)
    put(servo, "behind the integrator")
    for _ in range(100):
        before = state(moved[0]).vel[2]  # that the plate has in the coming step
        O.step()
        assert state(ball).vel[2] == pytest.approx(before, abs=1e-10)
    assert vec(O.forces.f(ball))[2] == pytest.approx(weight * (0.9 + 0.1 / 1.05), rel=1e-9)
    assert cd().maxPenetration <= 1e-9


def test_harmonic_plate_throws_the_ball() -> None:
    """z = -A cos(w t): while w^2 A < g the ball stays on the plate, above it leaves."""
    for amplitude, stays in ((0.9, True), (1.4, False)):
        O.reset()
        material()
        moved = plate("box")
        ball = rider()
        rate = 10.0
        equip(H, tolerance=1e-12)
        a = amplitude * G / rate**2
        put(HarmonicMotionEngine(ids=moved, A=(0, 0, a), f=(0, 0, rate / (2 * math.pi)), fi=(0, 0, math.pi)), "before the collider")
        heights = []
        steps(700, lambda: heights.append(state(ball).pos[2] - state(moved[0]).pos[2] - 2))
        assert (max(heights) <= 1e-9) == stays
        assert min(heights) >= -1e-9


def test_seams_of_a_turntable_do_not_matter() -> None:
    """A turntable of 32 facets, each turning about its own centre, takes a rolling ball along as a single box does.

    The facets move along chords, the box turns on the spot: a difference of w^2 R h / 2 = 1e-4 m/s in the velocity of the surface.
    """
    tracks = {}
    for kind in ("box", "mesh"):
        O.reset()
        material(friction=0.3)
        if kind == "box":
            ids = [box((0, 0, -1), (8, 8, 1))]
        else:
            grid = [-8, -4, 0, 4, 8]
            ids = []
            for x, x2 in zip(grid, grid[1:]):
                for y, y2 in zip(grid, grid[1:]):
                    ids += [facet(((x, y, 0), (x2, y, 0), (x2, y2, 0))), facet(((x, y, 0), (x2, y2, 0), (x, y2, 0)))]
        ball = grain((2.0, 0.3, 1), velocity=(0.2, 1.0, 0))
        equip(H, tolerance=1e-12)
        put(RotationEngine(ids=ids, rotationAxis=(0, 0, 1), angularVelocity=0.3, rotateAroundZero=True), "before the collider")
        track = []
        steps(400, lambda: track.append([*state(ball).pos, *state(ball).vel, *state(ball).angVel]))
        tracks[kind] = np.array(track)
    assert np.abs(tracks["box"] - tracks["mesh"]).max() <= 3e-4
    assert np.abs(tracks["mesh"][:, 2] - 1).max() <= 1e-9


def test_turned_plate_of_facets_set_by_hand() -> None:
    """vel and angVel written by the script, on a clump of facets that stands askew: the surface at the contact moves by v + w x r."""
    material(friction=1e3)
    moved = plate("clump")[0]
    ball = rider()
    state(moved).vel, state(moved).angVel = Vector3(0.1, 0.2, 0.05), Vector3(0.02, -0.03, 0.2)
    equip(H, tolerance=1e-12)
    O.step()
    arm = np.array([3.0, 0.4, 0])
    assert vec(state(ball).vel) == pytest.approx(np.array([0.1, 0.2, 0.05]) + np.cross([0.02, -0.03, 0.2], arm), abs=1e-11)


@pytest.mark.parametrize("kind", ["box", "wall", "facet"])
def test_boundary_outside_the_mask_is_a_conveyor_belt(kind: str) -> None:
    """It stays where it is, and its velocity drags along the surface only: a ball that cannot turn gets to the velocity of the belt after v / (mu g)."""
    material(friction=0.5)
    belt = _target(kind)
    O.bodies[belt].mask = 5
    place = state(belt).pos
    state(belt).vel = Vector3(0.3, -0.4, 0.7)  # the last component is across the surface
    ball = grain((0.1, 0.1, 1), mask=3)
    state(ball).blockedDOFs = "XYZ"
    h = 1e-3
    equip(h, tolerance=1e-12)
    engine("NewtonIntegrator").mask = 2
    steps(1)
    assert vec(state(ball).vel) == pytest.approx(0.5 * G * h * np.array([0.6, -0.8, 0]), rel=1e-9, abs=1e-12)
    steps(int(0.5 / (0.5 * G * h)) + 2)
    assert vec(state(ball).vel) == pytest.approx([0.3, -0.4, 0], abs=1e-9)
    assert state(belt).pos == place


def test_turning_drum_outside_the_mask_drags() -> None:
    """A box outside the mask that turns about the vertical: its surface velocity under the ball is w x r."""
    material(friction=0.5)
    belt = floor()
    O.bodies[belt].mask = 5
    state(belt).angVel = Vector3(0, 0, 0.2)
    ball = grain((3, 0, 1), mask=3)
    state(ball).blockedDOFs = "XYZ"
    equip(1e-3, tolerance=1e-12)
    engine("NewtonIntegrator").mask = 2
    steps(200)
    expected = np.cross([0, 0, 0.2], vec(state(ball).pos))
    # On its circle the ball needs 0.12 m/s2 of the 4.9 that friction gives; it has the velocity of the place it stood on at the start of the step.
    assert vec(state(ball).vel)[:2] == pytest.approx(expected[:2], abs=0.2 * 0.6 * 1e-3 * 1.1)


@pytest.mark.parametrize("outside", [False, True])
def test_energy_of_what_a_boundary_drags(outside: bool) -> None:
    """The same ball on the same floor, which moves and turns or only has the velocity of that: kinetic energy and all terms balance."""
    law(frictionAngle=0.4, rollingFriction=0.05, twistingFriction=0.05)
    belt = floor(mask=5)
    state(belt).vel, state(belt).angVel = Vector3(0.5, 0.2, 0), Vector3(0, 0, 0.7)
    ball = grain((2, 0, 1), mask=3, spin=(0.3, 0, 0))
    equip(H, tolerance=1e-12)
    O.trackEnergy = True
    if outside:
        engine("NewtonIntegrator").mask = 2
    start = kinetic_energy()
    steps(100)
    assert abs(state(ball).angVel[2]) > 0.05 and O.energy["contactBoundary"] < -0.01 * state(ball).mass
    terms = sum(O.energy[name] for name in O.energy.keys() if name.startswith("contact"))
    assert kinetic_energy() + terms - start == pytest.approx(0, abs=1e-11 * state(ball).mass)


def test_clump_outside_the_mask_is_a_conveyor_belt() -> None:
    """YADE leaves the velocities of its members alone; that of the clump counts, at the place of the contact."""
    material(friction=0.5)
    number, members = dumbbell([(-3, 0, -1), (3, 0, -1)], mask=5)
    O.bodies[number].mask = 5
    state(number).blockedDOFs = "xyzXYZ"
    state(number).vel, state(number).angVel = Vector3(0, 0.5, 0), Vector3(0, 0, 0.1)
    ball = grain((3, 0, 1), mask=3)
    state(ball).blockedDOFs = "xXYZ"
    equip(H, tolerance=1e-12)
    engine("NewtonIntegrator").mask = 2
    steps(1)
    assert state(ball).vel[1] == pytest.approx(0.5 * G * H, rel=1e-9)
    steps(20)
    # At a contact that has come by what the ball went along with it, 0.8 * 20 H; its normal leans by half of that.
    assert state(ball).vel[1] < 0.8 and contact(members[1], ball).phys.impulse.norm() > 0
