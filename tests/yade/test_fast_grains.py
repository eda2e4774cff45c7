# SPDX-License-Identifier: GPL-2.0-or-later
"""Grains that move by several radii in one step neither pass through others nor sink into them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3, utils

from scenes import cd, contacts, dumbbell, equip, grain, material, state, steps, vec
from test_detection import _target

H = 1e-2
REACHES = [0.3, 1.0, 2.7, 6.0]


@pytest.mark.parametrize("reach", REACHES)
@pytest.mark.parametrize("slant", [0.0, 0.8])
@pytest.mark.parametrize("kind", ["box", "wall", "facet", "sphere"])
def test_fixed_obstacle(kind: str, slant: float, reach: float) -> None:
    """`reach` is speed times time step in radii; the ball starts where it would pass through within one step.

    Planes: the linearised gap is the true one, and one contact is solved in closed form: only roundings remain.
    """
    material()
    _target(kind)
    velocity = reach / H * np.array([slant, 0, -1])
    ball = grain((0.1, 0.1, 1 + 0.4 * reach), velocity=velocity)
    if kind == "sphere":
        slant = 0.0
        state(ball).vel = state(ball).vel * 0 + Vector3(0, 0, -reach / H)
    equip(H, gravity=(0, 0, 0))
    lowest = []
    steps(4, lambda: lowest.append(state(ball).pos[2]))
    assert min(lowest) >= 1 - 1e-12 * (1 + reach), lowest
    assert lowest[-1] == pytest.approx(1, abs=1e-12 * (1 + reach))


@pytest.mark.parametrize("reach", REACHES)
@pytest.mark.parametrize("aim", [0.0, 0.5, 1.2])
def test_two_grains(aim: float, reach: float) -> None:
    """Oblique hit; the linearised gap is a lower bound of the true one for convex bodies, so no overlap is allowed."""
    material()
    one = grain((0, 0, 0), velocity=(reach / H, 0, 0))
    two = grain((math.sqrt(4 - aim**2) + 0.3 * reach, aim, 0))
    equip(H, gravity=(0, 0, 0))
    closest = []
    steps(5, lambda: closest.append((state(two).pos - state(one).pos).norm()))
    assert min(closest) >= 2 - 1e-12 * (1 + reach), closest
    assert cd().maxPenetration <= 1e-12 * (1 + reach)


@pytest.mark.parametrize("reach", REACHES)
@pytest.mark.parametrize("heavy", [1.0, 100.0])
def test_grain_at_rest_is_driven_into_a_third(reach: float, heavy: float) -> None:
    """The second grain is at rest until the first one hits it, and within the same step it would pass the third."""
    light, dense = material(), material(density=2600 * heavy)
    one = grain((0, 0, 0), velocity=(reach / H, 0, 0), material=dense)
    two = grain((2 + 0.1 * reach, 0, 0), material=light)
    three = grain((4 + 0.3 * reach, 0, 0), material=light)
    equip(H, gravity=(0, 0, 0), tolerance=1e-8, maxIterations=100000)
    ids = (one, two, three)

    def apart() -> None:
        x = [state(n).pos[0] for n in ids]
        # Three bodies, two contacts: an error of 1e-8 of the impulses moves a light grain by at most about
        # tolerance * (mass ratio) * speed * h.
        allowed = 10 * 1e-8 * heavy * reach
        assert x[1] - x[0] >= 2 - allowed and x[2] - x[1] >= 2 - allowed, x

    steps(5, apart)


@pytest.mark.parametrize("kind", ["box", "wall", "facet"])
@pytest.mark.parametrize("reach", [1.0, 5.0])
def test_grain_at_rest_is_driven_into_a_fixed_body(kind: str, reach: float) -> None:
    """As above with a floor as the third; here the second grain ends between hammer and anvil."""
    material()
    _target(kind)
    two = grain((0.1, 0.1, 1 + 0.2 * reach))
    one = grain((0.1, 0.1, 3 + 0.3 * reach), velocity=(0, 0, -reach / H))
    equip(H, gravity=(0, 0, 0), tolerance=1e-8, maxIterations=100000)

    def apart() -> None:
        low, high = state(two).pos[2], state(one).pos[2]
        allowed = 10 * 1e-8 * reach
        assert low >= 1 - allowed and high - low >= 2 - allowed, (low, high)

    steps(5, apart)


def test_row_of_grains_hit_at_its_end() -> None:
    """The blow runs through ten grains with gaps in one step; momentum is kept and nothing overlaps."""
    material()
    reach, number = 5.0, 10
    ids = [grain((2.1 * k, 0, 0)) for k in range(number)]
    state(ids[0]).vel = Vector3(reach / H, 0, 0)
    before = state(ids[0]).mass * reach / H
    equip(H, gravity=(0, 0, 0), tolerance=1e-8, maxIterations=100000)

    def apart() -> None:
        x = np.array([state(n).pos[0] for n in ids])
        assert np.diff(x).min() >= 2 - 1e-6 * reach, np.diff(x) - 2

    steps(4, apart)
    assert sum(state(n).mass * state(n).vel[0] for n in ids) == pytest.approx(before, rel=1e-12)


def test_fast_obstacle_does_not_pass_a_slow_grain() -> None:
    """The reach follows the speed of either body: a fast plate meets a grain at rest."""
    material()
    plate = O.bodies.append(utils.box((0, 0, -3), (5, 5, 1), fixed=True, material=O.materials[0]))
    state(plate).vel = Vector3(0, 0, 3 / H)
    ball = grain((0, 0, 0.5))
    equip(H, gravity=(0, 0, 0))
    steps(3, lambda: _assert_above(ball, plate))


def _assert_above(ball: int, plate: int) -> None:
    assert state(ball).pos[2] - state(plate).pos[2] >= 2 - 1e-12 * 10


def test_speed_gained_by_gravity_within_the_step_counts() -> None:
    """A grain at rest one radius above the floor, with a gravity that takes it three radii down in the first step."""
    material()
    _target("box")
    ball = grain((0, 0, 2))
    equip(H, gravity=(0, 0, -3 / H**2))
    steps(3)
    assert state(ball).pos[2] == pytest.approx(1, abs=1e-11)


def test_member_of_a_spinning_clump_is_fast_although_its_centre_is_not() -> None:
    """The end of a long dumbbell that turns about its centre at rest hits a ball within the first step."""
    material(friction=0)
    number, members = dumbbell([(-10, 0, 0), (10, 0, 0)])
    s = state(number)
    rate = 3.0 / 10 / H  # the ends move by three radii in a step
    s.angVel = Vector3(0, 0, rate)
    axis = s.ori.conjugate() * s.angVel
    s.angMom = s.ori * Vector3(*(vec(s.inertia) * vec(axis)))
    for m in members:
        state(m).vel = s.angVel.cross(state(m).pos - s.pos)
    ball = grain((10, 3.0, 0))
    equip(H, gravity=(0, 0, 0))
    O.step()
    struck = [i for i in contacts() if ball in (i.id1, i.id2) and i.phys.impulse.norm() > 0]
    assert struck and state(ball).vel[1] > 0


@pytest.mark.parametrize("reach, offset", [(0.4, 2.05), (0.9, 2.2), (2.5, 3.0), (2.5, 5.0)])
def test_grain_that_flies_past_is_not_touched(reach: float, offset: float) -> None:
    """A grain that misses another by `offset` - 2 radii keeps its velocity.

    The condition is linear in the velocity, with the normal at the start of the step: at the distance x along the path
    and d between the centres it is violated if reach > (d - 2) d / x. The smallest value of that over x is 0.46, 1.0,
    3.0 and more for the offsets here; a faster grain would be deflected.
    """
    material()
    other = grain((3.0, offset, 0))
    one = grain((0, 0, 0), velocity=(reach / H, 0, 0))
    equip(H, gravity=(0, 0, 0))
    steps(12)
    assert vec(state(one).vel) == pytest.approx([reach / H, 0, 0], abs=1e-12 / H)
    assert vec(state(other).vel) == pytest.approx([0, 0, 0], abs=1e-12 / H)
