# SPDX-License-Identifier: GPL-2.0-or-later
"""Balls on and in meshes of facets and tiles of boxes: seams are not felt where the surface is flat, and hold where it is hollow."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Quaternion, Vector3, geom, utils, ymport

from blocks import block
from distances import nearest_on_triangle
from scenes import G, box, cd, contacts, equip, floor, grain, material, state, steps, vec
from test_detection import facet

R, RADIUS = 1.0, 0.05


def drum(segments: int) -> float:
    """A polygonal cylinder about the y axis, circumscribed radius R, long and open; returns the turn from a side to the next."""
    upright = Quaternion(Vector3(1, 0, 0), math.pi / 2)
    O.bodies.append(geom.facetCylinder((0, 0, 0), R, 4, orientation=upright, segmentsNumber=segments, wallMask=4, material=O.materials[0]))
    return 2 * math.pi / segments


@pytest.mark.parametrize("segments", [24, 72, 200])
@pytest.mark.parametrize("stride", [0.1, 0.3, 0.9])
def test_ball_slides_round_in_a_polygon(segments: int, stride: float) -> None:
    """Without friction and weight each edge takes the momentum across the next side: v cos(turn)^n after n edges, exactly.

    The step that reaches an edge goes as far as the next side allows, the one after it turns into that side; both together keep the
    velocity along it.
    `stride` is the way of a step in sides of the polygon of centres, below 1 so that no step takes two corners. No impulse exceeds
    m v sin(turn), no side is entered, and nothing happens between edges.
    """
    material(friction=0)
    turn = drum(segments)
    side = 2 * (R * math.cos(turn / 2) - RADIUS) * math.tan(turn / 2)
    # On one of the lowest sides, whose middle is where the perpendicular from the axis meets it.
    lowest = min(range(0, 2 * segments, 2), key=lambda k: vec(state(k).pos)[2])
    normal = vec(state(lowest).ori * O.bodies[lowest].shape.normal)
    normal *= -np.sign(normal @ vec(state(lowest).pos))
    ball = grain((R * math.cos(turn / 2) - RADIUS) * -normal + [0, 0.13, 0], radius=RADIUS)
    along = np.array([-normal[2], 0, normal[0]])
    state(ball).vel = Vector3(*along)
    # Nothing presses the ball on the wall between edges: then the residual is a ratio of roundings.
    equip(stride * side, gravity=(0, 0, 0), tolerance=1e-10, maxIterations=1000, onNonConvergence="ignore")
    mass, farthest, angle, quiet = state(ball).mass, 0.0, 0.0, 0
    for _ in range(int(30 / stride)):
        before, place = vec(state(ball).vel), vec(state(ball).pos)
        O.step()
        p, v = vec(state(ball).pos), np.linalg.norm(vec(state(ball).vel))
        angle += math.atan2(np.cross(place, p)[1], place @ p)
        farthest = max(farthest, math.hypot(p[0], p[2]))
        impulse = sum(i.phys.impulse.norm() for i in contacts())
        assert impulse <= mass * np.linalg.norm(before) * math.sin(turn) * (1 + 1e-9)
        if stride > 0.5:  # an edge may be reached before the turn at the last one is complete: then the two are taken as one
            continue
        turns = math.log(v) / math.log(math.cos(turn))  # as many as edges, and a part of one in the step in which an edge is reached
        assert abs(turns - abs(angle) / turn) <= 2
        if impulse <= 1e-12 * mass:
            quiet += 1
            assert abs(turns - round(turns)) * turn**2 / 2 <= 1e-10
    assert abs(angle) > 8 * turn or stride > 0.5
    assert quiet > 0 or stride > 0.5
    # The farthest place without overlap is a corner of the polygon of centres.
    assert farthest <= (R * math.cos(turn / 2) - RADIUS) / math.cos(turn / 2) + 1e-12


def terrain(cells: int, size: float, height: float, seed: int) -> np.ndarray:
    """A square of triangles with random heights and diagonals; returns their corners."""
    generator = np.random.default_rng(seed)
    z = generator.uniform(-height, height, (cells + 1, cells + 1))
    d = size / cells
    triangles = []
    for i in range(cells):
        for j in range(cells):
            a, b, c, e = ((k * d - size / 2, m * d - size / 2, z[k, m]) for k, m in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            triangles += [(a, b, c), (a, c, e)] if generator.random() < 0.5 else [(a, b, e), (b, c, e)]
    for corners in triangles:
        facet(corners)
    return np.array(triangles)


@pytest.mark.parametrize("height", [0.0, 0.05, 0.3, 1.0])
@pytest.mark.parametrize("radius", [0.1, 0.3])
def test_fast_balls_do_not_enter_a_random_terrain(height: float, radius: float) -> None:
    """Kicked again and again in random directions, many of them grazing, by up to one edge of the mesh a step; solved to 1e-8.

    Overlaps come from the residual only: 1e-8 of an impulse that stops a whole way of a step, times the number of contacts a ball may have (a dozen).
    """
    generator = np.random.default_rng(11)
    material(friction=0.4)
    terrain(8, 8.0, height, 5)
    for axis in (0, 1):
        for side in (-1, 1):
            O.bodies.append(utils.wall(3.9 * side, axis, material=O.materials[0]))
    O.bodies.append(utils.wall(6, 2, material=O.materials[0]))
    balls = [grain((*generator.uniform(-3, 3, 2), 1.4 + height + 0.3 * k), radius=radius) for k in range(8)]
    h = 2e-3
    equip(h, tolerance=1e-8, maxIterations=10000)
    for turn in range(40):
        for ball in balls:
            way = generator.normal(size=3)
            way[2] = -abs(way[2]) * generator.choice([1, 0.1, 0.01, -1])
            state(ball).vel = Vector3(*(generator.uniform(0.2, 1) / h * way / np.linalg.norm(way)))
        steps(6)
        assert cd().converged
        assert cd().maxPenetration <= 12 * 1e-8 * 1.0 * 6, f"kick {turn}"
    for ball in balls:
        p = vec(state(ball).pos)
        assert np.abs(p[:2]).max() <= 3.9 and -height <= p[2] <= 6


def tiles(kind: str) -> None:
    """A floor at z = 0 from x = -20 to 20: one box, boxes or polyhedra side by side, boxes and facets or polyhedra in turn, boxes on a wall, or facets with shifted rows."""
    if kind == "one box":
        floor(20)
    for k in range(-20, 20):
        if kind == "polyhedra" or (kind == "boxes and polyhedra" and k % 2 == 0):
            block((k + 0.5, 0, -1), (0.5, 5, 1), fixed=True)
        if kind == "boxes" or (kind.startswith("boxes and") and k % 2):
            box((k + 0.5, 0, -1), (0.5, 5, 1))
        if kind == "boxes and facets" and k % 2 == 0:
            facet(((k, -5, 0), (k + 1, -5, 0), (k + 1, 5, 0)))
            facet(((k, -5, 0), (k + 1, 5, 0), (k, 5, 0)))
        if kind == "corners on edges":  # the corners of a row lie in the middle of the edges of the next one, in single precision
            for row, shift in enumerate((0, 1 / 3, 2 / 3)):
                x, x2 = (float(np.float32(k + n + shift)) for n in (0, 1))
                y, y2 = (float(np.float32(0.7 * (row + n) - 1)) for n in (0, 1))
                facet(((x, y, 0), (x2, y, 0), (x2, y2, 0)))
                facet(((x, y, 0), (x2, y2, 0), (x, y2, 0)))
    if kind == "box on a wall":
        O.bodies.append(utils.wall(0, 2, material=O.materials[0]))
        box((5, 0, -1), (3, 5, 1))


@pytest.mark.parametrize("stride", [0.005, 0.3])
@pytest.mark.parametrize("kind", ["boxes", "boxes and facets", "polyhedra", "boxes and polyhedra", "box on a wall", "corners on edges"])
def test_tiles_are_one_floor(kind: str, stride: float) -> None:
    """A ball that slides and then rolls over the joints keeps, but for roundings, the motion that it has on one box."""
    h, number, tracks = 5e-3, 60 if stride > 0.1 else 600, {}
    for floor_kind in ("one box", kind):
        O.reset()
        material(friction=0.3)
        tiles(floor_kind)
        ball = grain((-9, 0.2, 1), velocity=(stride / h, 0.02 * stride / h, 0))
        equip(h, tolerance=1e-12, maxIterations=10000)
        track = []
        steps(number, lambda: track.append([*state(ball).pos, *state(ball).vel, *state(ball).angVel]))
        tracks[floor_kind] = np.array(track)
    difference = np.abs(tracks["one box"] - tracks[kind]).max()
    assert difference <= 1e-9 * max(1, stride / h), f"largest difference {difference}"


@pytest.mark.parametrize("speed", [0.5, 20.0])
def test_ramp_of_facets_on_a_floor(speed: float) -> None:
    """Without friction a ball turns from a floor into a slope of 30 degrees: v cos 30 once, wherever in a step it meets the edge."""
    material(friction=0)
    facet(((-40, -9, 0), (0, -9, 0), (0, 9, 0)))
    facet(((-40, -9, 0), (0, 9, 0), (-40, 9, 0)))
    up, out = 40 * math.tan(math.pi / 6), 40.0
    facet(((0, -9, 0), (out, -9, up), (out, 9, up)))
    facet(((0, -9, 0), (out, 9, up), (0, 9, 0)))
    ball = grain((-1.5, 0.3, 1), velocity=(speed, 0, 0))
    h = 5e-3
    equip(h, gravity=(0, 0, 0), tolerance=1e-12, maxIterations=20, onNonConvergence="ignore")
    steps(int(3 / (speed * h)) + 2)
    assert vec(state(ball).vel) == pytest.approx(speed * math.cos(math.pi / 6) * np.array([math.cos(math.pi / 6), 0, 0.5]), abs=1e-10 * speed)
    slope = np.array([-0.5, 0, math.cos(math.pi / 6)])
    assert slope @ vec(state(ball).pos) == pytest.approx(1, abs=1e-11)


SHELLS = {
    "facetBox": lambda m: geom.facetBox((0, 0, 0), (1, 1.2, 0.8), orientation=Quaternion(Vector3(1, 2, 3).normalized(), 0.5), material=m),
    "facetParallelepiped": lambda m: geom.facetParallelepiped((0, 0, 0), (1, 1, 1), height=0.9, material=m),
    "facetCylinder": lambda m: geom.facetCylinder((0, 0, 0), 1, 2, segmentsNumber=16, material=m),
    "facetCone": lambda m: geom.facetCone((0, 0, 0), 0.3, 1.2, 2, segmentsNumber=16, material=m),
    "facetSphere": lambda m: geom.facetSphere((0, 0, 0), 1.2, thetaResolution=8, phiResolution=8, material=m),
    "stl": lambda m: _through_a_file(geom.facetSphere((0, 0, 0), 1.2, thetaResolution=12, phiResolution=8, material=m), m),
}


def _through_a_file(facets: list, m) -> list:
    """Facets written as a text STL in single precision and read again by YADE."""
    import os
    import tempfile

    lines = ["solid shell"]
    for body in facets:
        corners = [body.state.pos + body.state.ori * v for v in body.shape.vertices]
        lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {c[0]:.7e} {c[1]:.7e} {c[2]:.7e}" for c in corners), "endloop", "endfacet"]
    with tempfile.NamedTemporaryFile("w", suffix=".stl", delete=False) as file:
        file.write("\n".join([*lines, "endsolid shell"]) + "\n")
    try:
        return ymport.stl(file.name, material=m)
    finally:
        os.unlink(file.name)


@pytest.mark.parametrize("shell", list(SHELLS))
def test_shells_hold_what_flies_in_them(shell: str) -> None:
    """Twenty balls in a closed shell that is shaken by kicks and turning gravity: none gets out, and none overlaps a facet."""
    generator = np.random.default_rng(4)
    material(friction=0.3)
    ids = O.bodies.append(SHELLS[shell](O.materials[0]))
    balls = [grain(0.3 * generator.uniform(-1, 1, 3) * [1, 1, 1], radius=0.06, mask=3) for _ in range(20)]
    h = 2e-3
    equip(h, tolerance=1e-8, maxIterations=10000)
    # The balls start on top of each other, so they do not meet: only the shell matters here.
    next(e for e in O.engines if type(e).__name__ == "InsertionSortCollider").avoidSelfInteractionMask = 2
    newton = next(e for e in O.engines if type(e).__name__ == "NewtonIntegrator")
    for _ in range(25):
        newton.gravity = Vector3(*(40 * generator.normal(size=3)))
        for ball in balls:
            way = generator.normal(size=3)
            state(ball).vel = Vector3(*(generator.uniform(0, 0.3) / h * way / np.linalg.norm(way)))
        steps(6)
        assert cd().maxPenetration <= 12 * 1e-8 * 0.3 * 6
    triangles = [[vec(state(k).pos + state(k).ori * v) for v in O.bodies[k].shape.vertices] for k in ids]
    for ball in balls:
        p = vec(state(ball).pos)
        distance = min(np.linalg.norm(p - nearest_on_triangle(p, np.array(corners))) for corners in triangles)
        assert distance >= 0.06 * (1 - 1e-5)
        # Solid angle of the closed shell seen from the ball: 4 pi inside, 0 outside.
        solid = 0.0
        for corners in triangles:
            a, b, c = (corner - p for corner in corners)
            la, lb, lc = (np.linalg.norm(x) for x in (a, b, c))
            solid += 2 * abs(math.atan2(a @ np.cross(b, c), la * lb * lc + a @ b * lc + b @ c * la + c @ a * lb))
        assert solid == pytest.approx(4 * math.pi, abs=1e-3)


def test_both_sides_of_a_sheet() -> None:
    """Balls on top of a sheet and pressed against it from below: each side carries its own."""
    material()
    for corners in (((-3, -3, 0), (3, -3, 0), (3, 3, 0)), ((-3, -3, 0), (3, 3, 0), (-3, 3, 0))):
        facet(corners)
    above, below = grain((0, 0, 1)), grain((0, 0, -1))
    O.forces.setPermF(below, Vector3(0, 0, 3 * G * state(below).mass))
    equip(1e-3, tolerance=1e-12)
    steps(5)
    assert state(above).pos[2] == pytest.approx(1, abs=1e-12) and state(below).pos[2] == pytest.approx(-1, abs=1e-12)
    total = sum(vec(O.forces.f(k)) for k in (0, 1))
    assert total[2] == pytest.approx((2 - 1) * G * state(above).mass, rel=1e-9)
