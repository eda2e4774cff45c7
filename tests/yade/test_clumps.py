# SPDX-License-Identifier: GPL-2.0-or-later
"""Clumps: alone, on an incline, and put together and taken apart in mid-run."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3

from blocks import block
from contactdynamics import clumps
from scenes import G, ball_mass, cd, contact, dumbbell, equip, floor, grain, material, momentum, state, steps, vec

H = 1e-3


def set_spin(clump: int, spin) -> None:
    """Angular velocity of a clump, with the angular momentum that goes with it, and the velocities of its members."""
    s = state(clump)
    s.angVel = Vector3(*spin)
    own = s.ori.conjugate() * s.angVel
    s.angMom = s.ori * Vector3(*(vec(s.inertia) * vec(own)))


def test_clump_of_one_is_the_sphere() -> None:
    """Falling askew on a fixed ball and rolling on a floor: the same to round-off, which grows by the impacts."""
    tracks = []
    for clumped in (False, True):
        O.reset()
        material(friction=0.4)
        floor()
        grain((0, 0, 1), fixed=True)
        ball = grain((0.4, 0.1, 3.4))
        if clumped:
            ball = O.bodies.clump([ball])
        state(ball).vel, state(ball).angVel = Vector3(0.3, -0.2, 0.1), Vector3(1, 2, 3)
        equip(5e-3, tolerance=1e-12)
        track = []
        steps(300, lambda: track.append([*state(ball).pos, *state(ball).vel, *state(ball).angVel]))
        tracks.append(np.array(track))
    assert np.abs(tracks[0] - tracks[1]).max() <= 1e-11


@pytest.mark.parametrize("mu, slides", [(0.1, True), (0.5, False)])
def test_dumbbell_down_an_incline_along_its_axis(mu: float, slides: bool) -> None:
    """Two balls one behind the other cannot roll: g (sin - mu cos), or rest while tan < mu.

    The friction acts a radius below the mass centre, so the loads differ: with distance 2 a of the contacts, N2 - N1 = F r / a.
    """
    slope = 0.2
    material(friction=mu)
    floor()
    number, members = dumbbell([(0, 0, 1), (3, 0, 1)])
    equip(H, gravity=(G * math.sin(slope), 0, -G * math.cos(slope)), tolerance=1e-12, maxIterations=10000)
    steps(100)
    acceleration = G * (math.sin(slope) - mu * math.cos(slope)) if slides else 0
    assert state(number).vel[0] == pytest.approx(100 * H * acceleration, rel=1e-9, abs=1e-12)
    mass = 2 * ball_mass(1)
    friction = mass * (G * math.sin(slope) - acceleration)
    back, front = (contact(0, m).phys.normalForce.norm() for m in members)
    assert front + back == pytest.approx(mass * G * math.cos(slope), rel=1e-9)
    assert front - back == pytest.approx(friction / 1.5, rel=1e-8)


@pytest.mark.parametrize("mu, rolls", [(0.5, True), (0.02, False)])
def test_dumbbell_across_an_incline_rolls(mu: float, rolls: bool) -> None:
    """Two balls side by side roll as one about their common axis: g sin / (1 + I / m r^2) = 5/7 g sin while tan < 3.5 mu, else slides."""
    slope = 0.2
    material(friction=mu)
    floor()
    number, _ = dumbbell([(0, 0, 1), (0, 3, 1)])
    equip(H, gravity=(G * math.sin(slope), 0, -G * math.cos(slope)), tolerance=1e-12, maxIterations=10000)
    steps(100)
    expected = 5 / 7 * math.sin(slope) if rolls else math.sin(slope) - mu * math.cos(slope)
    # The clump is rotated exactly: the angular velocity that meets the floor is that before the turn of the step, an error of order h (see theory).
    assert state(number).vel[0] == pytest.approx(100 * H * G * expected, rel=1e-6)
    assert state(number).pos[2] == pytest.approx(1, abs=1e-8)


def flying(ends=((0, 0, 0), (2, 0.3, 0), (4, 1.2, 0))) -> tuple[int, list[int]]:
    """A clump that tumbles through empty space."""
    material()
    number, members = dumbbell(ends)
    state(number).vel = Vector3(1, 2, 3)
    set_spin(number, (0.3, 1.2, 0.5))
    equip(H, gravity=(0, 0, 0), tolerance=1e-12)
    steps(50)
    return number, members


def kept(before, after) -> None:
    """Momenta agree: sums of a few products, and in a flight of some steps the rotation of YADE's integrator, which keeps angMom exactly."""
    for one, other in zip(before, after):
        assert np.abs(one - other).max() <= 1e-12 * max(np.abs(before[0]).max(), np.abs(before[1]).max())


