# SPDX-License-Identifier: GPL-2.0-or-later
"""Balls and clumps on a turning mesh that is opened in mid-run, and the exact numbers that leads to; run in processes of their own."""

from __future__ import annotations

import numpy as np
from yade import HelixEngine, O

from saving_cases import numbers
from scenes import cd, dumbbell, equip, grain, material, steps
from test_detection import facet

FIRST, SECOND = 15, 15


def build() -> None:
    """More than 500 balls that touch several facets each (so that threads share them), on a hollow mesh that turns and rises."""
    generator = np.random.default_rng(3)
    material(friction=0.4)
    count, edge = 24, 0.5
    places = (np.arange(count + 1) - count / 2) * edge
    z = 0.02 * (places[:, None] ** 2 + places[None, :] ** 2) + generator.uniform(0, 0.05, (count + 1, count + 1))
    ids = []
    for i in range(count):
        for j in range(count):
            a, b, c, d = ((places[k], places[m], z[k, m]) for k, m in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            ids += [facet((a, b, c)), facet((a, c, d))]
    for i in range(24):
        for j in range(24):
            x, y = 0.48 * (i - 11.5), 0.48 * (j - 11.5)
            grain((x, y, 0.02 * (x * x + y * y) + 0.26), radius=generator.uniform(0.2, 0.23), velocity=generator.uniform(-1, 1, 3))
    for k in range(10):
        dumbbell([(k - 5, 0, 1.2), (k - 4.7, 0.1, 1.3)], radius=0.2)
    equip(5e-3, tolerance=1e-4, maxIterations=300, onNonConvergence="ignore")
    turn = HelixEngine(ids=ids, rotationAxis=(0, 0, 1), angularVelocity=2, linearVelocity=0.5)
    O.engines = O.engines[:1] + [turn] + O.engines[1:]


def open_it() -> None:
    """A hole in the middle of the mesh, and two balls gone."""
    for number in (k for k in range(1152) if np.hypot(O.bodies[k].state.pos[0], O.bodies[k].state.pos[1]) < 1.5):
        O.bodies.erase(number)
    O.bodies.erase(1200)
    O.bodies.erase(1300)


def first(scene: str) -> None:
    """The first part, saved."""
    build()
    steps(FIRST)
    O.save(scene)


def to_the_end(result: str, scene: str = "") -> None:
    """The whole run, or what is left of it from a file."""
    if scene:
        O.load(scene)
    else:
        build()
        steps(FIRST)
    open_it()
    steps(SECOND)
    assert cd().activeContacts > 200
    with open(result, "w") as file:
        file.write(numbers())
