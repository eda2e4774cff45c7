# SPDX-License-Identifier: GPL-2.0-or-later
"""Contacts with several points: every pair of shapes, the arrays, bits, errors, and what else in YADE meets them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import FrictMat, O, PolyhedraMat, Quaternion, Vector3, polyhedra_utils, utils

from blocks import block, corners, polyhedron
from contactdynamics import *  # noqa: F403
from scenes import EPS, G, box, cd, contact, contacts, engine, equip, floor, grain, isolated, law, material, state, steps, vec

H = 1e-3
TURN = Quaternion((0.3, 1, 0.2), 0.4)


def moving_box(position, half=(0.5, 0.5, 0.5), **more) -> int:
    return O.bodies.append(utils.box(Vector3(*position), Vector3(*half), fixed=False, material=O.materials[0], **more))


def fixed_box() -> int:
    """Upper face at z = 0, turned about z, so that nothing is aligned with the axes."""
    return O.bodies.append(utils.box((0, 0, -1), (5, 4, 1), orientation=Quaternion((0, 0, 1), 0.3), fixed=True, material=O.materials[0]))


def fixed_facet() -> int:
    return O.bodies.append(utils.facet([Vector3(-6, -5, 0), Vector3(7, -5, 0), Vector3(0, 8, 0)], fixed=True, material=O.materials[0]))


def fixed_block() -> int:
    return block((0, 0, -1), (5, 4, 1), fixed=True)


SUPPORTS = {
    "wall": lambda: O.bodies.append(utils.wall(0, 2, material=O.materials[0])),
    "box": fixed_box,
    "facet": fixed_facet,
    "polyhedron": fixed_block,
}
BODIES = {"polyhedron": block, "box": moving_box}


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("gap", [1e-3, 0.0, -1e-6])
def test_flat_on_every_support(support: str, body: str, gap: float) -> None:
    """Four points at the corners of the lower face, each with its gap; the normal points up to the body."""
    material()
    base = SUPPORTS[support]()
    cube = BODIES[body]((0.1, 0.2, 0.5 + gap))
    state(cube).vel = Vector3(0, 0, -2 * max(gap, 1e-3) / H)
    equip(H, gravity=(0, 0, 0), tolerance=1e-10)
    O.step()
    found = contact(base, cube)
    sign = 1 if found.id1 == base else -1
    assert type(found.geom).__name__ == "ManifoldGeom"
    assert np.abs(sign * vec(found.geom.normal) - [0, 0, 1]).max() < 1e-14
    assert len(found.geom.points) == len(found.geom.gaps) == len(found.geom.features) == len(found.phys.pointForces) == 4
    # Lengths are below 10: a hundred roundings.
    assert np.abs(np.array(found.geom.gaps) - gap).max() < 1e-13
    assert -found.geom.penetrationDepth == pytest.approx(gap, abs=1e-13)
    places = sorted(tuple(np.round(vec(p), 9)) for p in found.geom.points)
    expected = sorted((0.1 + x, 0.2 + y, round(gap / 2, 9)) for x in (-0.5, 0.5) for y in (-0.5, 0.5))
    assert np.abs(np.array(places) - expected).max() < 2e-9
    # What the law asks for: no approach beyond the gap.
    assert state(cube).pos[2] == pytest.approx(0.5 + min(gap, 0), abs=1e-9)


@pytest.mark.parametrize("gap", [0.3, 1e-6, -1e-4])
@pytest.mark.parametrize("where", ["face", "edge", "corner"])
def test_sphere_on_polyhedron(where: str, gap: float) -> None:
    """Nearest point in closed form on a turned cube."""
    material()
    cube = block((1, 2, 3), fixed=True, turn=TURN)
    local = {"face": [0.1, 0.2, 0.5], "edge": [0.1, 0.5, 0.5], "corner": [0.5, 0.5, 0.5]}[where]
    direction = {"face": [0, 0, 1], "edge": [0, 0.6, 0.8], "corner": [2 / 3, 1 / 3, 2 / 3]}[where]
    turn = TURN.toRotationMatrix()
    turn = np.array([[turn[i, j] for j in range(3)] for i in range(3)])
    nearest, direction = np.array([1.0, 2, 3]) + turn @ local, turn @ direction
    ball = grain(nearest + (0.5 + gap) * direction, radius=0.5, velocity=-direction * 2 * max(gap, 1e-3) / H)
    equip(H, gravity=(0, 0, 0))
    O.step()
    found = contact(ball, cube)
    assert (found.id1, found.id2) == (ball, cube)
    assert -found.geom.penetrationDepth == pytest.approx(gap, abs=1e-13)
    assert np.abs(vec(found.geom.normal) + direction).max() < 1e-11
    assert np.abs(vec(found.geom.contactPoint) - (nearest + 0.5 * gap * direction)).max() < 1e-12


def test_order_of_creation_does_not_matter() -> None:
    """The same two blocks with exchanged ids: the same contact with the opposite normal."""
    seen = []
    for exchanged in (False, True):
        O.reset()
        material()
        make = [lambda: block((0, 0, 0.5)), lambda: block((0.3, 0.1, 1.499999), turn=Quaternion((0, 0, 1), 0.5))]
        one, two = (make[k]() for k in ((1, 0) if exchanged else (0, 1)))
        low, high = (two, one) if exchanged else (one, two)
        O.bodies[low].state.blockedDOFs = "xyzXYZ"
        equip(H, tolerance=1e-10)
        O.step()
        found = contact(low, high)
        sign = 1 if found.id1 == low else -1
        seen.append((sign * vec(found.geom.normal), sorted(np.round(vec(p), 12).tolist() for p in found.geom.points), sign * vec(found.phys.normalForce)))
    assert np.abs(seen[0][0] - seen[1][0]).max() < 1e-14
    assert np.abs(np.array(seen[0][1]) - np.array(seen[1][1])).max() < 1e-12
    assert np.abs(seen[0][2] - seen[1][2]).max() < 1e-6 * seen[0][2].max()


def test_impulses_follow_a_sliding_block() -> None:
    """A block slides off the edge of another one: points come and go, but the solve goes on warm, and momentum obeys friction throughout."""
    mu = 0.2
    material(mu)
    block((0, 0, -0.5), (1, 1, 0.5), fixed=True)
    slider = block((0, 0.1, 0.1), (0.8, 0.4, 0.1))
    state(slider).vel = Vector3(0.8, 0, 0)
    equip(H, tolerance=1e-10)
    counts, before = [], set()
    for k in range(300):
        O.step()
        found = contact(0, slider)
        now = set(found.geom.features)
        if k > 3 and now == before:
            counts.append(cd().iterations)
        before = now
        assert state(slider).vel[0] == pytest.approx(0.8 - mu * G * H * (k + 1), abs=1e-8)
    assert len(found.geom.points) == 4
    # From nothing a block takes some tens of sweeps to 1e-10.
    assert np.median(counts) <= 5


def test_sums_and_readers() -> None:
    """Resultant in phys, its place in geom: YADE's stress from forces and contact points is the weight's."""
    material()
    base, cube = floor(10), block((0.3, 0, 0.5))
    equip(H, tolerance=1e-10)
    steps(20)
    found = contact(base, cube)
    forces = np.array([vec(f) for f in found.phys.pointForces])
    assert np.abs(forces.sum(axis=0) - vec(found.phys.normalForce + found.phys.shearForce)).max() < 1e-9 * G * state(cube).mass
    assert np.abs(np.array([vec(p) for p in found.phys.pointImpulses]) - H * forces).max() < 1e-9
    # Under the middle of the cube, where the resultant has to act.
    assert np.abs(vec(found.geom.contactPoint) - [0.3, 0, 0]).max() < 1e-8
    assert found.geom.refR2 == pytest.approx(0.5, abs=1e-8)
    # Love-Weber stress of all contacts: sigma_zz V = force x branch.
    assert O.forces.f(cube)[2] == pytest.approx(G * state(cube).mass, rel=1e-9)
    assert [type(p).__name__ for p in found.phys.pointPhys()] == ["ContactDynamicsPhys"] * 4
    assert utils.unbalancedForce() < 1e-8


def test_assigned_impulse_is_shared() -> None:
    """Each of the four points starts the solve with a quarter.

    Four normal forces at the corners of a square are not unique: + - + - around it adds neither force nor moment, so that any share of that is a
    solution, and the solve keeps the one it starts from. The points are given an uneven solution, then the weight is doubled and the impulse that
    bears it assigned: only quarters of that are a solution at once, and all four are equal only if the uneven start has been given up.
    """
    material()
    base, cube = floor(10), block((0, 0, 0.5))
    equip(H, gravity=(0, 0, 0), tolerance=1e-6)
    O.step()
    engine("NewtonIntegrator").gravity = Vector3(0, 0, -G)
    found = contact(base, cube)
    sign, weight = 1 if found.id2 == cube else -1, G * state(cube).mass
    uneven = [0.25 * H * weight * (1.6 if point[0] * point[1] > 0 else 0.4) for point in found.geom.points]
    for point, share in zip(found.phys.pointPhys(), uneven):
        point.impulse = Vector3(0, 0, sign * share)
    O.step()
    # Round-off: sums of twelve components that are differences of velocities of the size H g.
    exact = 100 * EPS * H * weight
    assert [sign * p[2] for p in found.phys.pointImpulses] == pytest.approx(uneven, abs=exact), "or an uneven share is no start that stays"
    O.forces.setPermF(cube, Vector3(0, 0, -weight))
    found.phys.impulse = Vector3(0, 0, sign * 2 * H * weight)
    O.step()
    assert cd().iterations <= 1
    for p in found.phys.pointImpulses:
        assert vec(p) == pytest.approx([0, 0, sign * 0.5 * H * weight], abs=exact)


def test_restitution_acts_at_each_point() -> None:
    """A cube dropped flat on all four points leaves with e times its speed; nothing turns."""
    law(normalRestitution=0.5)
    floor(10)
    cube = block((0, 0, 0.5 + 1e-4))
    state(cube).vel = Vector3(0, 0, -1)
    equip(H, gravity=(0, 0, 0), tolerance=1e-12)
    O.step()
    assert vec(state(cube).vel) == pytest.approx([0, 0, 0.5], abs=1e-9)
    assert vec(state(cube).angVel) == pytest.approx([0, 0, 0], abs=1e-9)


def test_box_without_thickness_is_a_plate() -> None:
    """As the walls of ``aabbWalls(thickness=0)``: a block lies on it at four points, from either side, and it cannot be a line."""
    material()
    plate = O.bodies.append(utils.box((0, 0, 0), (2, 2, 0), fixed=True, material=O.materials[0]))
    above, below = block((0, 0, 0.5)), block((0.1, 0, -0.5))
    for number in (above, below):
        state(number).vel = Vector3(0, 0, -1 if number == above else 1)
    equip(H, gravity=(0, 0, 0), tolerance=1e-10)
    O.step()
    for number in (above, below):
        assert len(contact(plate, number).geom.points) == 4
        assert state(number).vel.norm() < 1e-9
    O.bodies[plate].shape.extents = Vector3(2, 0, 0)
    with pytest.raises(RuntimeError, match="half edges are.*one may be zero"):
        O.step()


def test_cohesion_of_the_pair_is_shared_by_its_points() -> None:
    """The pull-off force of the pair holds, whatever the number of points."""
    strength = 500.0
    law(cohesionForce=strength)
    base, cube = floor(10), block((0, 0, 0.5))
    equip(H, gravity=(0, 0, 0), tolerance=1e-10)
    O.step()
    O.forces.setPermF(cube, Vector3(0, 0, 0.999 * strength))
    steps(5)
    assert contact(base, cube).phys.bond == "intact" and state(cube).vel.norm() < 1e-9
    O.forces.setPermF(cube, Vector3(0, 0, 1.001 * strength))
    steps(3)
    assert state(cube).vel[2] > 0


def test_materials_mix() -> None:
    """PolyhedraMat is a FrictMat; beside a ContactDynamicsMat the latter's laws count."""
    stone = O.materials.append(PolyhedraMat(density=2000, frictionAngle=math.atan(0.3), young=1e9))
    base = floor(10, material=O.materials[O.materials.append(FrictMat(frictionAngle=math.atan(0.7)))])
    cube = block((0, 0, 0.5), material=O.materials[stone])
    bouncy = O.materials[O.materials.append(ContactDynamicsMat(normalRestitution=0.4, frictionAngle=math.atan(0.9)))]
    other = O.bodies.append(utils.box((20, 0, -1), (5, 5, 1), fixed=True, material=bouncy))
    second = block((20, 0, 0.5), material=O.materials[stone])
    equip(H)
    O.step()
    assert contact(base, cube).phys.tangensOfFrictionAngle == pytest.approx(0.3)
    assert contact(other, second).phys.normalRestitution == 0.4
    assert contact(other, second).phys.tangensOfFrictionAngle == pytest.approx(0.3)


