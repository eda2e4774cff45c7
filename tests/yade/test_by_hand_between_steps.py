# SPDX-License-Identifier: GPL-2.0-or-later
"""What a user does between two steps counts in the next one: velocities, bodies, engines, whole scenes."""

from __future__ import annotations

from typing import Callable

import numpy as np
import pytest
from yade import FrictMat, O, Vector3, polyhedra_utils, utils

import contactdynamics
from contactdynamics import takeover
from scenes import G, cd, engine, equip, floor, grain, material, state, steps
from test_detection import _target

H = 1e-2
FAST = 12.0  # radii in a step: nothing but the speed of the body itself makes a candidate of the obstacle


def _cube(place: Vector3) -> int:
    corners = [place + Vector3(*corner) for corner in np.array(np.meshgrid(*[[-0.5, 0.5]] * 3)).reshape(3, -1).T]
    return O.bodies.append(polyhedra_utils.polyhedra(O.materials[0], v=corners))


def _run_collider() -> None:
    engine("InsertionSortCollider")()


def _run_loop() -> None:
    engine("InteractionLoop")()


def _make_pair() -> None:
    first = _cube(Vector3(50, 0, 5))
    utils.createInteraction(first, _cube(Vector3(53, 0, 5)))


@pytest.mark.parametrize("kind", ["box", "wall", "facet"])
@pytest.mark.parametrize("look", [_run_collider, _run_loop, _make_pair])
def test_velocity_set_after_a_look_at_the_candidates(look: Callable[[], None], kind: str) -> None:
    """The way of the coming step is that of the velocity now, also where the collider has run, or a pair was made, at this step before."""
    material()
    _target(kind)
    ball = grain((0.1, 0.1, 2))
    grain((20, 0, 5)), grain((22.05, 0, 5))  # a pair for the loop to look at
    equip(H, gravity=(0, 0, 0))
    steps(1)
    look()
    state(ball).vel = Vector3(0, 0, -FAST / H)
    steps(2)
    assert state(ball).pos[2] == pytest.approx(1, abs=1e-12 * FAST)


def test_fast_ball_after_a_reset() -> None:
    """A new scene may have the address, and has the step number, of one that was looked at."""
    for velocity in (0, -FAST / H):
        O.reset()
        material()
        _target("facet")
        ball = grain((0.1, 0.1, 2), velocity=(0, 0, velocity))
        equip(H, gravity=(0, 0, 0))
        if velocity == 0:
            _run_collider()
    steps(2)
    assert state(ball).pos[2] == pytest.approx(1, abs=1e-12 * FAST)


def test_fast_ball_appended_after_a_look() -> None:
    material()
    _target("facet")
    grain((30, 0, 2))
    equip(H, gravity=(0, 0, 0))
    _run_collider()
    ball = grain((0.1, 0.1, 2), velocity=(0, 0, -FAST / H))
    steps(2)
    assert state(ball).pos[2] == pytest.approx(1, abs=1e-12 * FAST)


def _falls_on_the_floor() -> tuple[int, int]:
    material()
    floor()
    return grain((0, 0, 1)), grain((20, 0, 1))


def test_new_engines_after_a_body_was_erased() -> None:
    """YADE's collider, new in a scene from which a body has gone, would know no body at all."""
    ball, gone = _falls_on_the_floor()
    equip(1e-3)
    steps(10)
    O.bodies.erase(gone)
    steps(10)
    O.engines = contactdynamics.engines(tolerance=1e-6)
    steps(1)
    assert cd().activeContacts == 1
    prepared = contactdynamics.engines(tolerance=1e-6)  # a run with the old list lies between making this one and using it
    steps(10)
    O.engines = prepared
    steps(10)
    assert cd().activeContacts == 1 and state(ball).pos[2] == pytest.approx(1, abs=1e-9)


def test_take_over_after_a_body_was_erased() -> None:
    """The soft packing of before has a collider of its own, which has seen the body go."""
    from yade import (
        Bo1_Box_Aabb,
        Bo1_Sphere_Aabb,
        ForceResetter,
        Ig2_Box_Sphere_ScGeom,
        InsertionSortCollider,
        InteractionLoop,
        Ip2_FrictMat_FrictMat_FrictPhys,
        Law2_ScGeom_FrictPhys_CundallStrack,
        NewtonIntegrator,
    )

    ball, gone = _falls_on_the_floor()
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]),
        InteractionLoop([Ig2_Box_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
        NewtonIntegrator(gravity=(0, 0, -G), damping=0.4),
    ]
    O.dt = 0.3 * utils.PWaveTimeStep()
    steps(2000)
    O.bodies.erase(gone)
    steps(2000)
    assert takeover.takeOver(contactdynamics.engines(), 1e-3) == 1
    steps(100)
    assert cd().activeContacts == 1 and state(ball).pos[2] == pytest.approx(1, abs=1e-3)


def test_error_that_nobody_raised_stays_in_its_scene() -> None:
    """A functor found a body without material, but the engine was dead; neither a later step nor another scene is told of it."""

    def scene() -> int:
        O.reset()
        material()
        floor()
        return grain((0, 0, 1))

    for _ in range(4):  # so that an address is used again
        ball = scene()
        O.bodies[ball].material = None
        equip(1e-3)
        cd().dead = True
        O.step()
        ball = scene()
        equip(1e-3)
        O.step()
    O.bodies[ball].material = None
    O.interactions.clear()
    cd().dead = True
    O.step()
    O.bodies[ball].material = FrictMat(density=2600)
    cd().dead = False
    steps(2)


def test_dead_integrator_hides_no_gravity() -> None:
    """The gravity of the integrator that lives takes the grain three radii down in the first step."""
    from yade import NewtonIntegrator

    material()
    _target("box")
    ball = grain((0, 0, 2))
    equip(H, gravity=(0, 0, -3 / H**2))
    O.engines = O.engines + [NewtonIntegrator(dead=True, gravity=(0, 0, 0))]
    steps(3)
    assert state(ball).pos[2] == pytest.approx(1, abs=1e-11)
