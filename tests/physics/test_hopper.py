# SPDX-License-Identifier: GPL-2.0-or-later
"""Discharge of a hopper that was imported from an STL file: every grain leaves through the orifice."""

from __future__ import annotations

import numpy as np
from yade import O

from scenes import cd, state, vec
from vessels import D, FUNNEL, ORIFICE, SIDES, WIDE, hopper


def sides() -> tuple[np.ndarray, np.ndarray]:
    """Inward normals of all facets and one corner of each; together they bound a convex space."""
    normals, points = [], []
    for number in range(2 * FUNNEL):
        body = O.bodies[number]
        corners = [vec(body.state.pos + body.state.ori * v) for v in body.shape.vertices]
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normal /= np.linalg.norm(normal)
        points.append(corners[0])
        normals.append(normal if normal @ (np.array([0, 0, 10 * D]) - corners[0]) > 0 else -normal)
    return np.array(normals), np.array(points)


def test_all_grains_leave_through_the_orifice(tmp_path) -> None:
    """None is lost, none stands behind a wall or deeper in it than solves leave, and where one passes z = 0 it is inside of the orifice."""
    inside = hopper(300, str(tmp_path / "hopper.stl"))
    assert len(O.bodies) == 4 * SIDES + 300
    normals, points = sides()
    radii = np.array([O.bodies[b].shape.radius for b in inside])
    below, places = np.zeros(300, bool), np.array([vec(state(b).pos) for b in inside])
    deepest, time_of_half, last = 0.0, 0.0, 0.0
    for _ in range(1500):
        O.step()
        before, places = places, np.array([vec(state(b).pos) for b in inside])
        assert np.isfinite(places).all()
        # Once below, a grain falls freely and never comes back.
        passing = (places[:, 2] < 0) & ~below
        assert not (below & (places[:, 2] >= 0)).any()
        for k in np.flatnonzero(passing):
            share = before[k, 2] / (before[k, 2] - places[k, 2])
            crossing = before[k] + share * (places[k] - before[k])
            # Its centre cannot come nearer to the rim than its radius, but for the overlap, and for the chord between corners of the rim.
            assert np.hypot(crossing[0], crossing[1]) < ORIFICE - radii[k] + 2e-2 * radii[k]
        below |= passing
        # Distance of each grain from the plane of each facet; where its foot is below the rim the facet ends, and the rim above counts.
        distance = np.einsum("fk,gfk->gf", normals, places[:, None, :] - points)
        foot = places[:, None, 2] - distance * normals[:, 2]
        overlap = np.where(~below[:, None] & (foot >= 0), radii[:, None] - distance, 0)
        deepest = max(deepest, (overlap / radii[:, None]).max())
        if below.sum() >= 150 and time_of_half == 0:
            time_of_half = O.time
        if below.all():
            last = O.time
            break
    assert below.all() and last > 1.5 * time_of_half
    # As in a pour: residuals of 1e-4, kept from adding up by penetration repair.
    assert deepest < 2e-2
    assert cd().maxPenetration < 2e-2 * 0.5 * D
    # Free fall for the time since it left, from the rim, whatever pushed it downwards there: the first grain is the lowest one.
    assert places[:, 2].min() < -0.25 * 9.81 * last**2 and np.hypot(places[:, 0], places[:, 1]).max() < 10 * WIDE
