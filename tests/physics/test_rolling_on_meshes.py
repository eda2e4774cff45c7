# SPDX-License-Identifier: GPL-2.0-or-later
"""A heavy ball rolls in and on a horizontal cylinder of facets: what the sides of the polygon imply, and nothing else."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Quaternion, Vector3, geom

from scenes import G, cd, equip, grain, material, state, vec

R, RADIUS = 1.0, 0.1


def cylinder(segments: int) -> None:
    """A polygonal cylinder about the y axis with its corners at R, one of them lowest and one highest."""
    upright = Quaternion(Vector3(1, 0, 0), math.pi / 2)
    O.bodies.append(geom.facetCylinder((0, 0, 0), R, 4, orientation=upright, segmentsNumber=segments, wallMask=4, material=O.materials[0]))
    corners = [vec(state(k).pos + state(k).ori * v) for k in range(2 * segments) for v in O.bodies[k].shape.vertices]
    assert min(math.hypot(c[0], c[2] + R) for c in corners) < 1e-9


def spin_at_the_bottom(segments: int, sides: int) -> float:
    """Of a ball that starts at rest in the middle of a side, `sides` sides above the lowest corner, and rolls down the polygon of centres.

    Each side is an incline. At a corner the ball has two lines of contact one after the other: the angular momentum about the new one stays,
    (m r^2 cos a + I) w = (m r^2 + I) w', a the turn from side to side.
    """
    turn = 2 * math.pi / segments
    length = 2 * (R * math.cos(turn / 2) - RADIUS) * math.tan(turn / 2)
    squared = 0.0
    for k in range(sides, 0, -1):
        fall = (0.5 if k == sides else 1) * length * math.sin((k - 0.5) * turn)
        squared += 10 / 7 * G * fall
        if k > 1:
            squared *= ((5 * math.cos(turn) + 2) / 7) ** 2
    return math.sqrt(squared) / RADIUS


@pytest.mark.parametrize("segments, sides", [(72, 12), (200, 30)])
def test_ball_rolls_down_inside(segments: int, sides: int) -> None:
    """Angular velocity at the lowest corner as of a ball on a polygon; it never leaves the wall, never slides, never jumps."""
    material(friction=1.0)
    cylinder(segments)
    turn = 2 * math.pi / segments
    angle, apothem = (sides - 0.5) * turn, R * math.cos(turn / 2) - RADIUS
    ball = grain((-apothem * math.sin(angle), 0.1, -apothem * math.cos(angle)), radius=RADIUS)
    h = 1e-3
    equip(h, tolerance=1e-10, maxIterations=1000)
    before = 0.0
    while state(ball).pos[0] < 0:
        O.step()
        s = state(ball)
        assert s.vel.norm() == pytest.approx(abs(s.angVel[1]) * RADIUS, rel=0.01, abs=2 * G * h)
        # In a step the ball gains at most what gravity gives; at a corner it loses 5/14 turn^2, and what a step past the corner makes of it.
        assert -turn**2 * before - 1e-9 <= s.vel.norm() - before <= 5 / 7 * G * h + turn**2 * before
        before = s.vel.norm()
        centre = math.hypot(s.pos[0], s.pos[2])
        assert apothem - 1e-6 <= centre <= apothem / math.cos(turn / 2) + 1e-9
    # The scheme is of first order: h g of the speed in 1.2 s of rolling, and half a step at each corner.
    assert abs(state(ball).angVel[1]) == pytest.approx(spin_at_the_bottom(segments, sides), rel=0.01)
    assert abs(state(ball).angVel[0]) < 1e-6 and abs(state(ball).pos[1] - 0.1) < 1e-9
    assert cd().maxPenetration < 1e-9


@pytest.mark.parametrize("segments", [36, 200])
def test_ball_rolls_down_outside(segments: int) -> None:
    """On top there is no impact: over an edge the ball turns about it, 7/10 m v^2 = m g (fall of the centre).

    That is so while the weight keeps it on the edge, v^2 < g r cos(angle), up to 0.54 here; a faster ball leaps from edge to edge.
    """
    material(friction=1.0)
    cylinder(segments)
    radius, turn = 0.3, 2 * math.pi / segments
    side = (math.floor(0.1 / turn) + 0.5) * turn
    apothem = R * math.cos(turn / 2) + radius
    ball = grain((apothem * math.sin(side), 0.1, apothem * math.cos(side)), radius=radius)
    h = 5e-4
    equip(h, tolerance=1e-10, maxIterations=1000)
    top, edges = state(ball).pos[2], 0
    while math.atan2(state(ball).pos[0], state(ball).pos[2]) < 0.5:
        O.step()
        s = state(ball)
        speed, centre = s.vel.norm(), math.hypot(s.pos[0], s.pos[2])
        # A step of turning about an edge is straight, and leads away from the arc by up to (h v)^2 / 2 r.
        assert apothem - 1e-6 <= centre <= R + radius + (speed * h) ** 2 / radius + 1e-9
        assert s.angVel[1] * radius == pytest.approx(speed, rel=0.005, abs=G * h)
        edges += centre > R + radius - 1e-9
    assert edges > 0
    fall = top - state(ball).pos[2] - 0.5 * h * state(ball).vel[2]
    assert 0.7 * state(ball).vel.squaredNorm() == pytest.approx(G * fall, rel=0.01)  # of first order in h, 0.5 s long: 1e-3 a step behind
    assert cd().maxPenetration < 1e-9