def test_clump_of_blocks_rests() -> None:
    """Two cubes clumped into a bar stand on eight points of two contacts and weigh what they weigh."""
    material()
    floor(10)
    cubes = [polyhedra_utils.polyhedra(O.materials[0], v=[corner + Vector3(x, 0, 0.5) for corner in corners((0.5, 0.5, 0.5))]) for x in (0, 1)]
    clump, members = O.bodies.appendClumped(cubes)
    equip(H, tolerance=1e-8)
    steps(50)
    total = sum(contact(0, m).phys.normalForce[2] * (1 if contact(0, m).id2 == m else -1) for m in members)
    assert total == pytest.approx(state(clump).mass * G, rel=1e-6)
    assert state(clump).vel.norm() < 1e-7


def test_fixed_bodies_make_no_contact() -> None:
    material()
    floor(10)
    O.bodies.append(utils.box((0, 10, 0), (10, 1, 10), fixed=True, material=O.materials[0]))
    fixed_block()
    equip(H)
    steps(2)
    assert contacts() == []


def test_exact_rotation_predicts_angular_momentum() -> None:
    """A tumbling irregular body hits the floor: the integrator arrives at the predicted angular momentum."""
    material()
    floor(10)
    body = polyhedron([(0, 0, 0), (1.2, 0, 0), (0.2, 0.9, 0), (0.4, 0.3, 0.8), (0.7, 0.6, 0.5)], (0, 0, 0.7))
    state(body).vel, state(body).angMom = Vector3(0.2, 0, -1), Vector3(30, -10, 20)
    equip(H)
    touched = 0
    for _ in range(400):
        O.step()
        predicted = cd().predictedAngularMomenta()[body]
        assert np.abs(vec(predicted) - vec(state(body).angMom)).max() <= 1e-12 * (1 + vec(predicted).max() + 100)
        touched += cd().activeContacts > 0
    assert touched > 10


