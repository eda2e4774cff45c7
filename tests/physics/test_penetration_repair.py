# SPDX-License-Identifier: GPL-2.0-or-later
"""Overlaps are removed by displacement: velocities stay, closed contacts stay closed, and nothing happens where nothing overlaps."""

from __future__ import annotations

import builtins
import math

import numpy as np
import pytest
from yade import (
    FrictMat,
    ForceResetter,
    InsertionSortCollider,
    InteractionLoop,
    NewtonIntegrator,
    O,
    PyRunner,
    Vector3,
    pack,
    utils,
    wrapper,
)

import contactdynamics
from contactdynamics.takeover import takeOver
from scenes import EPS, G, box, cd, dumbbell, equip, floor, grain, material, overlaps, state, steps, vec

NO_GRAVITY = (0, 0, 0)


def test_two_overlapping_balls_part_without_velocity() -> None:
    material()
    light, heavy = grain((0, 0, 0)), grain((1.95, 0, 0), material=material(density=3 * 2600.0))
    equip(1e-3, gravity=NO_GRAVITY)
    m1, m2 = state(light).mass, state(heavy).mass
    centre = (m1 * vec(state(light).pos) + m2 * vec(state(heavy).pos)) / (m1 + m2)

    def at_rest() -> None:
        for n in (light, heavy):
            assert vec(state(n).vel).any() == vec(state(n).angVel).any() == False  # noqa: E712 - exactly

    # 0.05 r at 1e-4 r a step, then a tenth of the rest a step: 500 + ln(1e-3 / 5e-6) / 0.1 steps.
    steps(600, at_rest)
    # Below the allowed overlap, near half of it, and there it stays.
    assert 4e-6 < overlaps().max() <= 1e-5 and cd().remainingOverlap <= 1e-5 and cd().repairDisplacement == 0
    after = (m1 * vec(state(light).pos) + m2 * vec(state(heavy).pos)) / (m1 + m2)
    # Two bodies with opposite pseudo-impulses: rounding of 600 displacements, each relative to positions of order 1.
    assert after == pytest.approx(centre, abs=600 * 4 * EPS)


def test_off_on_request() -> None:
    material()
    one, two = grain((0, 0, 0)), grain((1.95, 0, 0))
    equip(1e-3, gravity=NO_GRAVITY, repairRate=0)
    steps(10)
    assert vec(state(two).pos - state(one).pos) == pytest.approx([1.95, 0, 0], abs=0)
    assert cd().remainingOverlap == pytest.approx(0.05, abs=4 * EPS) and cd().repairDisplacement == 0


def _heap(rate: float) -> list:
    O.reset()
    material()
    floor()
    for k in range(4):
        grain((0.3 * k, 0.1 * k, 1.2 + 2.3 * k), velocity=(0.1, 0, -1))
    equip(1e-2, repairRate=rate, allowedOverlap=1e-3, tolerance=1e-8, maxIterations=10000)
    largest = []
    steps(150, lambda: largest.append(cd().repairDisplacement))
    assert max(largest) == 0, "the scene of this test is meant to have no overlaps beyond the allowed one"
    return [tuple(x) for n in range(len(O.bodies)) for x in (state(n).pos, state(n).vel, state(n).angVel)]


def test_same_bits_where_nothing_overlaps() -> None:
    assert _heap(0) == _heap(0.1)


def test_blocked_translation_and_clump_members() -> None:
    """The clump goes up as a whole, in z only; its members keep their places, and no velocity appears."""
    material()
    floor()
    clump, members = dumbbell([(0, 0, 0.97), (1.5, 0, 0.99)])
    state(clump).blockedDOFs = "xyXYZ"
    relative = [vec(state(m).pos - state(clump).pos) for m in members]
    start = vec(state(clump).pos)
    equip(1e-3, gravity=NO_GRAVITY)
    steps(400)
    moved = vec(state(clump).pos) - start
    assert moved[:2] == pytest.approx([0, 0], abs=0)
    assert moved[2] == pytest.approx(0.03, abs=1e-5)
    for m, before in zip(members, relative):
        assert vec(state(m).pos - state(clump).pos) == pytest.approx(before, abs=8 * EPS)
    assert state(clump).vel == Vector3(0, 0, 0) and state(clump).angVel == Vector3(0, 0, 0)


