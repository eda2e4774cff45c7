# SPDX-License-Identifier: GPL-2.0-or-later
"""ContactDynamicsTimeStepper: the step follows the motion, within the user's bounds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import Matrix3, O, Vector3, polyhedra_utils, utils, wrapper

import contactdynamics
from scenes import EPS, G, cd, contact, equip, floor, grain, material, overlaps, state, steps, vec


def _equip(gravity=(0, 0, 0), **bounds):
    """The engines with a time stepper of the given bounds; returns it."""
    stepper = wrapper.ContactDynamicsTimeStepper(**bounds)
    O.engines = contactdynamics.engines(gravity=gravity, timeStepper=stepper)
    return stepper


def test_step_of_a_flying_ball() -> None:
    """h v = maxDisplacement r."""
    material()
    grain((0, 0, 0), radius=0.5, velocity=(3, 0, 4)), grain((50, 0, 0), radius=2)
    stepper = _equip(maxDisplacement=0.2)
    O.step()
    assert O.dt == pytest.approx(0.2 * 0.5 / 5, rel=4 * EPS) and stepper.limitedBy == "displacement"


def test_step_of_a_falling_ball() -> None:
    """h (v + h g) = maxDisplacement r, also from rest."""
    material()
    ball = grain((0, 0, 0), radius=0.5)
    _equip(gravity=(0, 0, -G), maxDisplacement=0.2, growth=10)
    for _ in range(5):
        speed, before = state(ball).vel.norm(), vec(state(ball).pos)
        O.step()
        assert O.dt * (speed + O.dt * G) == pytest.approx(0.1, rel=1e-12)
        assert np.linalg.norm(vec(state(ball).pos) - before) == pytest.approx(0.1, rel=1e-12)


def test_step_of_a_turning_ball() -> None:
    """h omega = maxRotation."""
    material()
    grain((0, 0, 0), spin=(0, 0, 20))
    stepper = _equip(maxRotation=0.3)
    O.step()
    assert O.dt == pytest.approx(0.3 / 20, rel=4 * EPS) and stepper.limitedBy == "rotation"


@pytest.mark.parametrize("bounds, largest, limit", [({"maxRotation": 0.1}, 0.1, "rotation"), ({"maxDisplacement": 0.2}, 0.2, "displacement")])
def test_step_in_a_cell_that_deforms(bounds: dict, largest: float, limit: str) -> None:
    """h |velGrad| = maxRotation, and h |velGrad| r = maxDisplacement r; a ball that only goes with the cell has no speed of its own."""
    O.periodic = True
    O.cell.setBox(10, 10, 10)
    O.cell.velGrad = Matrix3(-3, 4, 0, 0, 0, 0, 0, 0, 12)  # its norm is 13
    material()
    ball = grain((5, 5, 5), radius=0.5)
    stepper = _equip(growth=1e9, **bounds)
    O.step()  # at the end of it YADE puts the rate in force
    state(ball).vel = O.cell.velGrad * state(ball).pos
    O.step()
    # The ball goes with the cell but for the round-off of its 60 m/s, beside the 6.5 m/s of strain over a radius.
    assert O.dt == pytest.approx(largest / 13, rel=2 * 60 / 6.5 * EPS) and stepper.limitedBy == limit


def test_cell_under_stress_takes_no_step_too_far() -> None:
    """A gas of balls is compressed by a prescribed stress: the step follows the strain that is to come, and no pair is met too late.

    Relative displacement of two touching balls in a step: strain times the sum of their radii, at most twice maxDisplacement of the smaller radius.
    """
    generator = np.random.default_rng(1)
    O.periodic = True
    O.cell.setBox(10, 10, 10)
    material()
    for k in range(64):
        grain(2.5 * np.array([k % 4 + 0.5, k // 4 % 4 + 0.5, k // 16 + 0.5]) + generator.uniform(-0.02, 0.02, 3), radius=generator.uniform(0.9, 1))
    _equip()
    control = contactdynamics.ContactDynamicsCellController(stress=Matrix3(-1e6, 0, 0, 0, -1e6, 0, 0, 0, -1e6), maxStrainRate=3.0)
    O.engines = O.engines[:-2] + [control] + O.engines[-2:]
    O.dt = 1e-3
    deepest = largest = 0.0
    for _ in range(120):
        O.step()
        deepest, largest = max(deepest, cd().maxPenetration), max(largest, O.dt * O.cell.velGrad.norm())
    assert 0.005 < largest <= 0.25 * (1 + 1e-9)
    # The direction of a contact turns by up to a quarter in such a step; what is left of that is of second order in it.
    assert deepest < 0.25**2
    assert cd().activeContacts > 100


def test_fixed_distance_of_detection() -> None:
    material()
    grain((0, 0, 0), velocity=(2, 0, 0))
    stepper = _equip(proximityDistance=0.1)
    O.step()
    assert O.dt == pytest.approx(0.05 / 2, rel=4 * EPS) and stepper.limitedBy == "proximity"


def test_bounds_and_growth() -> None:
    material()
    ball = grain((0, 0, 0), velocity=(1, 0, 0))
    stepper = _equip(minTimeStep=1e-3, maxTimeStep=2e-3, growth=1.5)
    O.step()
    assert O.dt == 2e-3 and stepper.limitedBy == "maxTimeStep"
    state(ball).vel = Vector3(1e6, 0, 0)
    O.step()
    assert O.dt == 1e-3 and stepper.limitedBy == "minTimeStep"
    state(ball).vel = Vector3(1, 0, 0)
    O.step()
    assert O.dt == pytest.approx(1.5e-3, rel=4 * EPS) and stepper.limitedBy == "growth"


def test_nothing_moves() -> None:
    material()
    grain((0, 0, 0))
    stepper = _equip()
    O.dt = 0.125
    steps(3)
    assert O.dt == 0.125 and stepper.limitedBy == ""


@pytest.mark.parametrize(
    "attribute, value",
    [
        ("maxDisplacement", 0),
        ("maxDisplacement", math.nan),
        ("maxRotation", -1),
        ("proximityDistance", -1e-3),
        ("minTimeStep", -1),
        ("maxTimeStep", math.inf),
        ("growth", 0.9),
    ],
)
def test_bad_values_are_refused(attribute: str, value: float) -> None:
    stepper = wrapper.ContactDynamicsTimeStepper()
    good = getattr(stepper, attribute)
    with pytest.raises(ValueError, match=attribute):
        setattr(stepper, attribute, value)
    assert getattr(stepper, attribute) == good


def test_behind_the_collider_is_refused() -> None:
    material()
    grain((0, 0, 0), velocity=(1, 0, 0))
    equip(1e-3)
    O.engines = O.engines + [wrapper.ContactDynamicsTimeStepper()]
    with pytest.raises(RuntimeError, match="behind the collider"):
        O.step()


def _bed() -> int:
    """A resting bed of 7 x 7 x 3 grains of radius 1 on a floor, and a ball that comes down on it at 50 radii a second. Returns the ball's id."""
    material(0.5)
    floor()
    for z in range(3):
        for x in range(7):
            for y in range(7):
                grain((2 * x, 2 * y, 1 + 2 * z))
    for n in range(1, len(O.bodies)):
        if state(n).pos[0] in (0, 12) or state(n).pos[1] in (0, 12):
            state(n).blockedDOFs = "xyzXYZ"  # the rim holds the bed together
    return grain((6.3, 6.2, 20), velocity=(0, 0, -50))


