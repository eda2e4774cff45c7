# SPDX-License-Identifier: GPL-2.0-or-later
"""Prediction of velocities in a periodic cell: at rest, deforming, and with a velocity gradient that changes."""

from __future__ import annotations

import numpy as np
import pytest
from yade import Matrix3, O, PyRunner, Vector3

from prediction import free_equals_predicted, step_and_compare
from scenes import cd, contacts, dumbbell, engine, equip, grain, material, state, steps, vec
from test_free_velocity import set_in_motion

H = 1e-3
SHEAR = Matrix3(0.2, 0.5, -0.1, 0.3, -0.4, 0.2, 0.1, -0.6, 0.15)
OTHER = Matrix3(-0.3, 0.1, 0.4, -0.2, 0.25, 0.1, 0.5, 0.2, -0.1)
NONE = Matrix3(0, 0, 0, 0, 0, 0, 0, 0, 0)


def population() -> None:
    """One body of each branch, inside and outside of the first period."""
    generator = np.random.default_rng(4)
    O.periodic = True
    O.cell.setBox(60, 60, 60)
    material()
    for k, dofs in enumerate(("", "x", "zXY", "XYZ", "xyz", "xyzXYZ")):
        number = grain((8 * k + 3, 4, 5))
        state(number).blockedDOFs = dofs
        set_in_motion(number, generator)
    number = grain((100, -70, 20))
    set_in_motion(number, generator)
    number = grain((20, 30, 40))
    O.bodies[number].aspherical = True
    state(number).inertia = Vector3(3e3, 4e3, 5e3)
    set_in_motion(number, generator)
    number, _ = dumbbell([(40, 40, 10), (41, 42, 10)])
    set_in_motion(number, generator)
    number, _ = dumbbell([(10, 40, 30), (11, 42, 30)])
    set_in_motion(number, generator)
    state(number).blockedDOFs = "XYZ"


@pytest.mark.parametrize("homo_deform", [0, 1, 2, 3])
def test_gradient_that_changes_in_mid_run(homo_deform: int) -> None:
    """A cell at rest, then every way in which a script sets the gradient, and back to rest."""
    population()
    O.cell.homoDeform = homo_deform
    equip(H, gravity=(0.1, 0.2, -9.81))

    def compare(number: int) -> None:
        for _ in range(number):
            step_and_compare(forces=60)
            free_equals_predicted()

    compare(3)
    O.cell.velGrad = SHEAR
    compare(4)
    O.cell.velGrad = OTHER
    compare(3)
    O.cell.velGrad = NONE
    compare(3)
    assert O.cell.velGrad == NONE


def test_gradient_set_during_the_step() -> None:
    """An engine in front of ours sets the gradient, as YADE's periodic controllers do."""
    population()
    equip(H, before=[PyRunner(command="import test_free_velocity_periodic as t; t.steer()", iterPeriod=1)])
    for _ in range(6):
        step_and_compare(forces=60)


def steer() -> None:
    """Another gradient in each step."""
    O.cell.velGrad = SHEAR * (1 + 0.1 * O.iter)


def test_images_move_with_the_cell() -> None:
    """Two spheres touch across the boundary of a cell that shrinks: the image comes nearer at the rate of the cell.

    Closed form: without friction and gravity the images approach at |velGrad_xx| times the cell length, here 1 m/s;
    with homoDeform = 0 (no mean field added to the velocities) the two equal spheres share that speed.
    """
    O.periodic = True
    O.cell.setBox(10, 10, 10)
    O.cell.homoDeform = 0
    material(friction=0)
    left, right = grain((1, 5, 5)), grain((9, 5, 5))
    equip(H, gravity=(0, 0, 0), tolerance=1e-12)
    O.cell.velGrad = Matrix3(-0.1, 0, 0, 0, 0, 0, 0, 0, 0)
    # The integrator puts the gradient into effect at the end of the first step and the cell moves at the start of the
    # next: the velocities of the first step are those with which the spheres meet the moved image.
    O.step()
    assert state(left).vel[0] == pytest.approx(0.5, rel=1e-9)
    assert state(right).vel[0] == pytest.approx(-0.5, rel=1e-9)
    for _ in range(20):
        O.step()
        assert cd().maxPenetration <= 1e-12


@pytest.mark.parametrize("friction", [0.1, 5.0])
def test_friction_across_a_sheared_boundary(friction: float) -> None:
    """The image moves sideways with the cell: closed form of the impact of two balls with that tangential velocity.

    Equal balls meet at 2 m/s: P_N = m; the image slides at 10 velGrad_xz = 3 m/s, W_T = 7/2 W_N = 7/m.
    """
    O.periodic = True
    O.cell.setBox(10, 10, 10)
    O.cell.homoDeform = 0
    material(friction)
    low, high = grain((5, 5, 1), velocity=(0, 0, -1)), grain((5, 5, 9), velocity=(0, 0, 1))
    equip(H, gravity=(0, 0, 0), tolerance=1e-12)
    O.cell.velGrad = Matrix3(0, 0, 0.3, 0, 0, 0, 0, 0, 0)
    O.step()
    drag = min(friction, 3 / 7)
    assert vec(state(low).vel) == pytest.approx([-drag, 0, 0], abs=1e-11)
    assert vec(state(high).vel) == pytest.approx([drag, 0, 0], abs=1e-11)
    assert cd().converged


@pytest.mark.parametrize("homo_deform", [0, 1, 2])
def test_dense_cell_under_shear(homo_deform: int) -> None:
    """Contacts across all faces of a sheared cell: the realised velocity is the predicted one, step by step."""
    generator = np.random.default_rng(5)
    O.periodic = True
    O.cell.setBox(8, 8, 8)
    material(friction=0.4)
    for k in range(64):
        place = 2 * np.array([k % 4, k // 4 % 4, k // 16]) + 1 + generator.uniform(-0.05, 0.05, 3)
        grain(place, radius=0.97, velocity=generator.uniform(-1, 1, 3))
    O.cell.homoDeform = homo_deform
    equip(H, gravity=(0, 0, 0), tolerance=1e-6)
    touched = 0
    for k in range(60):
        if k in (5, 30):
            O.cell.velGrad = SHEAR * (4 if k == 5 else -3)
        step_and_compare()
        touched += cd().activeContacts
    assert touched > 60
    across = [i for i in contacts() if i.cellDist != (0, 0, 0)]
    assert across
    # Momentum: whatever one side of a periodic contact gives, the other takes.
    total = sum((vec(O.forces.f(b.id)) for b in O.bodies), np.zeros(3))
    size = sum(i.phys.impulse.norm() for i in contacts()) / H
    assert np.linalg.norm(total) <= 1e-13 * size


def test_cell_keeps_its_bookkeeping() -> None:
    """The integrator's memory of the gradient stays its own: the engine only reads it."""
    population()
    equip(H)
    O.cell.velGrad = SHEAR
    steps(2)
    assert O.cell.velGrad == SHEAR and O.cell.prevVelGrad == SHEAR and engine("NewtonIntegrator").prevVelGrad == SHEAR
