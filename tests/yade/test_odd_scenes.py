# SPDX-License-Identifier: GPL-2.0-or-later
"""What scripts do in mid-run, and shapes in unusual places."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from yade import O, PyRunner, Quaternion, Vector3, utils

from blocks import block
from contactdynamics import ContactDynamicsEngine
from scenes import G, active, box, cd, contact, dumbbell, engine, equip, floor, grain, material, state, steps, vec
from test_detection import facet

H = 1e-3


def test_time_step_that_changes() -> None:
    """Stored impulses belong to the step they were found with; the weight is carried all the same."""
    material()
    floor()
    balls = [grain((0, 0, 1 + 2 * k)) for k in range(5)]
    equip(H, tolerance=1e-10, maxIterations=100000)
    for h in (1e-3, 4e-3, 5e-4, 2e-3):
        O.dt = h
        steps(3)
        assert vec(O.forces.f(0))[2] == pytest.approx(-5 * state(balls[0]).mass * G, rel=1e-7)


def test_bodies_added_in_mid_run() -> None:
    material()
    floor()
    grain((0, 0, 1))
    equip(H)
    steps(5)
    second = grain((0, 0, 3.0))
    steps(2)
    assert contact(1, second) is not None
    assert vec(O.forces.f(0))[2] == pytest.approx(-2 * state(1).mass * G, rel=1e-3)


def test_clump_released_in_mid_run() -> None:
    """A clump that is taken apart: its members fall and land by themselves."""
    material()
    floor()
    number, members = dumbbell([(0, 0, 1.5), (3, 0, 1.5), (0, 3, 1.5)])
    equip(H)
    steps(5)
    O.bodies.releaseFromClump(members[0], number)
    assert O.bodies[members[0]].isStandalone
    steps(600)
    for b in O.bodies:
        if not b.isClump and b.dynamic:
            assert abs(b.state.pos[2] - 1) < 1e-9


def test_members_of_one_clump_do_not_meet() -> None:
    """Overlapping members are no contacts."""
    material()
    dumbbell([(0, 0, 0), (1, 0, 0), (0.5, 0.5, 0)])
    equip(H)
    steps(3)
    assert cd().contacts == 0


def test_two_scenes_in_turn() -> None:
    """O.switchScene: each scene keeps its own impulses, names and results."""
    material()
    floor()
    grain((0, 0, 1))
    equip(H, tolerance=1e-10)
    steps(3)
    first = float(vec(O.forces.f(0))[2])
    O.switchScene()
    O.resetThisScene()
    material()
    floor()
    grain((0, 0, 1))
    grain((0, 0, 3))
    equip(H, tolerance=1e-10, maxIterations=10000)
    for _ in range(4):
        steps(2)
        assert vec(O.forces.f(0))[2] == pytest.approx(2 * first, rel=1e-8)
        O.switchScene()
        steps(2)
        assert vec(O.forces.f(0))[2] == pytest.approx(first, rel=1e-8)
        O.switchScene()


def test_substepping() -> None:
    """One engine at a time gives the same as whole steps."""
    results = []
    for sub in (False, True):
        O.reset()
        material()
        floor()
        grain((0, 0, 1.01), velocity=(1, 0, -3))
        equip(H)
        O.subStepping = sub
        pieces = len(O.engines) + 2 if sub else 1
        for _ in range(20 * pieces):
            O.step()
        O.subStepping = False
        results.append(tuple(state(1).pos) + tuple(state(1).vel) + tuple(state(1).angVel))
    assert results[0] == results[1]


def test_run_in_the_background() -> None:
    """O.run without waiting, with Python working meanwhile."""
    material()
    floor()
    grain((0, 0, 1.5))
    equip(H)
    O.run(600)
    while O.running:
        sum(range(1000))
    O.wait()
    assert O.iter == 600 and abs(state(1).pos[2] - 1) < 1e-9


@pytest.mark.parametrize("heights, step", [((1.0, 1.5), 1e-3), ((2.0, 5.0), 20.0)])
def test_deep_overlaps_are_told_once(heights: tuple[float, float], step: float, capfd) -> None:
    """Balls placed in each other; a time step in which the tolerance lets balls of 1 m sink in by 1e-4 g h^2 = 0.4 m."""
    material()
    O.bodies.append(utils.wall(0, axis=2, sense=1))
    for height in heights:
        grain((0, 0, height))
    equip(step)
    steps(5)
    told = [line for line in capfd.readouterr().err.splitlines() if "overlap by" in line]
    assert len(told) == 1 and re.search("bodies #[01] and #[12] ", told[0]) and f"O.dt = {step:g}" in told[0]


def test_what_cannot_part_is_no_deep_overlap(capfd) -> None:
    """A lid that slides between walls that it reaches into."""
    material()
    for side in (-1, 1):
        box((1.4 * side, 0, 0), (0.5, 2, 6))
    lid = O.bodies.append(utils.box((0, 0, 2), (1, 1, 0.1)))
    state(lid).blockedDOFs = "xyXYZ"
    equip(H)
    steps(5)
    assert contact(0, lid).geom.penetrationDepth == pytest.approx(0.1) and "overlap by" not in capfd.readouterr().err


def test_lever_arm_is_no_measure_of_an_overlap(capfd) -> None:
    """A wall whose position lies next to the corner of the cube that it presses."""
    material()
    floor()
    cube = block((0, 0, 0.5))
    plate = O.bodies.append(utils.wall((0.5 + 1e-8, 0.5, 1.0 - 1e-7), axis=2, sense=-1, material=O.materials[0]))
    O.bodies[plate].dynamic = True
    state(plate).mass, state(plate).blockedDOFs = 100, "xyXYZ"
    equip(H)
    steps(5)
    assert cd().maxPenetration > 5e-8 and contact(cube, plate) is not None
    assert "overlap by" not in capfd.readouterr().err


def test_engines_assigned_during_a_step() -> None:
    """A PyRunner replaces the list while it runs: YADE takes the new one at the next step."""
    material()
    floor()
    grain((0, 0, 1))
    command = "import test_odd_scenes as t; t.replace_engines()"
    equip(H, before=[PyRunner(command=command, iterPeriod=1, firstIterRun=2)])
    steps(6)
    assert not any(isinstance(e, PyRunner) for e in O.engines)
    assert cd().tolerance == 1e-7 and cd().activeContacts == 1


def replace_engines() -> None:
    equip(H, tolerance=1e-7)


def test_one_engine_object_in_two_lists() -> None:
    """An engine taken over into a new list works on."""
    material()
    floor()
    grain((0, 0, 1))
    equip(H)
    steps(2)
    kept = engine("ContactDynamicsEngine")
    equip(H)
    O.engines = [kept if isinstance(e, ContactDynamicsEngine) else e for e in O.engines]
    steps(2)
    assert cd().activeContacts == 1


def test_coincident_spheres_are_named() -> None:
    """Two spheres in one place have no normal: an error or a finite answer, never a NaN."""
    material()
    grain((0, 0, 0))
    grain((0, 0, 0))
    equip(H)
    try:
        steps(2)
    except RuntimeError as error:
        assert re.search(r"#?\b0\b", str(error)) and re.search(r"#?\b1\b", str(error)), str(error)
    for number in (0, 1):
        assert np.isfinite(vec(state(number).pos)).all() and np.isfinite(vec(state(number).vel)).all()


@pytest.mark.parametrize("kind", ["box", "wall", "facet"])
def test_centre_on_the_surface_never_gives_a_nan(kind: str) -> None:
    """The direction from the surface to the centre does not exist there: an error or a finite answer."""
    material()
    if kind == "box":
        floor()
    elif kind == "wall":
        O.bodies.append(utils.wall(0, 2, material=O.materials[0]))
    else:
        facet([(-5, -4, 0), (5, -4, 0), (0, 6, 0)])
    ball = grain((0.1, 0.1, 0))
    equip(H)
    try:
        steps(3)
    except RuntimeError as error:
        assert re.search(rf"\b{ball}\b", str(error)), str(error)
    assert np.isfinite(vec(state(ball).pos)).all() and np.isfinite(vec(state(ball).vel)).all()


def test_ball_inside_of_a_box_is_not_pulled_deeper() -> None:
    """Deep overlap: the reaction is finite and the ball does not sink further."""
    material()
    floor()
    ball = grain((0, 0, -0.3))
    equip(H)
    steps(20)
    assert state(ball).pos[2] >= -0.3 - 1e-9 and state(ball).vel.norm() < 1e-6


@pytest.mark.parametrize("law, lifted", [("quasiInelasticShock", False), ("signorini", True)])
def test_free_box_on_a_fixed_ball(law: str, lifted: bool) -> None:
    """The box is the free body, on one contact below its centre; `signorini` removes the overlap within the step, the other law leaves it to the repair, off here."""
    material()
    ball = grain((0, 0, 0), fixed=True)
    number = O.bodies.append(utils.box(Vector3(0, 0, 1.999), (1, 1, 1), material=O.materials[0]))
    equip(H, contactLaw=law, tolerance=1e-10, repairRate=0)
    O.step()
    i = contact(ball, number)
    speed = 1e-3 / H if lifted else 0
    assert i.phys.impulse.norm() == pytest.approx(state(number).mass * (speed + G * H), rel=1e-8)
    assert state(number).pos[2] == pytest.approx(2 if lifted else 1.999, abs=1e-10)


def test_wall_that_moves() -> None:
    """A wall driven upwards carries the ball at its speed."""
    material()
    wall = O.bodies.append(utils.wall(0, 2, material=O.materials[0]))
    ball = grain((0, 0, 1))
    equip(H)
    state(wall).vel = Vector3(0, 0, 0.7)
    steps(50)
    assert state(ball).vel[2] == pytest.approx(0.7, rel=1e-10)
    assert state(ball).pos[2] - state(wall).pos[2] == pytest.approx(1, abs=1e-10)


@pytest.mark.parametrize("free_to_turn", [False, True])
@pytest.mark.parametrize("friction", [0.5, 1000.0])
def test_turntable_takes_a_ball_along(friction: float, free_to_turn: bool) -> None:
    """A fixed body with an angular velocity: the speed of its surface, 1.5 m/s here, enters the contact condition.

    One step under weight: friction gives the ball mu g h, or what makes it stick: all of 1.5 m/s, 2/7 if it can turn.
    """
    material(friction)
    plate = floor(5)
    ball = grain((3, 0, 1))
    state(ball).blockedDOFs = "" if free_to_turn else "XYZ"
    state(plate).angVel = Vector3(0, 0, 0.5)
    equip(H, tolerance=1e-12)
    O.step()
    stuck = 1.5 * (2 / 7 if free_to_turn else 1)
    assert vec(state(ball).vel) == pytest.approx([0, min(stuck, friction * G * H), 0], abs=1e-11)
    assert cd().converged


def test_plate_that_tilts_lifts_a_ball() -> None:
    """The same for the normal direction: the surface under the ball rises at 0.6 m/s."""
    material(friction=0)
    plate = floor(5)
    ball = grain((3, 0, 1))
    state(plate).angVel = Vector3(0, -0.2, 0)
    equip(H, tolerance=1e-12)
    O.step()
    assert state(ball).vel[2] == pytest.approx(0.6, rel=1e-10)
    assert cd().converged


def test_fixed_sphere_that_spins_drives_its_neighbour() -> None:
    """Friction from a spinning sphere: the surface speed at the contact is omega r, and the ball gets mu g h of it."""
    material(friction=0.3)
    base = grain((0, 0, 0), fixed=True)
    ball = grain((0, 0, 2))
    state(base).angVel = Vector3(0, 4, 0)
    equip(H, tolerance=1e-12)
    O.step()
    assert vec(state(ball).vel) == pytest.approx([0.3 * G * H, 0, 0], abs=1e-12)


def test_groups_that_do_not_meet() -> None:
    """YADE's masks decide who meets whom."""
    material()
    floor(mask=1)
    one, two = grain((0, 0, 1.0), mask=1), grain((5, 0, 1.0), mask=2)
    equip(H)
    steps(10)
    assert abs(state(one).pos[2] - 1) < 1e-10 and state(two).pos[2] < 1 - 1e-4
    assert len(active()) == 1