def test_across_the_boundary_of_a_periodic_cell() -> None:
    material()
    O.periodic = True
    O.cell.setBox(10, 10, 10)
    one, two = grain((0.5, 5, 5)), grain((8.55, 5, 5))
    equip(1e-3, gravity=NO_GRAVITY)
    steps(700)
    distance = 10 - (state(two).pos[0] - state(one).pos[0])
    assert 2 - 1e-5 <= distance <= 2
    assert state(one).vel == Vector3(0, 0, 0)


def test_accelerated_cell_does_not_turn_displacement_into_velocity() -> None:
    """The integrator adds the change of velGrad times the position; a displacement in that very step must not show in the velocity."""
    material()
    O.periodic = True
    O.cell.setBox(10, 10, 10)
    grain((4, 5, 5)), grain((5.8, 5, 5))
    equip(1e-3, gravity=NO_GRAVITY)
    for k in range(20):
        O.cell.velGrad = utils.Matrix3(-0.5 * (k % 2 + 1), 0.1 * k, 0, 0, 0, 0, 0, 0, 0)
        O.step()
        assert cd().repairDisplacement > 0
        for body, predicted in zip(O.bodies, cd().predictedVelocities()):
            assert vec(body.state.vel) == pytest.approx(vec(predicted[0]), abs=1e-12 * (1 + vec(predicted[0]).max()))


def _soft_packing(number: int, radius: float, young: float, friction: float = 0.5) -> None:
    """Grains of YADE's soft law at rest in an open box, with overlaps of about a hundredth of a radius."""
    width = 0.12
    number_of_material = O.materials.append(FrictMat(young=young, poisson=0.3, frictionAngle=math.atan(friction), density=2600))
    soft = O.materials[number_of_material]
    for axis, place in ((0, 0), (0, width), (1, 0), (1, width), (2, 0)):
        O.bodies.append(utils.wall(place, axis=axis, material=soft))
    cloud = pack.SpherePack()
    cloud.makeCloud((0, 0, 0), (width, width, 0.004 * number), rMean=radius, rRelFuzz=0.2, num=number, seed=1)
    cloud.toSimulation(material=soft)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([wrapper.Bo1_Sphere_Aabb(), wrapper.Bo1_Wall_Aabb()]),
        InteractionLoop(
            [wrapper.Ig2_Sphere_Sphere_ScGeom(), wrapper.Ig2_Wall_Sphere_ScGeom()],
            [wrapper.Ip2_FrictMat_FrictMat_FrictPhys()],
            [wrapper.Law2_ScGeom_FrictPhys_CundallStrack()],
        ),
        NewtonIntegrator(damping=0.4, gravity=(0, 0, -G)),
    ]
    O.dt = 5e-4
    O.run(6000, True)


def _soft_overlap() -> float:
    return float(np.mean([i.geom.penetrationDepth for i in O.interactions if i.isReal]))


@pytest.mark.parametrize("number, young, friction", [(150, 2.6e5, 0.5), (300, 4.8e5, 0.1), (400, 4.8e5, 0.5)])
def test_soft_packing_is_taken_over(number: int, young: float, friction: float) -> None:
    """Mean overlap from 1e-2 r to below 1e-4 r; no grain exceeds 1 % of the speed that gravity gives over one diameter, in 1,000 steps.

    Grains that lose their hold as the packing swells (in all but the smallest one) have been let down before the first step of time.
    """
    radius = 0.01
    _soft_packing(number, radius, young, friction)
    assert _soft_overlap() == pytest.approx(1e-2 * radius, rel=0.2)
    watch = PyRunner(command="import builtins; builtins.seen.append(O.iter)", iterPeriod=1)
    builtins.seen = seen = []
    dt = 0.05 * math.sqrt(radius / G)
    assert takeOver(contactdynamics.engines() + [watch], dt=dt) > number / 2
    assert O.dt == dt and len(O.engines) == 6 and not seen, "engines that run now and then have waited"
    assert cd().meanPenetration < 1e-4 * radius and all(b.state.vel.norm() == 0 for b in O.bodies)
    speeds = []
    steps(1000, lambda: speeds.append(max(b.state.vel.norm() for b in O.bodies)))
    assert max(speeds) < 0.01 * math.sqrt(2 * G * 2 * 0.8 * radius), "of the smallest grains"
    assert cd().meanPenetration < 1e-4 * radius and cd().remainingOverlap < 2e-5 * radius
    assert len(seen) == 1000


