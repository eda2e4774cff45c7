# SPDX-License-Identifier: GPL-2.0-or-later
"""Candidates at a positive gap: the geometry of each pair of shapes against distances computed here."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Quaternion, Vector3, utils

from distances import nearest_on_box, nearest_on_triangle
from scenes import EPS, active, box, cd, contact, equip, floor, grain, material, rotation, state, steps, vec

H = 1e-3
TRIANGLE = np.array([[0.0, 0, 0], [6, 1, 0.5], [1, 5, 1]])


def facet(corners, **more) -> int:
    more.setdefault("material", O.materials[0])
    return O.bodies.append(utils.facet([Vector3(*c) for c in corners], **more))


def wall(position: float, axis: int = 2, sense: int = 0) -> int:
    return O.bodies.append(utils.wall(position, axis, sense=sense, material=O.materials[0]))


def approach(target: int, nearest: np.ndarray, direction: np.ndarray, gap: float, radius: float = 0.5):
    """A sphere at `gap` from the point `nearest` of `target`, moving there; returns (sphere, contact, gap, normal)."""
    center = nearest + (radius + gap) * direction
    ball = grain(center, radius=radius, velocity=-direction * 2 * max(gap, 1e-3) / H)
    O.step()
    return ball, contact(target, ball), direction


def check(target: int, found, gap: float, direction: np.ndarray, nearest: np.ndarray) -> None:
    """Gap, normal from the target to the sphere, and a contact point between both surfaces."""
    ball, i, _ = found
    assert i is not None, f"no candidate at a gap of {gap}"
    g = i.geom
    assert (i.id1, i.id2) == (target, ball)
    # Lengths are below 10 m: about a hundred roundings of 1e-15 m.
    assert -g.penetrationDepth == pytest.approx(gap, abs=1e-13)
    assert i.phys.gap == pytest.approx(gap, abs=1e-13)
    # The normal is a difference of points divided by its length, which is at least the radius less the overlap.
    assert np.abs(vec(g.normal) - direction).max() <= 1e-12
    along = (vec(g.contactPoint) - nearest) @ direction
    assert -1e-12 + min(0, gap) <= along <= max(0, gap) + 1e-12
    assert np.linalg.norm(vec(g.contactPoint) - nearest - along * direction) <= 1e-12


GAPS = [0.4, 0.05, 1e-6, -1e-4]


@pytest.mark.parametrize("gap", GAPS)
def test_sphere_sphere(gap: float) -> None:
    material()
    first = grain((1, 2, 3), radius=0.8, fixed=True)
    direction = np.array([2.0, -1, 2]) / 3
    nearest = np.array([1.0, 2, 3]) + 0.8 * direction
    equip(H, gravity=(0, 0, 0))
    check(first, approach(first, nearest, direction, gap), gap, direction, nearest)


@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("place", [(0.3, -0.4, 3), (0.3, 4, 4), (-4, 0.2, -5), (4, 4, 4), (-4, 4, -4), (5, 0.1, 0.1)])
def test_sphere_box(gap: float, place) -> None:
    """Faces, edges and corners of a turned box; `place` is where the sphere comes from, in the axes of the box."""
    material()
    target = box((1, 1, 1), (1, 1.5, 2), orientation=Quaternion(Vector3(1, 2, 3).normalized(), 0.7))
    r, half = rotation(target), np.array([1, 1.5, 2])
    far = np.array([1.0, 1, 1]) + r @ np.array(place, dtype=float)
    nearest = nearest_on_box(far, np.array([1.0, 1, 1]), half, r)
    direction = (far - nearest) / np.linalg.norm(far - nearest)
    equip(H, gravity=(0, 0, 0))
    check(target, approach(target, nearest, direction, gap), gap, direction, nearest)


@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_sphere_wall(gap: float, side: int, axis: int) -> None:
    material()
    target = wall(0.7, axis)
    nearest = np.array([1.3, -2.2, 3.1])
    nearest[axis] = 0.7
    direction = np.eye(3)[axis] * side
    equip(H, gravity=(0, 0, 0))
    check(target, approach(target, nearest, direction, gap), gap, direction, nearest)


@pytest.mark.parametrize("sense, side, seen", [(1, 1, True), (-1, -1, True), (1, -1, False), (-1, 1, False)])
def test_sphere_wall_with_one_side(sense: int, side: int, seen: bool) -> None:
    """A wall with a sense holds what is on that side; a sphere wholly behind it is no candidate, however fast it comes, and flies on."""
    material()
    target = wall(0, 2, sense)
    nearest, direction = np.zeros(3), np.array([0.0, 0, side])
    equip(H, gravity=(0, 0, 0))
    found = ball, i, _ = approach(target, nearest, direction, 0.1)
    if seen:
        check(target, found, 0.1, direction, nearest)
    else:
        assert i is None and cd().contacts == 0
        assert vec(state(ball).vel) == pytest.approx(-direction * 2 * 0.1 / H, abs=0)


@pytest.mark.parametrize("sense", [1, -1])
def test_sphere_partly_through_a_wall_with_one_side(sense: int) -> None:
    """The centre is behind, but not all of the sphere: the contact pushes to the side that the wall acts on, out of an overlap of 0.9 diameters."""
    material()
    target = wall(0, 2, sense)
    direction = np.array([0.0, 0, sense])
    ball = grain(-0.4 * direction, radius=0.5, velocity=-direction)
    equip(H, gravity=(0, 0, 0), repairRate=0)
    O.step()
    i = contact(target, ball)
    assert vec(i.geom.normal) == pytest.approx(direction, abs=0)
    assert i.phys.gap == pytest.approx(-0.9, abs=1e-13)
    assert vec(state(ball).vel) == pytest.approx([0, 0, 0], abs=2 * EPS)


PLACES = {
    "face from above": (1.9, 0.4, 9.2),
    "face from below": (2.8, 3.6, -8.2),
    "edge a-b": (3, -6, 1),
    "edge b-c": (9, 9, 2),
    "edge c-a": (-6, 4, 3),
    "vertex a": (-6, -5, -2),
    "vertex b": (15, -1, 1),
    "vertex c": (-2, 15, 2),
}


@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("place", list(PLACES))
def test_sphere_facet(gap: float, place: str) -> None:
    """Face (both sides), edges and vertices of one triangle in general position."""
    material()
    target = facet(TRIANGLE)
    far = np.array(PLACES[place], dtype=float)
    nearest = nearest_on_triangle(far, TRIANGLE)
    direction = (far - nearest) / np.linalg.norm(far - nearest)
    equip(H, gravity=(0, 0, 0))
    check(target, approach(target, nearest, direction, gap), gap, direction, nearest)


def test_sphere_facet_many_places() -> None:
    """Random places around the triangle, near and far, against the nearest point computed here."""
    generator = np.random.default_rng(7)
    material()
    target = facet(TRIANGLE)
    balls = {}
    for _ in range(200):
        far = generator.uniform([-3, -3, -4], [9, 8, 5])
        nearest = nearest_on_triangle(far, TRIANGLE)
        direction = (far - nearest) / np.linalg.norm(far - nearest)
        gap = 10 ** generator.uniform(-6, -1)
        radius = generator.uniform(0.05, 2)
        ball = grain(nearest + (radius + gap) * direction, radius=radius, velocity=-2 * gap / H * direction, mask=3)
        balls[ball] = (nearest, direction, gap)
    equip(H, gravity=(0, 0, 0))
    # The spheres overlap each other, which does not matter here: bodies that share bit 2 with each other do not meet.
    collider = next(e for e in O.engines if type(e).__name__ == "InsertionSortCollider")
    collider.avoidSelfInteractionMask = 2
    O.step()
    for ball, (nearest, direction, gap) in balls.items():
        check(target, (ball, contact(target, ball), direction), gap, direction, nearest)


@pytest.mark.parametrize("kind", ["box", "wall", "facet", "sphere"])
def test_far_bodies_are_no_candidates(kind: str) -> None:
    """What cannot be reached within a step costs nothing."""
    material()
    _target(kind)
    grain((0.1, 0.1, 5), radius=0.5, velocity=(0, 0, -1))
    equip(H)
    steps(2)
    assert cd().contacts == 0


def _target(kind: str) -> int:
    """A body with its highest point at z = 0, at rest."""
    if kind == "box":
        return floor()
    if kind == "wall":
        return wall(0)
    if kind == "facet":
        return facet([(-50, -40, 0), (50, -40, 0), (0, 60, 0)])
    return grain((0.1, 0.1, -1), radius=1, fixed=True)


@pytest.mark.parametrize("kind", ["box", "wall", "facet", "sphere"])
def test_first_contact_is_before_the_first_overlap(kind: str) -> None:
    """A falling ball is stopped at the surface, not inside: U_N = -g/h closes the gap exactly."""
    material()
    _target(kind)
    ball = grain((0.1, 0.1, 0.7), radius=0.5)
    equip(5e-3)
    lowest = []
    steps(120, lambda: lowest.append(state(ball).pos[2]))
    # One closed-form contact: z changes by roundings of z/h * h only, a few 1e-16 per step.
    assert min(lowest) >= 0.5 - 1e-13
    assert lowest[-1] == pytest.approx(0.5, abs=1e-13)
    assert len(active()) == 1


def mesh(size: float, cells: int) -> list[int]:
    """A flat square of triangles in the plane z = 0, with diagonals in both directions."""
    ids, d = [], size / cells
    for i in range(cells):
        for j in range(cells):
            x, y = -size / 2 + i * d, -size / 2 + j * d
            a, b, c, e = (x, y, 0), (x + d, y, 0), (x + d, y + d, 0), (x, y + d, 0)
            pair = ((a, b, c), (a, c, e)) if (i + j) % 2 else ((a, b, e), (b, c, e))
            ids += [facet(corners) for corners in pair]
    return ids


@pytest.mark.parametrize("place", [(0, 0), (1, 0), (0.5, 0.5), (0.5, 0.25), (1e-7, 0), (0.999, 1.001)])
def test_ball_at_rest_on_a_flat_mesh_has_one_contact(place) -> None:
    """On vertices, on edges, beside them and inside of triangles: one reaction, the weight."""
    material()
    mesh(8, 8)
    ball = grain((*place, 1))
    equip(H, tolerance=1e-12, maxIterations=10000)
    steps(5)
    pushes = [i for i in active() if i.phys.impulse.norm() > 1e-9 * state(ball).mass * 9.81 * H]
    assert len(pushes) == 1, [(i.id1, vec(i.geom.normal), vec(i.phys.impulse)) for i in pushes]
    assert cd().contacts == 1
    force = vec(O.forces.f(ball))
    assert force == pytest.approx([0, 0, state(ball).mass * 9.81], rel=1e-10, abs=1e-6)
    assert abs(state(ball).pos[2] - 1) <= 1e-12


@pytest.mark.parametrize("speed", [0.5, 3.0, 40.0])
@pytest.mark.parametrize("heading", [(1, 0), (1, 0.37), (1, 1)])
def test_ball_rolls_over_a_mesh_as_over_a_box(speed: float, heading) -> None:
    """Sliding first, then rolling, across many edges and vertices; slow, and several cells a step.

    Both runs solve the same one-contact problem in every step, apart from roundings. With a solver tolerance of 1e-12
    each step may differ by 1e-12 of the impulse's velocity mu g h, and the differences add up over the steps.
    """
    number, size = 150, 40.0
    direction = np.array([heading[0], heading[1]]) / math.hypot(*heading)
    h = 5e-3
    start = -0.45 * size * direction if speed * h * number < size else -0.5 * speed * h * number * direction
    tracks = {}
    for kind in ("box", "mesh"):
        O.reset()
        material(friction=0.3)
        if kind == "box":
            floor()
        else:
            mesh(max(size, 2.2 * np.abs(start).max()), 20)
        ball = grain((*start, 1), velocity=(*(speed * direction), 0))
        equip(h, tolerance=1e-12, maxIterations=10000)
        track = []
        for _ in range(number):
            O.step()
            s = state(ball)
            track.append([*s.pos, *s.vel, *s.angVel])
        tracks[kind] = np.array(track)
    difference = np.abs(tracks["box"] - tracks["mesh"]).max()
    assert difference <= 1e-9 * max(1.0, speed), f"largest difference {difference}"
    assert np.abs(tracks["mesh"][:, 2] - 1).max() <= 1e-11


def test_ridge_of_two_facets_carries_a_ball_on_its_edge() -> None:
    """On a convex edge the normal points from the edge to the centre, whichever facet it is taken from."""
    material()
    facet([(0, -20, 0), (0, 20, 0), (-20, 0, -10)])
    facet([(0, -20, 0), (0, 20, 0), (20, 0, -10)])
    ball = grain((0, 0, 1))
    equip(H, tolerance=1e-12, maxIterations=10000)
    steps(10)
    assert vec(O.forces.f(ball)) == pytest.approx([0, 0, state(ball).mass * 9.81], rel=1e-9, abs=1e-6)
    assert abs(state(ball).pos[2] - 1) <= 1e-11


def test_valley_of_two_facets_has_two_contacts() -> None:
    """A concave edge is no shared edge of a flat mesh: the ball leans on both sides.

    Statics without friction: slopes of 45 degrees carry m g / sqrt(2) each.
    """
    material(friction=0)
    facet([(0, -20, 0), (0, 20, 0), (-20, 0, 20)])
    facet([(0, -20, 0), (0, 20, 0), (20, 0, 20)])
    ball = grain((0, 0, math.sqrt(2)))
    equip(H, tolerance=1e-12, maxIterations=10000)
    steps(5)
    pushes = sorted(i.phys.normalForce.norm() for i in active())
    assert pushes == pytest.approx([state(ball).mass * 9.81 / math.sqrt(2)] * 2, rel=1e-9)


def test_overlapping_facets_of_two_planes_are_both_kept() -> None:
    """A ball in a corner of a floor and a wall made of facets touches both."""
    material(friction=0)
    facet([(0, -20, 0), (0, 20, 0), (20, 0, 0)])
    facet([(0, -20, 0), (0, 20, 0), (0, 0, 20)])
    ball = grain((1, 0, 1))
    equip(H, gravity=(-3, 0, -9.81), tolerance=1e-12, maxIterations=10000)
    steps(5)
    assert vec(O.forces.f(ball)) == pytest.approx(state(ball).mass * np.array([3, 0, 9.81]), rel=1e-9, abs=1e-6)