def test_periodic_neighbours_meet() -> None:
    """Two cubes face to face across the boundary of the cell push each other apart with opposite forces."""
    O.periodic = True
    O.cell.setBox(4, 4, 4)
    material()
    one, two = block((0.5, 2, 2)), block((3.5 + 1e-4, 2, 2))
    state(one).vel = Vector3(-1, 0, 0)
    equip(H, gravity=(0, 0, 0), tolerance=1e-10)
    O.step()
    found = contact(one, two)
    assert found is not None and len(found.geom.points) == 4
    # Perfectly inelastic: both move on with the mean velocity.
    steps(1)
    assert state(one).vel[0] == pytest.approx(-0.5, abs=1e-8) and state(two).vel[0] == pytest.approx(-0.5, abs=1e-8)


def test_same_bits_with_threads_and_across_saving(tmp_path) -> None:
    texts = []
    isolated("yade", "manifold_cases", "prepare", tmp_path / "start.yade.gz")
    for threads in (1, 2):
        isolated("yade", "manifold_cases", "straight", tmp_path / "start.yade.gz", tmp_path / "straight", threads=threads)
        texts.append((tmp_path / "straight").read_text())
    isolated("yade", "manifold_cases", "halves", tmp_path / "start.yade.gz", tmp_path / "half.yade.gz", tmp_path / "halves", threads=2)
    texts.append((tmp_path / "halves").read_text())
    assert texts[0].count("\n") > 60
    assert texts[1] == texts[0] and texts[2] == texts[0]


