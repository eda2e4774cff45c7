# SPDX-License-Identifier: GPL-2.0-or-later
"""The triaxial box: walls as bodies under force, their equation of motion, reports, bits, bad input."""

from __future__ import annotations

import math
import numpy as np
import pytest
from yade import O, Vector3, utils

import contactdynamics.triaxial as triaxial
import triaxial_cases as cases
from contactdynamics import ContactDynamicsTriaxialController
from halves import same_bits
from prediction import step_and_compare
from refusal import attribute_refused, refused
from scenes import engine, grain, impulse_on, material, state, steps, vec
from triaxial_cases import H, PRESSURE


def momentum_of_grains(walls: list[int]) -> np.ndarray:
    return sum((b.state.mass * vec(b.state.vel) for b in O.bodies if b.id not in walls), np.zeros(3))


def controller():
    return engine("ContactDynamicsTriaxialController")


@pytest.mark.parametrize("gravity", [(0, 0, 0), (0, 2, -9.81)])
def test_wall_obeys_its_equation_of_motion(gravity) -> None:
    """m dv = h (goal · area) + contact impulses, from the motion YADE makes; bodies move as predicted."""
    walls = cases.build(gravity=gravity)
    moved = touched = 0.0
    for _ in range(60):
        before, resistance = [vec(state(n).vel) for n in walls], [impulse_on(n) for n in walls]
        step_and_compare(forces=PRESSURE * 80 / 1e4)
        c = controller()
        for place, number in enumerate(walls):
            axis, other = place // 2, [a for a in range(3) if a != place // 2]
            velocity = vec(state(number).vel)
            assert (velocity[other] == 0).all() and state(number).angVel == Vector3(0, 0, 0)
            if place % 2 == 0:
                assert velocity[axis] == 0
                continue
            push, contact = -H * PRESSURE * c.size[other[0]] * c.size[other[1]], impulse_on(number)[axis]
            bounded = max(push, c.wallMassInUse * (-1.0 * c.size[axis] - before[place][axis]) - 2 * resistance[place][axis])
            change = c.wallMassInUse * (velocity[axis] - before[place][axis])
            # Gravity goes in and out again: its share is of the round-off.
            scale = abs(push) + abs(contact) + c.wallMassInUse * (np.abs(before[place]).max() + H * 9.81)
            assert abs(change - bounded - contact) <= 1e-12 * scale
            moved, touched = max(moved, -velocity[axis]), touched + (contact > 0)
    assert moved > 0.1 and touched > 20