@pytest.mark.parametrize("how", ["release", "dissolve", "release from two"])
def test_clump_taken_apart_keeps_momentum(how: str) -> None:
    number, members = flying() if how != "release from two" else flying(((0, 0, 0), (2, 0.3, 0)))
    before = momentum()
    if how == "dissolve":
        assert clumps.dissolve(number) == sorted(members)
    else:
        clumps.release(members[0], number)
    assert O.bodies[members[0]].isStandalone
    kept(before, momentum())
    steps(1)
    # The parts leave each other along the tangent: contacts may open, none holds them together, and none has to push.
    steps(50)
    kept(before, momentum())
    assert cd().maxPenetration <= 1e-9


def test_clump_erased_by_yade_keeps_linear_momentum() -> None:
    """O.bodies.erase(clump, False): members fly on with the velocities of the last step."""
    number, members = flying()
    before = momentum()
    O.bodies.erase(number, False)
    after = momentum()
    assert after[0] == pytest.approx(before[0], rel=1e-12)
    steps(20)
    assert momentum()[0] == pytest.approx(before[0], rel=1e-12)


def test_joining_and_adding_keep_momentum() -> None:
    material()
    balls = [grain((2.1 * k, 0.2 * k, 0), velocity=(1 - k, 0.3 * k, 0.1), spin=(0.1 * k, 1, 0)) for k in range(3)]
    equip(H, gravity=(0, 0, 0), tolerance=1e-12)
    steps(3)
    before = momentum()
    number = clumps.join(balls[:2])
    kept(before, momentum())
    steps(5)
    kept(before, momentum())
    before = momentum()
    clumps.add(balls[2:], number)
    assert sorted(O.bodies[number].shape.members) == balls
    kept(before, momentum())
    steps(20)
    kept(before, momentum())


@pytest.mark.parametrize(
    "wrong, words",
    [
        (lambda n, m: clumps.release(m[0], m[1]), "no clump"),
        (lambda n, m: clumps.release(99, n), "99"),
        (lambda n, m: clumps.release(0, n), "#0"),
        (lambda n, m: clumps.dissolve(-1), "-1"),
        (lambda n, m: clumps.join([0]), "two"),
        (lambda n, m: clumps.join([0, m[0]]), "stand alone"),
        (lambda n, m: clumps.add([m[0]], n), "stand alone"),
    ],
)
def test_mistakes_are_named(wrong, words: str) -> None:
    material()
    grain((9, 0, 0))
    number, members = dumbbell([(0, 0, 0), (2, 0, 0), (4, 0, 0)])
    with pytest.raises(ValueError, match=words):
        wrong(number, members)
    assert sorted(O.bodies[number].shape.members) == members


def pile() -> list[int]:
    """Ten columns of four balls at rest, far from each other, with their forces in place."""
    material()
    floor()
    for k in range(10):
        for level in range(4):
            grain((5 * k - 20, 0, 1 + 2 * level))
    equip(H, tolerance=1e-10, maxIterations=100000)
    steps(5)
    return [b.id for b in O.bodies if b.dynamic]


def columns(but=()) -> None:
    """Every column but the given ones carries its weight, without a new search: warm start gives the solution in a sweep or two."""
    w = ball_mass(1) * G
    for k in range(10):
        if k in but:
            continue
        for level in range(4):
            i = contact(0 if level == 0 else 4 * k + level, 4 * k + level + 1)
            assert i is not None and i.phys.normalForce.norm() == pytest.approx((4 - level) * w, rel=1e-8), (k, level)


CHANGES = {
    "append": (lambda: grain((30, 5, 1)), ()),
    "append a clump": (lambda: dumbbell([(30, 5, 1), (33, 5, 1)]), ()),
    "erase the top of a column": (lambda: O.bodies.erase(4), (0,)),
    "erase the bottom of a column": (lambda: O.bodies.erase(1), (0,)),
    "erase and append": (lambda: (O.bodies.erase(40), grain((25, 0, 7))), (9,)),
    "clump a column": (lambda: O.bodies.clump([1, 2, 3, 4]), (0,)),
    "join a column": (lambda: clumps.join([1, 2, 3, 4]), (0,)),
    "clump and release": (lambda: O.bodies.releaseFromClump(4, O.bodies.clump([1, 2, 3, 4])), (0,)),
    "clump and erase with members": (lambda: O.bodies.erase(O.bodies.clump([1, 2, 3, 4]), True), (0,)),
    "clump, add": (lambda: O.bodies.addToClump([3, 4], O.bodies.clump([1, 2])), (0,)),
    "clump and erase a member": (lambda: (O.bodies.clump([1, 2, 3, 4]), O.bodies.erase(2)), (0,)),
    "erase an interaction": (lambda: O.interactions.erase(1, 2), (0,)),
    "erase all interactions": (lambda: O.interactions.clear(), ()),
}


