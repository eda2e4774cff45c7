# SPDX-License-Identifier: GPL-2.0-or-later
"""Two-dimensional scenes: disks, recognition of the plane, the closed form (34) and the condition (33)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3, utils

from contactdynamics import plane
from scenes import G, box, cd, contacts, engine, equip, grain, law, material, rotation, state, steps, vec

AXES = {"xy": (0, 1, 2), "yz": (1, 2, 0), "zx": (2, 0, 1)}


def _add(body) -> int:
    return O.bodies.append(body)


@pytest.mark.parametrize("name", AXES)
def test_disk(name: str) -> None:
    rho, r, t = 2000.0, 0.3, 0.05
    body = plane.disk((1, 2), r, name, t, material=material(density=rho))
    first, second, normal = AXES[name]
    m = math.pi * r * r * t * rho
    assert vec(body.state.pos)[[first, second, normal]] == pytest.approx([1, 2, 0], abs=0)
    assert body.state.mass == pytest.approx(m, rel=1e-14)
    assert body.state.inertia[normal] == pytest.approx(m * r * r / 2, rel=1e-14)
    assert body.state.inertia[first] == pytest.approx(m * (r * r / 4 + t * t / 12), rel=1e-14)
    assert set(body.state.blockedDOFs) == set("xyz"[normal] + "XYZ"[first] + "XYZ"[second])


@pytest.mark.parametrize("bad", [dict(radius=0), dict(radius=math.nan), dict(thickness=-1), dict(plane="xz"), dict(center=(1,)), dict(center=(1, 2, 3, 4)), dict(center=5), dict(center="ab")])
def test_bad_arguments(bad: dict) -> None:
    material()
    with pytest.raises(ValueError):
        plane.disk(**{"center": (0, 0), "radius": 1.0, **bad})


def _disks(name: str, blocked: bool, number: int = 40) -> list[int]:
    """Disks of different size fall into a box open at the top; gravity along the second axis of the plane."""
    first, second, normal = AXES[name]
    generator = np.random.default_rng(3)
    stuff = material(friction=0.4)
    for sign in (-1, 1):
        O.bodies.append(utils.wall(5.0 * sign, axis=first, material=stuff))
    O.bodies.append(utils.wall(0.0, axis=second, material=stuff))
    ids = []
    for k in range(number):
        body = plane.disk((2.2 * (k % 4) - 3.4 + generator.uniform(-0.1, 0.1), 1.1 + 2.2 * (k // 4)), generator.uniform(0.7, 1), name, material=stuff)
        if not blocked:
            body.state.blockedDOFs = ""
        ids.append(_add(body))
    gravity = [0.0, 0.0, 0.0]
    gravity[second] = -G
    equip(5e-3, gravity=gravity, tolerance=1e-10, maxIterations=100000)
    return ids


def _in_plane(name: str, ids: list[int]) -> np.ndarray:
    first, second, normal = AXES[name]
    return np.array([[state(n).pos[first], state(n).pos[second], state(n).vel[first], state(n).vel[second], state(n).angVel[normal]] for n in ids])


def test_all_planes_are_alike() -> None:
    """The same numbers up to rounding, whatever the axes are called; and the plane is recognised."""
    results = []
    for name in AXES:
        O.reset()
        ids = _disks(name, blocked=True)
        steps(250)
        assert cd().plane == name and cd().activeContacts > 30 and cd().ambiguousContacts == 0
        results.append(_in_plane(name, ids))
    # Rounding differs by the order of sums over axes; a hundred steps of impacts may amplify it.
    assert results[1] == pytest.approx(results[0], abs=1e-6)
    assert results[2] == pytest.approx(results[0], abs=1e-6)


@pytest.mark.parametrize("name", AXES)
def test_same_as_in_three_dimensions(name: str) -> None:
    """Disks that could leave the plane do not, because nothing pushes them out, and arrive at the same velocities to the tolerance."""
    ids = _disks(name, blocked=False)
    steps(180)
    assert cd().plane == ""
    free = _in_plane(name, ids)
    O.reset()
    ids = _disks(name, blocked=True)
    steps(180)
    assert cd().plane == name and cd().activeContacts > 10
    # 180 solves with an error of 1e-10 of speeds of order 5 m/s, amplified by impacts.
    assert _in_plane(name, ids) == pytest.approx(free, abs=1e-6)


def test_plane_is_not_claimed_where_there_is_none() -> None:
    ids = _disks("xy", blocked=True, number=8)
    state(ids[1]).pos += Vector3(0, 0, 1e-3)
    steps(150)
    assert any(ids[1] in (c.id1, c.id2) and min(c.id1, c.id2) in ids for c in contacts())
    assert cd().plane == ""
    O.reset()
    ids = _disks("xy", blocked=True, number=4)
    state(ids[1]).vel = Vector3(0, 0, 1)
    steps(1)
    assert cd().plane == ""


def test_belt_that_turns_out_of_the_plane_twists_no_disk() -> None:
    """The disk cannot turn about the normal: a torque of twisting friction acts on it, but changes no velocity."""
    law(twistingFriction=0.1)
    belt = box((0, -1, 0), (5, 1, 5))
    O.bodies[belt].mask = 5
    state(belt).angVel = Vector3(0, 0.2, 0)
    disk = grain((0, 1, 0), mask=3)
    state(disk).blockedDOFs = "zXY"
    equip(1e-3, gravity=(0, -G, 0), tolerance=1e-10)
    engine("NewtonIntegrator").mask = 2
    steps(3)
    assert cd().plane == "" and cd().converged
    assert vec(cd().predictedVelocities()[disk][1]) == pytest.approx([0, 0, 0], abs=0)
    # All of the weight is on the contact; the disk is dragged along, against which it pushes the belt back.
    assert O.forces.t(disk)[1] == pytest.approx(0.1 * state(disk).mass * G, rel=1e-9)


def _rod(angle: float, mu: float) -> tuple[int, list[int], float]:
    """A thin rod of small spheres, leaning by `angle` from the floor, its lower end sliding on it. Returns clump, members, half length."""
    material(friction=mu)
    O.bodies.append(utils.wall(0.0, axis=1, material=O.materials[0]))
    radius, number = 0.01, 51
    length = 2 * radius * (number - 1)
    spheres = []
    for k in range(number):
        s = 2 * radius * k
        spheres.append(utils.sphere(Vector3(s * math.cos(angle), radius + s * math.sin(angle), 0), radius, material=O.materials[0]))
    clump, members = O.bodies.appendClumped(spheres)
    plane.restrict([O.bodies[clump]], "xy")
    return clump, members, length / 2


def _coupling(clump: int, member: int) -> tuple[float, float]:
    """W_NN and W_TN of the end that touches the floor, from mass, inertia and lever arm alone."""
    arm = vec(state(member).pos) + [0, -0.01, 0] - vec(state(clump).pos)
    m, inertia = state(clump).mass, state(clump).inertia[2]
    return 1 / m + arm[0] ** 2 / inertia, -arm[0] * arm[1] / inertia


@pytest.mark.parametrize("factor, ambiguous", [(0.98, 0), (1.02, 1)])
def test_painleve_rod_is_reported(factor: float, ambiguous: int) -> None:
    """The condition (33) fails above mu = W_NN / |W_TN|, for a slender rod at its worst angle mu > 4/3."""
    angle = math.radians(63)
    clump, members, _ = _rod(angle, 1.0)
    Wnn, Wtn = _coupling(clump, members[0])
    critical = Wnn / abs(Wtn)
    assert 1.3 < critical < 1.45
    O.reset()
    clump, members, _ = _rod(angle, factor * critical)
    plane.restrict([O.bodies[clump]], "xy")
    state(clump).vel = Vector3(1, 0, 0)
    equip(1e-5, gravity=(0, -G, 0))
    steps(1)
    assert cd().plane == "xy"
    lowest = min(contacts(), key=lambda c: c.phys.gap)
    assert cd().ambiguousContacts >= ambiguous and (ambiguous or cd().ambiguousContacts == 0)
    # Whatever solution is taken, it is one: the certificate holds, the reaction is inside the cone, and energy is not made.
    assert cd().converged and lowest.phys.normalForce[1] != 0


def test_one_contact_of_a_clump_is_the_closed_form() -> None:
    """The four cases of (34) against a rod that hits the floor with its end, W_TN != 0."""
    for speed in (Vector3(0, 0.3, 0), Vector3(0.02, -1, 0), Vector3(3, -1, 0), Vector3(-3, -1, 0)):
        O.reset()
        mu = 0.3
        clump, members, _ = _rod(math.radians(50), mu)
        state(clump).vel = speed
        equip(1e-5, gravity=(0, 0, 0), tolerance=1e-12)
        Wnn, Wtn = _coupling(clump, members[0])
        arm = vec(state(members[0]).pos) + [0, -0.01, 0] - vec(state(clump).pos)
        Wtt = 1 / state(clump).mass + arm[1] ** 2 / state(clump).inertia[2]
        bn, bt = speed[1], speed[0]
        steps(1)
        r = sum((vec(c.phys.impulse) for c in contacts()), np.zeros(3))
        if bn >= 0:
            expected = (0.0, 0.0)
        else:
            W = np.array([[Wnn, Wtn], [Wtn, Wtt]])
            stick = -np.linalg.solve(W, [bn, bt])
            forward, backward = -bn / (Wnn + mu * Wtn), -bn / (Wnn - mu * Wtn)
            J = bt - Wtn * bn / Wnn
            expected = stick if abs(stick[1]) <= mu * stick[0] else ((forward, mu * forward) if J < 0 else (backward, -mu * backward))
        assert (r[1], r[0]) == pytest.approx(tuple(expected), rel=1e-9, abs=1e-12)