def _impact(ball: int, time: float) -> tuple[int, float, float]:
    """Steps, deepest overlap and lowest place of the ball up to the given time."""
    number, deepest, lowest = 0, 0.0, math.inf
    while O.time < time:
        O.step()
        number += 1
        deepest = max(deepest, overlaps().max(initial=0.0))
        lowest = min(lowest, state(ball).pos[2])
    return number, deepest, lowest


def test_fast_ball_does_not_tunnel_nor_slow_the_scene_down() -> None:
    """Gravity -G in units of radii; 0.5 s of flight, impact and rest. By hand: flight and impact at the step that 50 radii a second allow for the same
    displacement, 0.25 r, and rest at the largest step that a hundredth of a second is; anything coarser misjudges the direction of the blow."""
    ball = _bed()
    stepper = _equip(gravity=(0, 0, -G), maxTimeStep=1e-2)
    number, deepest, lowest = _impact(ball, 0.5)
    assert lowest > 3 and deepest < 5e-3, (lowest, deepest)
    flight = 13.0 / 50  # s, until the ball meets the bed
    optimum = flight * 50 / stepper.maxDisplacement + (0.5 - flight) / 1e-2
    assert number <= 2 * optimum, (number, optimum)
    assert O.dt == 1e-2, "the scene came to rest, so the step is back at its upper bound"


def test_impulses_follow_the_step() -> None:
    """A resting ball while the step changes twentyfold: the reaction stays its weight, and the warm start costs no sweeps."""
    material()
    floor()
    ball, mover = grain((0, 0, 1)), grain((50, 0, 30), velocity=(0, 0, 0))
    _equip(gravity=(0, 0, -G))
    state(mover).blockedDOFs = "xyzXYZ"
    for speed in (0, 5, 0.5, 20):
        state(mover).vel = Vector3(speed, 0, 0)
        steps(5)
        assert contact(0, ball).phys.normalForce[2] == pytest.approx(state(ball).mass * G, rel=1e-9)
        assert abs(state(ball).vel[2]) < 1e-9


def test_same_bits_after_loading(tmp_path) -> None:
    def numbers() -> list:
        return [(tuple(b.state.pos), tuple(b.state.vel)) for b in O.bodies] + [O.dt]

    ball = _bed()
    _equip(gravity=(0, 0, -G))
    steps(60)
    O.save(str(tmp_path / "middle.yade.gz"))
    steps(40)
    straight = numbers()
    O.load(str(tmp_path / "middle.yade.gz"))
    steps(40)
    assert numbers() == straight


@pytest.mark.parametrize("small_ball", [False, True])
def test_blocks_are_bodies_like_spheres(small_ball: bool) -> None:
    """h (v + h g) = maxDisplacement r with r half the thickness of a slender block, where no sphere is smaller."""
    half = 0.5
    material()
    corners = [(x, y, z) for x in (-7 * half, 7 * half) for y in (-2 * half, 2 * half) for z in (-half, half)]
    cube = O.bodies.append(polyhedra_utils.polyhedra(O.materials[0], v=corners))
    grain((30, 0, 0), radius=0.3 if small_ball else 5)
    utils_box = O.bodies.append(utils.box((60, 0, 0), (0.01, 9, 9), fixed=True))  # a wall is no grain
    assert not O.bodies[utils_box].dynamic
    state(cube).angVel = Vector3(1e-3, 0, 0)
    stepper = _equip(gravity=(0, 0, -G), maxDisplacement=0.2, growth=10)
    O.step()
    radius = 0.3 if small_ball else half
    assert O.dt * O.dt * G == pytest.approx(0.2 * radius, rel=1e-12) and stepper.limitedBy == "displacement"
