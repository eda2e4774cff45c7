# SPDX-License-Identifier: GPL-2.0-or-later
"""A triaxial box for the tests; the runs of the bits are in processes of their own."""

from __future__ import annotations

import numpy as np
from yade import O

import contactdynamics.triaxial as triaxial
from halves import Halves
from saving_cases import numbers
from scenes import engine, grain, material

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


def _sheared(number: int) -> None:
    """Confined at first, then sheared."""
    for _ in range(number):
        if O.iter == 50:
            triaxial.shear(-0.5)
        O.step()


_halves = Halves(build, bits, first=60, second=40, steps=_sheared)
straight, until_half, from_half = _halves.straight, _halves.until_half, _halves.from_half
