# SPDX-License-Identifier: GPL-2.0-or-later
"""The velocity that the engine expects is the one that NewtonIntegrator then computes, branch by branch."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from yade import ForceEngine, GlobalStiffnessTimeStepper, O, Quaternion, TorqueEngine, Vector3

from prediction import free_equals_predicted, integrated, step_and_compare
from scenes import box, cd, dumbbell, engine, equip, floor, grain, material, rotation, state, steps, vec

GRAVITY = (0.3, -0.7, -9.81)
H = 1e-3
DOFS = ["".join(name for name, on in zip("xyzXYZ", choice) if on) for choice in product((0, 1), repeat=6)]


def random_vector(generator: np.random.Generator, size: float = 1.0) -> Vector3:
    return Vector3(*(size * generator.uniform(-1, 1, 3)))


def random_orientation(generator: np.random.Generator) -> Quaternion:
    q = generator.normal(size=4)
    q /= np.linalg.norm(q)
    return Quaternion(*q)


def set_in_motion(number: int, generator: np.random.Generator) -> None:
    """Random velocities, an angular momentum that fits, permanent force and torque."""
    s = state(number)
    s.vel, s.angVel = random_vector(generator), random_vector(generator, 3)
    r = rotation(number)
    s.angMom = Vector3(*(r @ np.diag(vec(s.inertia)) @ r.T @ vec(s.angVel)))
    O.forces.setPermF(number, random_vector(generator, 20 * s.mass))
    O.forces.setPermT(number, random_vector(generator, 20 * min(vec(s.inertia))))


def lattice(n: int) -> list[tuple[float, float, float]]:
    """Positions too far apart to touch."""
    return [(5.0 * (k % 8), 5.0 * (k // 8 % 8), 5.0 * (k // 64)) for k in range(n)]


def loads(ids: list[int]) -> list:
    """Engines that add a force and a torque in every step, beside the permanent ones."""
    return [ForceEngine(ids=ids, force=(900, -400, 300)), TorqueEngine(ids=ids, moment=(200, 500, -300))]


@pytest.mark.parametrize("exact_rotation", [True, False])
def test_every_combination_of_blocked_degrees_of_freedom(exact_rotation: bool) -> None:
    """64 combinations, each with the flag `aspherical` on and off, with equal and with different moments of inertia."""
    generator = np.random.default_rng(1)
    material()
    kinds = list(product(DOFS, (False, True), (False, True)))
    for place, (dofs, aspherical, different) in zip(lattice(len(kinds)), kinds):
        number = grain(place, radius=0.5)
        s, body = state(number), O.bodies[number]
        if different:
            s.inertia = Vector3(*(vec(s.inertia) * generator.uniform(0.5, 2, 3)))
        s.ori = random_orientation(generator)
        body.aspherical = aspherical
        s.blockedDOFs = dofs
        set_in_motion(number, generator)
    equip(H, GRAVITY, loads([b.id for b in O.bodies]))
    engine("NewtonIntegrator").exactAsphericalRot = exact_rotation
    for _ in range(3):
        step_and_compare(forces=60)
        free_equals_predicted()


@pytest.mark.parametrize("dofs", ["", "x", "xy", "zXY", "XYZ", "xyz", "xyzXYZ"])
@pytest.mark.parametrize("shape", ["octahedron", "octahedron, flag off", "dumbbell"])
def test_clumps(shape: str, dofs: str) -> None:
    """Forces and torques on the members and on the clump itself, every step and permanent."""
    generator = np.random.default_rng(2)
    material()
    corners = [(1.5, 0, 0), (-1.5, 0, 0), (0, 1.5, 0), (0, -1.5, 0), (0, 0, 1.5), (0, 0, -1.5)]
    number, members = dumbbell(corners[:2] if shape == "dumbbell" else corners)
    if shape == "octahedron":
        # Its moments of inertia agree up to rounding only, therefore YADE's own flag is left to chance.
        O.bodies[number].aspherical = True
    elif shape == "octahedron, flag off":
        O.bodies[number].aspherical = False
    set_in_motion(number, generator)
    state(number).blockedDOFs = dofs
    for member in members:
        O.forces.setPermF(member, random_vector(generator, 1e4))
        O.forces.setPermT(member, random_vector(generator, 1e4))
    equip(H, GRAVITY, loads(members + [number]))
    for _ in range(4):
        step_and_compare(forces=30)
        free_equals_predicted()
        for member in members:  # rigid motion of the members, as YADE hands it on
            arm = state(member).pos - state(number).pos
            expected = state(number).vel + state(number).angVel.cross(arm)
            assert (state(member).vel - expected).norm() <= 1e-12 * (1 + expected.norm())


def test_mask_of_the_integrator() -> None:
    """Bodies outside NewtonIntegrator.mask stay where they are; there is no prediction for them."""
    material()
    for k, mask in enumerate((1, 2, 3, 4)):
        grain((5.0 * k, 0, 0), velocity=(1, 2, 3), mask=mask)
    equip(H, GRAVITY)
    engine("NewtonIntegrator").mask = 2
    assert integrated() == [1, 2]
    step_and_compare()
    assert [v is None for v in cd().freeVelocities()] == [True, False, False, True]
    assert vec(state(0).pos) == pytest.approx([0, 0, 0], abs=0)


def test_body_outside_the_mask_is_an_obstacle_at_rest() -> None:
    """It does not move whatever its `vel` says, so a ball that lies on it stays at rest."""
    material()
    grain((0, 0, 0), velocity=(0, 0, 5), mask=4 + 1)
    grain((0, 0, 2), mask=4 + 2)  # the common bit lets the two collide
    equip(H)
    engine("NewtonIntegrator").mask = 2
    steps(10)
    assert abs(state(1).vel[2]) <= 1e-12 and abs(state(1).pos[2] - 2) <= 1e-12


def test_density_scaling() -> None:
    """With `densityScaling` on, accelerations are multiplied, and rotations of aspherical bodies too."""
    generator = np.random.default_rng(3)
    material()
    for k, place in enumerate(lattice(4)):
        number = grain(place)
        O.bodies[number].aspherical = k > 1
        state(number).inertia = Vector3(1e4, 2e4, 3e4)
        set_in_motion(number, generator)
        state(number).densityScaling = 0.25 + 0.5 * k
    number, _ = dumbbell([(50, 0, 0), (52, 0, 0)])
    set_in_motion(number, generator)
    for b in O.bodies:
        if b.isClumpMember or b.isClump:
            b.state.densityScaling = 0.5
    # YADE only lets the flag be set while its own time stepper is in the list, which Contact Dynamics does not allow.
    _switch_density_scaling_on()
    for _ in range(3):
        step_and_compare(forces=30, scaling=True)


def test_density_scaling_in_contact() -> None:
    """The scaled masses enter the contact condition: a scaled ball stays at rest on the floor."""
    material()
    floor()
    low, high = grain((0, 0, 1)), grain((0, 0, 3))
    for number, scaling in ((low, 0.5), (high, 3.0)):
        state(number).densityScaling = scaling
    _switch_density_scaling_on(gravity=(0, 0, -9.81), tolerance=1e-12, maxIterations=10000)
    for _ in range(3):
        step_and_compare(forces=60, scaling=True)
        # g h = 1e-2 is what would be left without contact; the solver's tolerance is 1e-12 of that.
        assert abs(state(low).vel[2]) <= 1e-13 and abs(state(high).vel[2]) <= 1e-13


def _switch_density_scaling_on(gravity=GRAVITY, **more) -> None:
    equip(H, gravity, **more)
    plain = list(O.engines)
    newton = engine("NewtonIntegrator")
    O.engines = plain + [GlobalStiffnessTimeStepper()]
    newton.densityScaling = True
    O.engines = plain
    assert engine("NewtonIntegrator").densityScaling


def heap(with_contact_dynamics: bool) -> None:
    """Spheres, a turned dumbbell, a blocked sphere and an aspherical one, all touching at the start."""
    material(friction=0.4)
    floor()
    grain((0, 0, 0.999), velocity=(1, 0.3, -2), spin=(2, -1, 3))
    grain((1.6, 0, 2.2), velocity=(-1, 0, -1))
    grain((-3, 0, 1), velocity=(4, 0, -1))
    state(3).blockedDOFs = "yXZ"
    number, _ = dumbbell([(4, 0, 1.0), (5.5, 0.5, 2.0)])
    state(number).vel = Vector3(-2, 0.2, -1)
    state(number).angMom = Vector3(1e4, -2e4, 1e4)
    aspherical = grain((0, 5, 1), velocity=(0, -1, -3))
    O.bodies[aspherical].aspherical = True
    state(aspherical).inertia = Vector3(3e3, 4e3, 5e3)
    state(aspherical).angMom = Vector3(2e4, 1e4, -3e4)
    O.forces.setPermF(1, Vector3(5e3, 0, 2e3))
    equip(H, GRAVITY, loads([1, 2, number]), tolerance=1e-10, maxIterations=10000)
    if not with_contact_dynamics:
        O.engines = [e for e in O.engines if type(e).__name__ != "ContactDynamicsEngine"]


def test_free_velocity_beside_contacts_is_that_of_a_step_without_the_engine() -> None:
    """One step of the same scene without contact forces is the independent evaluation."""
    heap(with_contact_dynamics=False)
    O.step()
    expected = {n: (vec(state(n).vel), vec(state(n).angVel)) for n in integrated()}
    O.reset()
    heap(with_contact_dynamics=True)
    O.step()
    free = cd().freeVelocities()
    assert cd().activeContacts >= 3
    for number, (linear, spin) in expected.items():
        assert np.abs(vec(free[number][0]) - linear).max() <= 1e-12 * (1 + np.linalg.norm(linear))
        if not O.bodies[number].aspherical:
            assert np.abs(vec(free[number][1]) - spin).max() <= 1e-12 * (1 + np.linalg.norm(spin))


def test_velocity_with_contacts_is_realised() -> None:
    """The same heap over many steps: impacts, sliding, rolling."""
    heap(with_contact_dynamics=True)
    touched = 0
    for _ in range(300):
        step_and_compare(forces=60)
        touched += cd().activeContacts
    assert touched > 300


def test_driven_bodies_keep_their_velocity_and_push() -> None:
    """A fixed body with a velocity moves with it and carries what lies on it."""
    material(friction=1.0)
    plate = box((0, 0, -1), (10, 10, 1))
    state(plate).vel = Vector3(0.5, 0, 2)
    number = grain((0, 0, 1))
    state(number).blockedDOFs = "XYZ"
    equip(H, tolerance=1e-12)
    for _ in range(5):
        step_and_compare()
    assert vec(state(plate).vel) == pytest.approx([0.5, 0, 2], abs=0)
    # Friction 1 can give the grain the speed of the plate at once, because the normal impulse carries it up at 2 m/s.
    assert vec(state(number).vel) == pytest.approx([0.5, 0, 2], rel=1e-10, abs=1e-10)