@pytest.mark.parametrize("change", list(CHANGES))
def test_changes_in_mid_run_leave_the_rest_alone(change: str) -> None:
    """Whatever happens to one column (and to its neighbour's ids), the others carry their weight in the next step and after."""
    pile()
    do, but = CHANGES[change]
    do()
    O.step()
    columns(but)
    if change not in ("erase all interactions",):
        # The others start from their forces: only the changed column needs sweeps, and a column of four is solved in a few dozen from nothing.
        assert cd().iterations <= 200
    steps(5)
    columns(but)
    assert cd().converged
    for b in O.bodies:
        assert np.isfinite(vec(b.state.pos)).all()
    O.saveTmp()
    O.loadTmp()
    steps(2)
    columns(but)


def test_clumped_column_stands_as_one_body() -> None:
    """Contacts between the members vanish from the problem; released again, each carries what lies on it."""
    pile()
    number = O.bodies.clump([1, 2, 3, 4])
    steps(3)
    w = ball_mass(1) * G
    assert contact(0, 1).phys.normalForce.norm() == pytest.approx(4 * w, rel=1e-8)
    for k in (1, 2, 3):
        inner = contact(k, k + 1)
        assert inner is None or inner.phys.normalForce.norm() == 0
    assert clumps.dissolve(number) == [1, 2, 3, 4]
    steps(3)
    columns()


def test_blocks_clumped_released_erased_and_added() -> None:
    """A column of cubes that stands: after each change in mid-run the floor bears the weight of what is left, and nothing moves.

    The tolerance leaves 1e-10 of the speed that gravity gives in a step, H G, times the four cubes that a contact bears at most: less than 1e-12 m in all 180 steps.
    """
    material(0.5)
    floor(10)
    lower, second, third, upper = (block((0, 0, z)) for z in (0.5, 1.5, 2.5, 3.5))
    weight = state(lower).mass * G
    equip(H, tolerance=1e-10, maxIterations=5000)

    def stands(cubes: int) -> None:
        steps(30)
        assert -O.forces.f(0)[2] == pytest.approx(cubes * weight, rel=1e-8)
        for body in O.bodies:
            if body.dynamic and not body.isClump:
                assert abs(vec(body.state.pos)[:2]).max() < 1e-11 and abs(body.state.pos[2] % 1 - 0.5) < 1e-11, body.id

    stands(4)
    clump = O.bodies.clump([second, third, upper])
    stands(4)
    assert state(clump).mass == pytest.approx(3 * state(lower).mass, rel=1e-12)
    O.bodies.releaseFromClump(upper, clump)
    stands(4)
    O.bodies.erase(upper)
    stands(3)
    O.bodies.addToClump([block((0, 0, 3.5))], clump)
    stands(4)
    O.bodies.erase(clump, True)
    stands(1)


def test_hundred_random_changes() -> None:
    """Append, erase, clump and release at random in a heap: nothing crashes, nothing becomes infinite, momentum of the contacts balances."""
    generator = np.random.default_rng(8)
    material()
    floor()
    for k in range(30):
        grain((*generator.uniform(-3, 3, 2), 1.2 + 0.9 * k))
    equip(5e-3, tolerance=1e-4, onNonConvergence="ignore")
    for _ in range(100):
        alone = [b.id for b in O.bodies if b.isStandalone and b.dynamic]
        joined = [b.id for b in O.bodies if b.isClump]
        choice = generator.integers(5)
        if choice == 0 or len(alone) < 6:
            grain((*generator.uniform(-3, 3, 2), 14 + 3 * generator.random()))
        elif choice == 1:
            O.bodies.erase(int(generator.choice(alone)))
        elif choice == 2:
            clumps.join([int(k) for k in generator.choice(alone, 2, replace=False)])
        elif choice == 3 and joined:
            whole = int(generator.choice(joined))
            if generator.random() < 0.5:
                clumps.dissolve(whole)
            else:
                O.bodies.erase(whole, bool(generator.random() < 0.5))
        elif joined:
            clumps.add([int(generator.choice(alone))], int(generator.choice(joined)))
        steps(3)
        forces = np.array([vec(O.forces.f(b.id)) for b in O.bodies if not b.isClumpMember])
        assert np.isfinite(forces).all()
        assert np.abs(forces.sum(axis=0)).max() <= 1e-10 * max(1.0, np.abs(forces).max())
    assert all(np.isfinite(vec(b.state.pos)).all() and np.isfinite(vec(b.state.vel)).all() for b in O.bodies)
