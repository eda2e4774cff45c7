# SPDX-License-Identifier: GPL-2.0-or-later
"""Periodic assemblies of hard balls under pressure: the pressure itself, isostaticity without friction, fewer contacts with it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import Matrix3, O, Vector3, pack, utils

import contactdynamics
from scenes import cd, contacts, engine, material

RADIUS, PRESSURE, DENSITY = 0.01, 1e3, 2600.0
INERTIAL = 2 * RADIUS * math.sqrt(DENSITY / PRESSURE)  # time in which the pressure moves a grain by its size [s]


def loose(count: int, friction: float) -> None:
    """A gas of balls in a periodic cell, and a controller that compresses it."""
    length = (count * 4 / 3 * math.pi * RADIUS**3 / 0.3) ** (1 / 3)
    O.periodic = True
    O.cell.setBox(length, length, length)
    balls = pack.SpherePack()
    assert count == balls.makeCloud(Vector3(0, 0, 0), Vector3(length, length, length), rMean=RADIUS, rRelFuzz=0.1, num=count, periodic=True, seed=3)
    balls.toSimulation(material=material(friction, DENSITY))
    control = contactdynamics.ContactDynamicsCellController(
        stress=Matrix3(-PRESSURE, 0, 0, 0, -PRESSURE, 0, 0, 0, -PRESSURE), maxStrainRate=0.5 / INERTIAL
    )
    engines = contactdynamics.engines(gravity=(0, 0, 0), maxIterations=5000)
    O.engines = engines[:-2] + [control] + engines[-2:]
    O.dt = 0.03 * INERTIAL


def pressures() -> np.ndarray:
    stress = utils.getStress()
    return np.array([-stress[i, i] / PRESSURE for i in range(3)])


def coordination(least: int) -> float:
    """Contacts per grain, grains with fewer than `least` left out until none is left."""
    pairs = np.array([(c.id1, c.id2) for c in contacts() if c.phys.normalForce.squaredNorm() > 0])
    alive = np.ones(len(O.bodies), bool)
    while True:
        number = np.bincount(pairs[alive[pairs].all(axis=1)].ravel(), minlength=len(alive))
        loose = alive & (number < least)
        if not loose.any():
            return number.sum() / alive.sum()
        alive &= ~loose


def test_frictionless_balls_jam_isostatically() -> None:
    """With the three edges of the cell free to move, N grains that are no rattlers have 3 N − 3 + 3 freedoms, and as many contacts: z = 6.

    The forces of so many contacts are unique, and every other contact is open. A contact that carries less than the tolerance of the solve, or
    still moves, may be counted wrongly: 2 % of the contacts are allowed for.
    """
    loose(120, 0)
    # The cell gives way to the repair, so no overlap stays that is deeper than allowed, in sizes of the smaller ball: 1.1 of the mean at most.
    for step in range(2500):
        if step == 1200:
            cd().tolerance = 1e-8
        O.step()
        if step > 1500 and cd().remainingOverlap <= 1.1 * cd().allowedOverlap * RADIUS:
            break
    assert cd().remainingOverlap <= 1.1 * cd().allowedOverlap * RADIUS
    assert pressures() == pytest.approx([1, 1, 1], abs=1e-4)
    assert coordination(4) == pytest.approx(6, abs=0.12)
    assert 0.61 < 1 - utils.porosity() < 0.66


def test_friction_needs_fewer_contacts_and_shear_keeps_the_pressure() -> None:
    """With friction between 4 (isostatic with friction) and 6; then simple shear at constant pressure."""
    loose(120, 0.5)
    for _ in range(900):
        O.step()
    assert pressures() == pytest.approx([1, 1, 1], abs=1e-3)
    assert 4 <= coordination(2) <= 5
    control = engine("ContactDynamicsCellController")
    control.velGrad = Matrix3(0, 1e-2 / INERTIAL, 0, 0, 0, 0, 0, 0, 0)
    O.cell.flipFlippable = True
    found, shear = [], []
    for _ in range(600):
        O.step()
        found.append(pressures())
        shear.append(utils.getStress()[0, 1] / PRESSURE)
    # Rearrangements of so few grains shake the cell; what they leave is M dL/dt, which has no mean.
    assert np.mean(found[200:], axis=0) == pytest.approx([1, 1, 1], abs=0.02)
    assert 0.2 < np.mean(shear[200:]) < 0.6