def test_turned_floor_is_the_same_physics() -> None:
    """Rotating the whole scene rotates the result: bodies, gravity, velocities."""
    turn = Quaternion(Vector3(1, -2, 0.5).normalized(), 1.1)
    results = []
    for q in (Quaternion(1, 0, 0, 0), turn):
        O.reset()
        material(friction=0.3)
        facet([vec(q * Vector3(*c)) for c in ((-50, -40, 0), (50, -40, 0), (0, 60, 0))])
        for k in range(3):
            place, velocity = q * Vector3(0.3 * k, 0, 1.2 + 2.1 * k), q * Vector3(1, 0.5 * k, -1)
            grain(vec(place), velocity=vec(velocity))
        equip(5e-3, gravity=vec(q * Vector3(0, 0, -G)), tolerance=1e-12, maxIterations=100000)
        steps(60)
        results.append([vec(q.inverse() * state(n).pos) for n in (1, 2, 3)])
    # Roundings grow in a chaotic motion; over 60 steps of a pile of three by a factor far below 1e4.
    assert np.abs(np.array(results[0]) - np.array(results[1])).max() <= 1e-8


def test_energy_tracking_of_yade_works_along() -> None:
    """O.trackEnergy: what gravity gives and friction takes is seen by the integrator as in any YADE run."""
    material()
    floor()
    ball = grain((0, 0, 3))
    O.trackEnergy = True
    equip(H)
    steps(300)
    v = state(ball).vel[2]
    assert dict(O.energy.items())["kinetic"] == pytest.approx(0.5 * state(ball).mass * (v + G * H) ** 2, rel=1e-9)
    O.trackEnergy = False


