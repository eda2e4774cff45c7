# SPDX-License-Identifier: GPL-2.0-or-later
"""Periodic cells with a ContactDynamicsCellController; those of the bits run in processes of their own."""

from __future__ import annotations

import numpy as np
from yade import Matrix3, O, PyRunner, utils

from contactdynamics import ContactDynamicsCellController
from halves import Halves
from saving_cases import numbers
from scenes import dumbbell, engine, equip, grain, material

PRESSURE = 1e6  # moves a sphere by its size in 0.1 s
SHEARED = Matrix3(-0.6, 0.4, 0, 0, -0.6, -0.2, 0.3, 0, -0.6)  # closes most gaps of the lattice in 40 steps, but does not jam it
GOAL = Matrix3(-PRESSURE, 1e5, 0, 1e5, -1.2 * PRESSURE, 0, 0, 0, -0.8 * PRESSURE)


def matrix(m) -> np.ndarray:
    """A YADE matrix as an array."""
    return np.array([[m[i, j] for j in range(3)] for i in range(3)])


def control(**attributes):
    """Put a controller before the engine and a measurement of the stress behind it, and return the controller."""
    made = ContactDynamicsCellController(**attributes)
    engines = list(O.engines)
    place = next(i for i, e in enumerate(engines) if type(e).__name__ == "ContactDynamicsEngine")
    measure = PyRunner(command="import cell_cases as c; c.look()", iterPeriod=1, initRun=True)
    O.engines = engines[:place] + [made, engines[place], measure] + engines[place + 1 :]
    return engine("ContactDynamicsCellController")


seen: list = []  # stress behind the engine, before the bodies move, as YADE defines it


def look() -> None:
    """Keep it."""
    seen.append(utils.getStress())


def dense(friction: float = 0.4, tolerance: float = 1e-6, dt: float = 1e-3, **attributes):
    """Spheres, dumbbells and a sphere with three moments of inertia on a jittered lattice that fills the cell; returns the controller."""
    seen.clear()
    generator = np.random.default_rng(5)
    O.periodic = True
    O.cell.setBox(8, 8, 8)
    material(friction=friction)
    for k in range(64):
        place = 2 * np.array([k % 4, k // 4 % 4, k // 16]) + 1 + generator.uniform(-0.05, 0.05, 3)
        if k % 16 == 5:
            dumbbell([place - [0.2, 0.1, 0], place + [0.2, 0.1, 0]], radius=0.75)
            continue
        number = grain(place, radius=0.97, velocity=generator.uniform(-0.05, 0.05, 3))
        if k % 16 == 9:
            O.bodies[number].aspherical = True
            inertia = O.bodies[number].state.inertia
            O.bodies[number].state.inertia = type(inertia)(0.7 * inertia[0], inertia[0], 1.2 * inertia[0])
    equip(dt, gravity=(0, 0, 0), tolerance=tolerance, maxIterations=20000)
    attributes.setdefault("stress", GOAL)
    attributes.setdefault("velGrad", SHEARED)
    attributes.setdefault("stressMask", 7)
    return control(**attributes)


def build() -> None:
    """The scene of the bits."""
    dense(tolerance=1e-4)


def bits() -> str:
    """Of bodies, contacts, cell and controller."""
    c = engine("ContactDynamicsCellController")
    values = [*matrix(O.cell.hSize).flat, *matrix(O.cell.velGrad).flat, *matrix(c.currentStress).flat, c.work, c.inertiaInUse]
    return numbers() + " ".join(float(v).hex() for v in values) + "\n"


_halves = Halves(build, bits, first=40, second=30)
straight, until_half, from_half = _halves.straight, _halves.until_half, _halves.from_half
