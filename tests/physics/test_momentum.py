# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact forces are internal: linear and angular momentum to round-off."""

from __future__ import annotations

import numpy as np
import pytest
from yade import O, Vector3

from scenes import (
    EPS,
    active,
    cd,
    contacts,
    dumbbell,
    equip,
    floor,
    grain,
    material,
    momentum,
    rotation,
    state,
    steps,
    vec,
)


def cloud(generator: np.random.Generator, clumps: int = 12) -> None:
    """Spheres of several sizes, blocks of two and three, and aspherical bodies fly towards the origin."""
    material(friction=0.5)
    for k in range(60):
        place = 2.3 * np.array([k % 4, k // 4 % 4, k // 16]) - 3.5
        velocity, spin = -0.8 * place + generator.uniform(-1, 1, 3), generator.uniform(-5, 5, 3)
        grain(place, generator.uniform(0.6, 1.1), velocity=velocity, spin=spin)
    for k in range(clumps):
        place = np.array([3.0 * (k % 4) - 4, 3.0 * (k // 4) - 4, 8.0])
        ends = [place, place + [1.3, 0.4, 0.2], place + [0.2, 1.2, 0.5]][: 2 + k % 2]
        number, _ = dumbbell(ends, radius=0.7)
        s = state(number)
        s.vel, s.angVel = Vector3(*(-0.8 * place)), Vector3(*generator.uniform(-3, 3, 3))
        r = rotation(number)
        s.angMom = Vector3(*(r @ np.diag(vec(s.inertia)) @ r.T @ vec(s.angVel)))


@pytest.mark.parametrize("repair", [0.0, 0.1])
def test_momentum_of_a_cloud_is_kept(repair: float) -> None:
    """Sum over 200 steps of collisions of about a hundred bodies without gravity or walls.

    Every impulse is given and taken once, with one rounding of its size on each side; so is every step of the motion. Penetration repair moves
    momentum to another place, which keeps the linear one but not the angular one about the origin.
    """
    cloud(np.random.default_rng(9))
    equip(5e-3, gravity=(0, 0, 0), tolerance=1e-3, onNonConvergence="ignore", repairRate=repair)
    linear, angular = momentum()
    work, number, touched, repaired = 0.0, 200, 0, 0.0
    for _ in range(number):
        O.step()
        repaired += cd().repairDisplacement
        work += sum(i.phys.impulse.norm() for i in contacts())
        touched += cd().activeContacts
    assert touched > 1000
    size = work + number * sum(b.state.mass * b.state.vel.norm() for b in O.bodies if not b.isClumpMember)
    after = momentum()
    radius = 20.0  # the cloud is smaller than this
    assert np.abs(after[0] - linear).max() <= 4 * EPS * size
    if repair == 0:
        assert np.abs(after[1] - angular).max() <= 4 * EPS * size * radius
    assert (repaired > 0) == (repair > 0)


def forces_and_torques(places: dict[int, np.ndarray]) -> tuple[np.ndarray, np.ndarray, float]:
    """Sum of O.forces over all bodies (members of clumps hand theirs to the clump), about the origin for bodies at `places`, and its size."""
    force, torque, size = np.zeros(3), np.zeros(3), 0.0
    for b in O.bodies:
        if b.isClumpMember:
            continue
        f = vec(O.forces.f(b.id))
        force += f
        torque += np.cross(places[b.id], f) + vec(O.forces.t(b.id))
        size += np.linalg.norm(f)
    return force, torque, size


def test_forces_of_a_step_sum_to_zero() -> None:
    """With gravity, a floor and clumps: gravity is not in O.forces, so the rest is contacts.

    Torques are taken with the positions at the start of the step, where the contacts were collected. The floor has its centre a metre below, its position
    times its force enters as well.
    """
    cloud(np.random.default_rng(10))
    for b in O.bodies:
        if b.isClumpMember or not b.isClump:
            b.state.pos = b.state.pos + Vector3(0, 0, 5)
        if b.isClump:
            b.state.pos = b.state.pos + Vector3(0, 0, 5)
    floor()
    equip(5e-3, tolerance=1e-4, onNonConvergence="ignore")
    worst = 0
    for _ in range(150):
        places = {b.id: vec(b.state.pos) for b in O.bodies}
        O.step()
        force, torque, size = forces_and_torques(places)
        arm = 10.0
        scale = size + sum(i.phys.impulse.norm() for i in contacts()) / O.dt
        assert np.abs(force).max() <= 50 * EPS * scale
        assert np.abs(torque).max() <= 50 * EPS * scale * arm
        worst = max(worst, len(active()))
    assert worst > 50


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_energy_of_a_cloud_never_rises(friction: float) -> None:
    """Without gravity and with e = 0 every solve takes kinetic energy away, or none.

    At the solution the work of the contact impulses is P . U - P . W P / 2 with P . U <= 0. Tolerance 1e-8 of the
    solver leaves an error of that order times the energy turned over.
    """
    cloud(np.random.default_rng(11), clumps=0)
    for b in O.bodies:
        b.material.frictionAngle = np.arctan(friction)
    equip(5e-3, gravity=(0, 0, 0), tolerance=1e-8, maxIterations=50000)

    def energy() -> float:
        states = [b.state for b in O.bodies]
        return 0.5 * sum(s.mass * s.vel.squaredNorm() + vec(s.inertia) @ vec(s.angVel) ** 2 for s in states)

    first = last = energy()
    for _ in range(150):
        steps(1)
        now = energy()
        assert now <= last + 1e-7 * first
        last = now
    assert last < 0.9 * first, "nothing collided"


def test_no_solve_adds_energy_to_clumps() -> None:
    """The same for a cloud with clumps: energy with contacts against energy without, in every step.

    Angular velocities are those at the orientation at the start of the step, as they enter the contact condition.
    """
    cloud(np.random.default_rng(14))
    equip(5e-3, gravity=(0, 0, 0), tolerance=1e-10, maxIterations=50000)
    bodies = [b for b in O.bodies if not b.isClumpMember]
    taken = 0.0
    for _ in range(100):
        turns = {b.id: rotation(b.id) for b in bodies}

        def energy(velocities) -> float:
            total = 0.0
            for b in bodies:
                v, w = vec(velocities[b.id][0]), turns[b.id].T @ vec(velocities[b.id][1])
                total += 0.5 * b.state.mass * v @ v + 0.5 * vec(b.state.inertia) @ w**2
            return total

        O.step()
        free, end = energy(cd().freeVelocities()), energy(cd().predictedVelocities())
        # Residual of 1e-10 times the energy turned over, with room for a condition number of ten.
        assert end <= free * (1 + 1e-9)
        taken += free - end
    assert taken > 0.05 * free