def test_repair_in_steps_too_short_for_a_fall() -> None:
    """Mean overlap from 1e-2 r to below 1e-4 r in well under 1,000 steps of 0.015 sqrt(r/g) from rest, in which no body passes 0.75 % of the speed of a fall."""
    radius, most, short = 0.01, 450, 350
    _soft_packing(150, radius, young=2.6e5)
    assert _soft_overlap() > 8e-3 * radius
    iteration, time = O.iter, O.time
    takeOver(contactdynamics.engines(), dt=0.05 * math.sqrt(radius / G), settle=most)
    assert O.iter - iteration <= most and cd().meanPenetration < 1e-4 * radius
    smallest = min(b.shape.radius for b in O.bodies if b.dynamic)
    assert O.time - time <= (0.015 * short + 0.05 * (most - short)) * math.sqrt(smallest / G), "the rest of the steps lets grains down"


@pytest.mark.parametrize(
    "speed, gravity, rate, height", [(0.2, G, 0.1, -1), (0.0, 0.0, 0.1, -1), (0.0, G, 0.0, -1), (0.0, G, 0.1, 2), (0.0, G, 0.1, -1)]
)
def test_what_is_not_settled(speed: float, gravity: float, rate: float, height: float) -> None:
    """A scene in motion, one without gravity, with repair switched off, or with a ball in the air: nothing moves before the first step of time.

    At a height of -1 the ball lies on the soft floor, with the overlap that bears its weight; the last case is that of a ball at rest, which is settled.
    """
    stiff = O.materials[O.materials.append(FrictMat(young=1e7, poisson=0.3, frictionAngle=0, density=2600))]
    below = grain((0, 0, -1), material=stiff, fixed=True)
    sag = 2600 * 4 / 3 * math.pi * G / 1e7  # YADE's stiffness of two balls of radius 1 is young times 1 m
    ball = grain((0, 0, 1 - sag if height < 0 else height), velocity=(speed, 0, 0), material=stiff)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([wrapper.Bo1_Sphere_Aabb()]),
        InteractionLoop(
            [wrapper.Ig2_Sphere_Sphere_ScGeom()], [wrapper.Ip2_FrictMat_FrictMat_FrictPhys()], [wrapper.Law2_ScGeom_FrictPhys_CundallStrack()]
        ),
        NewtonIntegrator(damping=0, gravity=(0, 0, -G)),
    ]
    O.dt = 1e-5
    steps(2)
    before = vec(state(ball).pos), vec(state(ball).vel)
    takeOver(contactdynamics.engines(gravity=(0, 0, -gravity), repairRate=rate), dt=1e-3)
    at_rest = speed == 0 and gravity > 0 and rate > 0 and height < 0
    assert (O.iter > 2) == at_rest
    if at_rest:
        assert (state(ball).pos - state(below).pos).norm() == pytest.approx(2, abs=1e-4)
    else:
        assert np.array_equal(before, (vec(state(ball).pos), vec(state(ball).vel)))


@pytest.mark.parametrize("given", [dict(dt=0), dict(dt=math.nan), dict(dt=1e-3, settle=-1)])
def test_bad_arguments_of_take_over(given: dict) -> None:
    grain((0, 0, 0))
    equip(1e-3)
    before = O.engines
    with pytest.raises(ValueError, match="settle" if "settle" in given else "dt"):
        takeOver(contactdynamics.engines(), **given)
    assert [type(e) for e in O.engines] == [type(e) for e in before], "a refused call changes nothing"


