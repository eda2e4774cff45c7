# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's boundary controllers beside Contact Dynamics: those that steer by strain work, the others are refused with a pointer to ours."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Peri3dController, PeriIsoCompressor, PeriTriaxController, TriaxialStressController, Vector3, utils

from contactdynamics import ContactDynamicsCellController
from prediction import step_and_compare
from refusal import refused
from scenes import cd, contacts, equip, grain, material, steps, vec

H = 1e-3


def cell() -> None:
    """64 spheres that nearly fill a periodic cell."""
    generator = np.random.default_rng(8)
    O.periodic = True
    O.cell.setBox(8, 8, 8)
    material(friction=0.3)
    for k in range(64):
        grain(2 * np.array([k % 4, k // 4 % 4, k // 16]) + 1 + generator.uniform(-0.05, 0.05, 3), radius=0.97)
    equip(H, gravity=(0, 0, 0))


def put(controller, place: str) -> None:
    """In front of the engine, between it and the integrator, or behind that."""
    engines = [e for e in O.engines if type(e) is not type(controller)]
    index = {"before": -2, "between": -1, "behind": len(engines)}[place]
    O.engines = engines[:index] + [controller] + engines[index:]


def test_peri_triax_controller_by_strain() -> None:
    """The cell reaches the strain exactly, the bodies move as predicted, and the contacts resist."""
    cell()
    put(PeriTriaxController(goal=(-0.03, 0.01, -0.02), stressMask=0, maxStrainRate=(0.5, 0.5, 0.5), globUpdate=1), "before")
    active = 0
    for step in range(120):
        step_and_compare() if step % 10 == 0 else O.step()
        active += cd().activeContacts
    strain = [math.log(O.cell.trsf[i, i]) for i in range(3)]
    # The goal is approached from the strain of the step before, whose rate the controller damps: its own tolerance is 1e-6.
    assert strain == pytest.approx([-0.03, 0.01, -0.02], abs=1e-6)
    assert active > 1000 and cd().maxPenetration < 5e-3


def test_peri_3d_controller_by_strain() -> None:
    cell()
    put(Peri3dController(goal=(-0.02, -0.01, 0, 0.01, 0, 0.02), stressMask=0, nSteps=100), "before")
    for step in range(100):
        step_and_compare() if step % 10 == 0 else O.step()
    steps(1)  # the gradient of the last step moves the cell in the next one
    left = np.array([[O.cell.trsf[i, j] for j in range(3)] for i in range(3)])
    # Symmetric small strain; Peri3dController adds up rates, the cell multiplies: they agree to second order.
    small = 0.5 * (left + left.T) - np.eye(3)
    assert small == pytest.approx(np.array([[-0.02, 0.01, 0], [0.01, -0.01, 0.005], [0, 0.005, 0]]), abs=1e-3)
    assert len(contacts()) > 64


@pytest.mark.parametrize(
    "controller",
    [
        lambda: PeriIsoCompressor(stresses=[-1e3], charLen=1),
        lambda: PeriTriaxController(goal=(-1e3, 0, 0), stressMask=1),
        lambda: PeriTriaxController(goal=(-1e3,) * 3, stressMask=7, dynCell=True),
        lambda: Peri3dController(goal=(-1e3, 0, 0, 0, 0, 0), stressMask=1),
    ],
)
def test_stress_of_the_cell_is_refused(controller) -> None:
    cell()
    right = list(O.engines)
    made = controller()
    put(made, "before")
    refused(type(made).__name__, "ContactDynamicsCellController")
    made.dead = True
    steps(1)
    O.engines = right
    steps(2)


@pytest.mark.parametrize("kind", [PeriTriaxController, Peri3dController])
@pytest.mark.parametrize("place", ["between", "behind"])
def test_gradient_changed_behind_the_solve_is_refused(kind, place: str) -> None:
    cell()
    put(kind(stressMask=0), place)
    refused(kind.__name__, "between InteractionLoop and this engine")


def test_two_masters_of_the_cell_are_refused() -> None:
    cell()
    put(PeriTriaxController(stressMask=0), "before")
    put(ContactDynamicsCellController(), "before")
    refused("PeriTriaxController", "ContactDynamicsCellController")


def walls() -> list[int]:
    """A box with 27 spheres on a lattice that nearly fills it."""
    generator = np.random.default_rng(9)
    material(friction=0.3)
    numbers = O.bodies.append(utils.aabbWalls([Vector3(0, 0, 0), Vector3(6, 6, 6)], thickness=0, material=O.materials[0]))
    for k in range(27):
        grain(2 * np.array([k % 3, k // 3 % 3, k // 9]) + 1 + generator.uniform(-0.02, 0.02, 3), radius=0.97)
    equip(H, gravity=(0, 0, 0))
    return numbers


def triaxial(numbers: list[int], **more) -> TriaxialStressController:
    ends = dict(zip(("left", "right", "bottom", "top", "back", "front"), numbers))
    return TriaxialStressController(thickness=0, computeStressStrainInterval=1, internalCompaction=more.pop("internalCompaction", False), **{f"wall_{k}_id": n for k, n in ends.items()}, **more)


def test_triaxial_stress_controller_by_strain() -> None:
    """The box shrinks at the rate asked for, and the stress reported is the force of the grains on the walls over the area."""
    numbers = walls()
    made = triaxial(numbers, stressMask=0, goal1=-0.17, goal2=-0.1, goal3=-0.19, strainDamping=0)
    put(made, "behind")
    steps(150)
    # The first step only sets the velocities; in each of the others the walls move by the rate times the present size.
    assert [float(e) for e in made.strain] == pytest.approx([149 * math.log1p(rate * H) for rate in (-0.17, -0.1, -0.19)], rel=1e-9)
    assert cd().activeContacts > 3 and cd().maxPenetration < 1e-2
    areas = [made.height * made.depth, made.width * made.depth, made.width * made.height]
    for place, number in enumerate(numbers):
        axis = place // 2
        force = vec(O.forces.f(number))[axis] * (1 if place % 2 == 0 else -1)
        assert vec(made.stress(place))[axis] == pytest.approx(force / areas[axis], rel=1e-9, abs=1e-9)
    assert made.meanStress < 0


@pytest.mark.parametrize("attributes, word", [(dict(stressMask=7), "stressMask = 7"), (dict(stressMask=7, internalCompaction=True), "internalCompaction")])
def test_triaxial_stress_controller_by_stress_is_refused(attributes: dict, word: str) -> None:
    numbers = walls()
    made = triaxial(numbers, goal1=-1e3, goal2=-1e3, goal3=-1e3, **attributes)
    put(made, "behind")
    refused("TriaxialStressController", word, "contactdynamics.triaxial")
    made.internalCompaction = False
    made.stressMask = 0
    made.goal1 = made.goal2 = made.goal3 = 0
    steps(2)


@pytest.mark.parametrize("place", ["before", "between"])
def test_triaxial_stress_controller_in_the_wrong_place(place: str) -> None:
    put(triaxial(walls(), stressMask=0), place)
    refused("TriaxialStressController", "behind")
