# SPDX-License-Identifier: GPL-2.0-or-later
"""A triaxial box for the tests; the runs of the bits are in processes of their own."""

from __future__ import annotations

import numpy as np
from yade import O

import contactdynamics.triaxial as triaxial
from saving_cases import numbers
from scenes import engine, grain, material, steps

FIRST, SECOND = 60, 40
PRESSURE = 1e6  # moves a sphere by its size in 0.1 s
H = 2e-3


def build(friction: float = 0.4, tolerance: float = 1e-4, side: int = 4, **more) -> list[int]:
    """A jittered lattice of spheres in a box that is a little too large; returns the ids of the walls."""
    generator = np.random.default_rng(3)
    material(friction)
    edge = 2.05 * side
    walls = triaxial.box((0, 0, 0), (edge, edge, edge))
    for k in range(side**3):
        place = 2.05 * (np.array([k % side, k // side % side, k // side**2]) + 0.5)
        grain(place + generator.uniform(-0.05, 0.05, 3), radius=generator.uniform(0.85, 0.97), velocity=generator.uniform(-0.1, 0.1, 3))
    O.engines = triaxial.engines(walls, stress=-PRESSURE, maxStrainRate=1.0, tolerance=tolerance, maxIterations=20000, **more)
    O.dt = H
    return walls


def bits() -> str:
    """Of bodies, contacts and controller."""
    c = engine("ContactDynamicsTriaxialController")
    return numbers() + " ".join(float(v).hex() for v in [*c.size, *c.strain, c.wallMassInUse]) + "\n"


def straight(result: str) -> None:
    """The whole run: confined, then sheared."""
    build()
    _shear(FIRST + SECOND)
    _write(result)


def until_half(scene: str) -> None:
    """The first part, saved."""
    build()
    _shear(FIRST)
    O.save(scene)


def from_half(scene: str, result: str) -> None:
    """The second part, from a file."""
    O.load(scene)
    steps(SECOND)
    _write(result)


def _shear(number: int) -> None:
    for _ in range(number):
        if O.iter == FIRST - 10:
            triaxial.shear(-0.5)
        O.step()


def _write(result: str) -> None:
    assert O.iter == FIRST + SECOND
    text = bits()
    assert text.count("sliding") + text.count("sticking") > 60, "the scene has too few contacts to tell anything"
    with open(result, "w") as file:
        file.write(text)