def test_stress_and_fabric_of_yade_read_the_contacts() -> None:
    """utils.getStress and friends find normal and shear forces: a column gives the weight over the area."""
    material()
    floor()
    for k in range(3):
        grain((0, 0, 1 + 2 * k))
    equip(H, tolerance=1e-12, maxIterations=100000)
    steps(3)
    weight = state(1).mass * G
    # Between balls the branch is 2 r long, with the floor from the centre of the floor at -1 to the ball at 1.
    expected = -(2 * 3 + 2 * 2 + 2 * 1) * weight
    assert utils.getStress(1.0)[2, 2] == pytest.approx(expected, rel=1e-8)
    assert utils.unbalancedForce() < 1e-6
    assert utils.fabricTensor()[0][2, 2] == pytest.approx(1, rel=1e-12)
    assert math.isfinite(utils.kineticEnergy())


@pytest.mark.parametrize("height", [0, 1e-13, 1e-10, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3])
def test_balls_in_guides_side_by_side_do_not_wedge(height: float) -> None:
    """Their common normal has a component of height / 2 along the guides: of 1e-5 and less nothing comes, with more of it the gap opens and closes."""
    material()
    floor()
    balls = [grain((0, 0, 1)), grain((2, 0, 1 + height))]
    for ball in balls:
        state(ball).blockedDOFs = "xyXYZ"
    equip(1e-2, tolerance=1e-10, onNonConvergence="raise")
    steps(20)
    weight = state(balls[0]).mass * G
    for ball in balls:
        assert abs(state(ball).vel[2]) < 1e-10 and state(ball).pos[2] == pytest.approx(1, abs=1e-9)
        assert contact(0, ball).phys.normalForce[2] == pytest.approx(weight, rel=1e-9)