def test_confinement_at_rest_and_report() -> None:
    """Walls of every pair carry the goal, and differ by the change of momentum between them; the tensor of all contacts agrees with the walls."""
    walls = cases.build(friction=0.3, tolerance=1e-6)
    steps(600)
    rows = []
    for _ in range(100):
        before = momentum_of_grains(walls)
        O.step()
        found = triaxial.report()
        change = (momentum_of_grains(walls) - before) / H
        for axis in range(3):
            area = np.prod(vec(found.size)) / found.size[axis]
            # Held wall pushes along +, moving wall along -: p changes by their difference. Round-off of momenta that hardly change.
            held = 2 * found.wallStress[axis] - found.movingWallStress[axis]
            assert (found.movingWallStress[axis] - held) * area == pytest.approx(change[axis], abs=1e-9 * PRESSURE * area)
            assert found.imbalance * PRESSURE * 1.1 * area >= abs(change[axis])
        rows.append([*found.movingWallStress, *found.wallStress, *(found.stress[i, i] for i in range(3))])
    moving, both, tensor = np.split(np.array(rows), 3, axis=1)
    # In every step but for the inertia of the wall: a tenth of a layer of grains that come to rest.
    assert moving == pytest.approx(np.full((100, 3), -PRESSURE), rel=1e-3)
    # Single grains still find their place, with forces that leave nothing in the mean over 0.2 s but a change of momentum: 1e4 kg by 0.1 m/s, over
    # 0.2 s and 60 m2, 1e-4 of the goal. In equilibrium the sum of r ⊗ b over the contacts is that of the wall forces times their places (Gauss).
    assert both.mean(axis=0) == pytest.approx(np.full(3, -PRESSURE), rel=1e-3)
    assert tensor.mean(axis=0) == pytest.approx(np.full(3, -PRESSURE), rel=2e-3)
    assert found.imbalance < 2e-2
    assert found.mobilisedFriction < 1
    assert found.strain == pytest.approx([math.log(s / (4 * 2.05)) for s in found.size], rel=1e-12)
    grains = sum(4 / 3 * math.pi * b.shape.radius**3 for b in O.bodies if b.id not in walls)
    assert found.packingFraction == pytest.approx(grains / np.prod(vec(found.size)), rel=1e-12)
    for number in walls[1::2]:
        assert state(number).vel.norm() < 1e-3 * 2 / 0.1  # of a diameter in the time the pressure moves a grain by it
        assert impulse_on(number).max() / H == pytest.approx(PRESSURE * np.prod(vec(found.size)) / found.size[walls.index(number) // 2], rel=1e-3)


def test_shear_drives_one_axis_and_holds_the_others() -> None:
    cases.build(friction=0.3, tolerance=1e-6)
    steps(300)
    triaxial.shear(-0.3)
    steps(1)
    start = controller().size[2]
    held = []
    for _ in range(300):
        O.step()
        held.append(vec(triaxial.report().wallStress))
    found = triaxial.report()
    assert found.strain[2] == pytest.approx(-0.3 * 300 * H, rel=1e-9)
    assert found.size[2] == pytest.approx(start * math.exp(-0.3 * 300 * H), rel=1e-12)
    # The mean over 0.4 s leaves the change of momentum of 64 grains and a wall, some 6e5 kg by 1 m/s, over that time and 60 m2.
    mean = np.mean(held[100:], axis=0)
    assert mean[:2] == pytest.approx([-PRESSURE] * 2, rel=0.05)
    assert mean[2] < -1.2 * PRESSURE
    assert 5 < found.mobilisedFriction < 60
    triaxial.shear(0, axis="x", resetStrain=False)
    assert controller().stressMask == 6 and found.strain[2] == controller().strain[2]
    steps(2)
    assert state(controller().walls[1]).vel == Vector3(0, 0, 0) and controller().strain[2] != 0


def test_light_wall_reaches_the_goal_in_spite_of_a_bound_on_its_rate() -> None:
    """The bound is on the motion: a wall that hardly moves presses with all of the goal, were it as light as a feather."""
    cases.build(friction=0.3, tolerance=1e-6)
    controller().wallMass = 200.0  # of 6e5 kg of grains: at the bound of 1/s times 8 m its own inertia takes 1 % of the goal
    steps(400)
    found = triaxial.report()
    # The moving walls: what they still accelerate with is 200 kg times speeds of grains that settle, below 0.5 m/s, over h and 60 m2: 8e-4.
    assert found.movingWallStress == pytest.approx([-PRESSURE] * 3, rel=1e-3)
    assert found.wallStress == pytest.approx([-PRESSURE] * 3, rel=0.05)


def test_walls_younger_than_the_grains() -> None:
    """What pushes a wall is found whichever of the two has the smaller id."""
    material(0.3), material(0)
    for k in range(8):
        grain(2.05 * (np.array([k % 2, k // 2 % 2, k // 4]) + 0.5), radius=1)
    walls = triaxial.box((0, 0, 0), (4.1, 4.1, 4.1))
    O.engines = triaxial.engines(walls, stress=-PRESSURE, maxStrainRate=0.5, tolerance=1e-8, maxIterations=5000)
    controller().wallMass = 100.0
    O.dt = H
    steps(150)
    assert triaxial.report().movingWallStress == pytest.approx([-PRESSURE] * 3, rel=1e-5)


def test_walls_of_shape_wall() -> None:
    """YADE's infinite planes serve as well as boxes."""
    material(0.3), material(0)
    walls = [O.bodies.append(utils.wall(place * 4.1, axis, sense=0, material=O.materials[1])) for axis in range(3) for place in (0, 1)]
    for k in range(8):
        grain(2.05 * (np.array([k % 2, k // 2 % 2, k // 4]) + 0.5), radius=1)
    O.engines = triaxial.engines(walls, stress=-PRESSURE, maxStrainRate=0.5, tolerance=1e-8, maxIterations=5000)
    O.dt = H
    steps(150)
    found = triaxial.report()
    assert found.size == pytest.approx([4, 4, 4], abs=1e-6)
    assert found.wallStress == pytest.approx([-PRESSURE] * 3, rel=1e-5)


def test_same_bits_with_two_threads_and_across_a_file(tmp_path) -> None:
    same_bits("triaxial_cases", tmp_path)


# --- bad input ------------------------------------------------------------------------------------------------------

NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize(
    "attribute, value, words",
    [
        ("walls", [0, 1, 2], ("walls = #0, #1, #2", "six")),
        ("walls", [0, 1, 2, 3, 4, 4], ("six different",)),
        ("walls", [0, 1, 2, 3, 4, -1], ("#-1",)),
        ("stress", Vector3(-1, 1, -1), ("stress", "not positive")),
        ("stress", Vector3(-1, NAN, -1), ("stress", "nan")),
        ("strainRate", Vector3(0, 0, INF), ("strainRate", "inf")),
        ("stressMask", 8, ("stressMask = 8",)),
        ("stressMask", -1, ("stressMask = -1",)),
        ("wallMass", -2.0, ("wallMass = -2",)),
        ("wallMass", INF, ("wallMass = inf",)),
        ("maxStrainRate", 0.0, ("maxStrainRate = 0",)),
        ("referenceSize", Vector3(1, 0, 1), ("referenceSize = 1 0 1",)),
        ("referenceSize", Vector3(1, NAN, 1), ("referenceSize", "nan")),
        ("referenceSize", Vector3(1, -1, 1), ("referenceSize", "-1")),
        ("maxStrainRate", NAN, ("maxStrainRate = nan",)),
    ],
)
def test_inadmissible_attributes(attribute: str, value, words) -> None:
    attribute_refused(ContactDynamicsTriaxialController, attribute, value, words, walls=[5, 4, 3, 2, 1, 0], stress=(-1, -2, -3), strainRate=(1, 2, 3), stressMask=5, wallMass=3, maxStrainRate=2, referenceSize=(1, 2, 3))


def test_no_walls() -> None:
    cases.build()
    walls = controller().walls
    controller().walls = []
    refused("walls is empty", "triaxial")
    controller().walls = walls
    steps(2)


def test_body_that_does_not_exist_or_is_no_wall() -> None:
    walls = cases.build()
    controller().walls = walls[:5] + [9999]
    refused("#9999", "does not exist")
    controller().walls = walls[:5] + [20]
    refused("#20", "no Box or Wall")
    controller().walls = walls
    steps(2)


def test_walls_that_have_passed_each_other() -> None:
    walls = cases.build()
    place = Vector3(state(walls[1]).pos)
    state(walls[1]).pos = Vector3(-1, 0, 0)
    refused("length -1", "along x", f"#{walls[1]}")
    state(walls[1]).pos = place
    steps(2)


def test_wall_too_light_for_the_step() -> None:
    """In free flight it would go through everything before anybody sees it."""
    cases.build()
    controller().wallMass = 1e-3
    refused("wallMass", "0.001 kg", "at least", "O.dt")
    controller().wallMass = 0
    steps(2)


def test_vector_written_in_place() -> None:
    cases.build()
    controller().stress[1] = 3
    refused("stress", "not positive")
    controller().stress = Vector3(-1, -1, -1)
    steps(2)


def test_controller_behind_the_engine() -> None:
    cases.build()
    right = list(O.engines)
    c = controller()
    O.engines = [e for e in right if e is not c and type(e) is not type(c)] + [c]
    refused("ContactDynamicsTriaxialController", "before")
    O.engines = right
    steps(2)


def test_helpers_refuse() -> None:
    with pytest.raises(ValueError, match="low = .*high"):
        triaxial.box((0, 0, 0), (1, 0, 1))
    with pytest.raises(ValueError, match="friction"):
        triaxial.box((0, 0, 0), (1, 1, 1), friction=-1)
    with pytest.raises(RuntimeError, match="0 engines"):
        triaxial.report()
    cases.build()
    with pytest.raises(RuntimeError, match="no step"):
        triaxial.report()
    with pytest.raises(ValueError, match="axis"):
        triaxial.shear(-1, axis="w")
    with pytest.raises(ValueError, match="strainRate"):
        triaxial.shear(NAN)
    with pytest.raises(ValueError, match="stress"):
        triaxial.engines([0, 1, 2, 3, 4, 5], stress=1.0)


def test_strain_goes_on_after_a_value_was_refused() -> None:
    """The size that strain is measured from was taken from the scene in the first step; a refusal later puts nothing else back."""
    cases.build()
    steps(5)
    c = controller()
    before, strain = c.referenceSize, c.strain
    assert before[0] > 0
    with pytest.raises(ValueError):
        c.wallMass = -2
    assert c.referenceSize == before
    steps(1)
    assert c.referenceSize == before and (c.strain - strain).norm() < 0.1 * max(1e-3, strain.norm())
