# SPDX-License-Identifier: GPL-2.0-or-later
"""O.energy: the balance closes, and every term has its sign.

The leapfrog has its velocities in the middle of a step: there potential energies are taken, z - h v / 2, and then the work
of gravity is exactly m g (z change).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3

from scenes import G, box, equip, floor, grain, kinetic_energy, law, state, steps


def potential(g: float) -> float:
    return sum(b.state.mass * g * (b.state.pos[2] - 0.5 * O.dt * b.state.vel[2]) for b in O.bodies if b.dynamic)


def terms() -> dict[str, float]:
    return {name: O.energy[name] for name in O.energy.keys() if name.startswith("contact")}


def gas(gravity: float, **attributes) -> float:
    """60 balls fly about in a box; returns the energy exchanged, for scale."""
    generator = np.random.default_rng(3)
    law(**attributes)
    for axis in range(3):
        for sign in (-1, 1):
            center, half = [0, 0, 0], [9, 9, 9]
            center[axis], half[axis] = 8 * sign, 1
            box(center, half)
    for k in range(60):
        place = 3 * np.array([k % 4 - 1.5, k // 4 % 4 - 1.5, k // 16 - 1.5])
        grain(place, radius=generator.uniform(0.7, 1), velocity=generator.uniform(-4, 4, 3), spin=generator.uniform(-2, 2, 3))
    equip(5e-3, gravity=(0, 0, -gravity), tolerance=1e-6, maxIterations=5000)
    O.trackEnergy = True
    return kinetic_energy()


@pytest.mark.parametrize(
    "attributes, seen",
    [
        (dict(normalRestitution=0.8, frictionAngle=0.3), {"contactFriction", "contactRestitution"}),
        (dict(frictionAngle=0.3), {"contactFriction", "contactImpact"}),
        (
            dict(normalRestitution=0.6, tangentialRestitution=0.4, rollingFriction=0.05, twistingFriction=0.05),
            {"contactFriction", "contactRestitution", "contactRolling"},
        ),
        (dict(cohesionForce=2e4), {"contactCohesion", "contactFriction", "contactImpact"}),
        (dict(kn=2e8, ks=1e8, normalDamping=1e4), {"contactDamping"}),
    ],
)
@pytest.mark.parametrize("gravity", [0.0, G])
def test_balance_of_a_gas(gravity: float, attributes: dict, seen: set) -> None:
    scale = gas(gravity, **attributes)
    start = kinetic_energy() + potential(gravity)
    steps(300)
    lost = terms()
    # Round-off only, whatever the residual of the solves: some 1e4 sums of relative error 1e-16.
    assert kinetic_energy() + potential(gravity) + sum(lost.values()) == pytest.approx(start, abs=1e-10 * scale)
    assert seen <= set(lost)
    for name in seen:
        assert lost[name] > 1e-4 * scale, name


def test_conserving_gas() -> None:
    """e = 1 without friction: nothing is lost, to the residual of the solves."""
    scale = gas(0, normalRestitution=1, frictionAngle=0)
    steps(300)
    # Impacts of several balls at once are solved to 1e-6 of the impulse; a few hundred of them.
    assert abs(sum(terms().values())) < 1e-3 * scale


def test_sliding_block() -> None:
    """Friction takes mu m g times the way, with the way in the middle of the steps."""
    law(frictionAngle=math.atan(0.3))
    floor()
    ball = grain((0, 0, 1), velocity=(3, 0, 0))
    state(ball).blockedDOFs = "XYZ"
    equip(1e-3, tolerance=1e-12)
    O.trackEnergy = True
    before = state(ball).pos[0] - 0.5 * O.dt * state(ball).vel[0]
    steps(500)
    way = state(ball).pos[0] - 0.5 * O.dt * state(ball).vel[0] - before
    assert O.energy["contactFriction"] == pytest.approx(0.3 * state(ball).mass * G * way, rel=1e-10)


def test_pushing_an_overlap_out_shows_as_negative_impact() -> None:
    """Condition (24) gives a ball with overlap d the velocity d/h, out of nothing."""
    law()
    floor()
    ball = grain((0, 0, 0.999))
    equip(1e-3, gravity=(0, 0, 0), contactLaw="signorini")
    O.trackEnergy = True
    O.step()
    assert O.energy["contactImpact"] == pytest.approx(-0.5 * state(ball).mass, rel=1e-9)


def test_bond_takes_energy_when_it_breaks() -> None:
    """In the step of the break the bond pulls with its strength: its work is strength times the way of that step."""
    law(cohesionForce=1000)
    grain((0, 0, 0), fixed=True)
    ball = grain((0, 0, 2))
    equip(1e-3, gravity=(0, 0, 0))
    O.trackEnergy = True
    O.forces.setPermF(ball, Vector3(0, 0, 3000))
    O.step()
    assert O.energy["contactCohesion"] == pytest.approx(1000 * 0.5 * O.dt * state(ball).vel[2], rel=1e-9)