def test_shapes_like_those_of_scenes_that_are_gone() -> None:
    """What is known of a shape may be that of a former one at the same address with the same size; the table is cleared when new shapes fill it."""
    for scene in range(120):
        O.reset()
        material()
        upper = []
        for k in range(20):
            box((2 * k, 0, 0), (0.5, 0.5, 0.5))
            upper.append(block((2 * k, 0, 1), (0.5, 0.5, 0.5 + 1e-6 * (20 * scene + k))))
        equip(H)
        steps(2)
        assert max(abs(state(n).pos[2] - 1) for n in upper) < 1e-3, scene


@pytest.mark.parametrize("spoil", ["empty", "flat", "nan"])
def test_bad_polyhedron_is_named(spoil: str) -> None:
    material()
    floor(10)
    cube = block((0, 0, 0.5))
    equip(H)
    steps(2)
    shape = O.bodies[cube].shape
    good = shape.v
    shape.v = {"empty": [], "flat": [Vector3(x, y, 0) for x in (0, 1) for y in (0, 1)], "nan": [Vector3(math.nan, 0, 0)] + list(good[1:])}[spoil]
    with pytest.raises(RuntimeError, match=rf"body #{cube}.*Polyhedra\.v"):
        O.step()
    shape.v = good
    steps(10)
    assert contact(0, cube) is not None and cd().converged


def test_bad_box_is_named() -> None:
    material()
    floor(10)
    wide = moving_box((0, 0, 0.5))
    equip(H)
    steps(2)
    O.bodies[wide].shape.extents = Vector3(0.5, -1, 0.5)
    with pytest.raises(RuntimeError, match=rf"body #{wide}: Box\.extents"):
        O.step()
