# SPDX-License-Identifier: GPL-2.0-or-later
"""A poured packing at rest stays at rest. The long version, 2,000 grains and 1e5 steps, is scripts/validation/rest.py."""

from __future__ import annotations

import math

import numpy as np
from yade import O, Vector3, utils

from scenes import G, cd, contacts, equip, grain, kinetic_energy, material, state, steps, vec

STEPS = 3000


def _poured() -> list[int]:
    """200 smooth grains, which come to rest on three others or more: with friction some would find a hold on two, between which they rock for long."""
    generator = np.random.default_rng(12)
    stuff = material(friction=0)
    for place, axis in ((0, 2), (0, 0), (8, 0), (0, 1), (8, 1)):
        O.bodies.append(utils.wall(float(place), axis=axis, material=stuff))
    ids = []
    for k in range(200):
        place = 2 * np.array([k % 4, k // 4 % 4, k // 16]) + [1, 1, 1.5] + generator.uniform(-0.05, 0.05, 3)
        ids.append(grain(place, radius=generator.uniform(0.75, 0.9), velocity=generator.uniform(-1, 1, 3)))
    equip(0.05 / math.sqrt(G))
    return ids


def _still(ids: list[int]) -> None:
    """Let the grains come down, give them friction, and bring every one to a halt: nothing resists rolling."""
    cd().tolerance, cd().maxIterations, cd().onNonConvergence = 1e-3, 100, "ignore"
    steps(600)
    O.materials[0].frictionAngle = math.atan(0.5)
    for i in contacts():
        i.phys.tangensOfFrictionAngle = 0.5
    cd().tolerance, cd().maxIterations = 1e-4, 1000
    for _ in range(100):
        steps(40)
        if max(state(n).vel.norm() for n in ids) < 4e-10 * G * O.dt:
            return
        for n in ids:
            state(n).vel = state(n).angVel = Vector3(0, 0, 0)
    raise AssertionError("the packing does not come to rest")


def test_no_creep_and_no_growth_of_overlaps() -> None:
    """The warm start is the solution of a packing at rest, so that one sweep reproduces it: what sticks does not slide by the tolerance of the solve."""
    ids = _poured()
    _still(ids)
    places, overlap, sweeps = [vec(state(n).pos) for n in ids], cd().meanPenetration, []
    energies = []
    steps(STEPS, lambda: (sweeps.append(cd().iterations), energies.append(kinetic_energy())))
    way = max(np.linalg.norm(vec(state(n).pos) - place) for n, place in zip(ids, places))
    assert cd().activeContacts > 400 and max(sweeps) == 1
    # 1e-6 of a radius in 1e5 steps.
    assert way < 1e-6 * 0.75 * STEPS / 1e5
    # A velocity of 1e-9 h g would be the rounding of 1e7 times the weight.
    assert max(energies) < sum(state(n).mass for n in ids) * (1e-9 * G * O.dt) ** 2 / 2
    assert abs(cd().meanPenetration - overlap) < 1e-9 * 0.75