def test_packing_with_overlaps_starts_without_an_explosion() -> None:
    """A block of columns with overlaps of 1 % everywhere, no forces to start from: the kinetic energy stays far below what gravity allows.

    Five layers swell by five overlaps at most, that times the weight is the bound. In the velocities, the overlaps would be worth
    (0.01 r / h)^2 m / 2 a contact, four times as much.
    """
    radius, overlap, layers = 1.0, 0.01, 5
    material()
    floor()
    for k in range(16 * layers):
        x, y, z = k % 4, k // 4 % 4, k // 16
        grain(((2 - overlap) * x, (2 - overlap) * y, (1 - overlap) + (2 - overlap) * z), radius)
    equip(0.05 * math.sqrt(radius / G))
    energies = []
    steps(180, lambda: energies.append(utils.kineticEnergy()))
    # 1e-4 r a step down to 1e-3, then a tenth a step: 90 + ln(1e-3 / 1e-5) / 0.1 steps.
    assert cd().remainingOverlap < 1e-4 * radius
    assert max(energies) < 1e-3 * 16 * layers * state(1).mass * G * layers * overlap * radius


def test_packing_at_rest_stays() -> None:
    """10,000 steps: the overlaps do not grow, nothing creeps.

    A step makes one sweep at least, so what the tolerance of the first steps left is down at round-off after 2,000. Then the contacts, which stick inside
    their cones, keep speeds of the round-off of what is added up in them, g h: a hundred roundings of it for a body on several of them. A position takes
    that times h in each step, and its own rounding, of coordinates up to 4.
    """
    h, settling, number = 1e-2, 2000, 10000
    material()
    floor()
    side = 2.01  # the three below do not touch each other
    for x, y, z in ((0, 0, 1), (side, 0, 1), (side / 2, side * math.sqrt(0.75), 1), (side / 2, side / math.sqrt(12), 1 + math.sqrt(4 - side**2 / 3))):
        grain((x, y, z - 1e-6))
    for n in range(1, 4):  # three fixed in the plane below, one on top in the hollow
        state(n).blockedDOFs = "xyXYZ"
    equip(h)
    steps(settling)
    before, places = np.sort(overlaps()), [vec(b.state.pos) for b in O.bodies]
    energies = []
    steps(number, lambda: energies.append(utils.kineticEnergy()))
    speed = 100 * EPS * G * h
    drift = number * (h * speed + 2 * EPS)
    assert cd().meanPenetration <= 1e-5, "of what repair leaves alone"
    assert np.sort(overlaps()) == pytest.approx(before, abs=2 * drift)
    for body, place in zip(O.bodies, places):
        assert vec(body.state.pos) == pytest.approx(place, abs=drift)
    assert max(energies) <= 0.5 * 4 * state(1).mass * speed**2


@pytest.mark.parametrize("attribute, value", [("repairRate", -0.1), ("repairRate", 1.5), ("repairRate", math.nan), ("allowedOverlap", -1), ("allowedOverlap", math.inf)])
def test_bad_values_are_refused(attribute: str, value: float) -> None:
    equip(1e-3)
    with pytest.raises(ValueError, match=attribute):
        setattr(cd(), attribute, value)
    with pytest.raises(ValueError, match=attribute):
        contactdynamics.engines(**{attribute: value})


def test_wall_of_bricks_is_not_torn_apart() -> None:
    """After a ball has hit it the repair makes no overlap of faces deeper: what is left is what it leaves alone between blocks, 1e-3 sizes.

    (What would deepen one was not held back once; then overlaps of 1e-4 and more came back for ever.)
    """
    half = (0.1, 0.05, 0.05)
    material(0.6, density=2000)
    floor(5)
    for k in range(10):
        for i in range(3):
            place = (2 * half[0] * i + half[0] * (k % 2), 0, half[2] * (2 * k + 1))
            O.bodies.append(utils.box(place, half, material=O.materials[0]))
    grain((0.5, -0.3, 0.3), 0.08, velocity=(0, 6, 0))
    equip(5e-4, onNonConvergence="ignore")
    deepest: list[float] = []
    steps(1500, lambda: deepest.append(cd().remainingOverlap))
    assert max(deepest) > 1e-3 * min(half)  # there was something to repair
    assert max(deepest[700:]) < 1e-3 * min(half)
