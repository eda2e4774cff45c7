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


def test_soft_packing_is_taken_over() -> None:
    """Mean overlap from 1e-2 r to below 1e-4 r in 1,000 steps; no grain exceeds 1 % of the speed that gravity gives over one diameter.

    The grains keep their forces and the contacts that carry one stay closed, so nothing falls, although the packing swells.
    """
    radius = 0.01
    _soft_packing(150, radius, young=2.6e5)
    assert _soft_overlap() == pytest.approx(1e-2 * radius, rel=0.2)
    assert takeOver(contactdynamics.engines(), dt=0.05 * math.sqrt(radius / G)) > 100
    speeds = []
    steps(1000, lambda: speeds.append(max(b.state.vel.norm() for b in O.bodies)))
    assert max(speeds) < 0.01 * math.sqrt(2 * G * 2 * radius)
    assert cd().meanPenetration < 1e-4 * radius and cd().remainingOverlap < 2e-5 * radius


def test_soft_packing_with_wedged_grains_is_let_down() -> None:
    """Little friction and many layers: some grains lose their hold as the packing swells. `settle` lets them down, with the same bound."""
    radius = 0.01
    _soft_packing(300, radius, young=6e5, friction=0.1)
    assert _soft_overlap() > 5e-3 * radius
    bound = 0.01 * math.sqrt(2 * G * 2 * 0.8 * radius)  # of the smallest grains
    watch = PyRunner(command="import builtins; builtins.speeds.append(max(b.state.vel.norm() for b in O.bodies))", iterPeriod=1)
    builtins.speeds = speeds = []
    dt = 0.05 * math.sqrt(radius / G)
    takeOver(contactdynamics.engines() + [watch], dt=dt, settle=1000)
    assert len(speeds) == 1000 and max(speeds) < bound and O.dt == dt
    assert cd().meanPenetration < 1e-4 * radius
    assert all(b.state.vel.norm() == 0 for b in O.bodies if b.dynamic)


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
    """10,000 steps: the mean overlap does not grow, nothing creeps."""
    material()
    floor()
    for x, y, z in ((0, 0, 1), (2, 0, 1), (1, math.sqrt(3), 1), (1, 1 / math.sqrt(3), 1 + math.sqrt(8 / 3))):
        grain((x, y, z - 1e-6))
    for n in range(1, 4):  # three fixed in the plane below, one on top in the hollow
        state(n).blockedDOFs = "xyXYZ"
    equip(1e-2)
    steps(2000)
    overlap, places = cd().meanPenetration, [vec(b.state.pos) for b in O.bodies]
    steps(10000)
    assert cd().meanPenetration <= max(overlap, 1e-5)
    for body, place in zip(O.bodies, places):
        assert vec(body.state.pos) == pytest.approx(place, abs=1e-6)
    assert utils.kineticEnergy() < 1e-12


@pytest.mark.parametrize("attribute, value", [("repairRate", -0.1), ("repairRate", 1.5), ("repairRate", math.nan), ("allowedOverlap", -1), ("allowedOverlap", math.inf)])
def test_bad_values_are_refused(attribute: str, value: float) -> None:
    equip(1e-3)
    with pytest.raises(ValueError, match=attribute):
        setattr(cd(), attribute, value)
    with pytest.raises(ValueError, match=attribute):
        contactdynamics.engines(**{attribute: value})
