# SPDX-License-Identifier: GPL-2.0-or-later
"""A turning drum of facets: momentum and energy balance of what tumbles in it."""

from __future__ import annotations

import numpy as np
import pytest
from yade import O, HelixEngine, RotationEngine, Vector3

from scenes import G, cd, equip, grain, kinetic_energy, material, state, vec
from vessels import DRUM as R
from vessels import SPIN, drum

ENGINES = {
    "turning": lambda ids: RotationEngine(ids=ids, rotationAxis=(0, 1, 0), angularVelocity=SPIN, rotateAroundZero=True),
    "turning off the axis": lambda ids: RotationEngine(
        ids=ids, rotationAxis=(0, 1, 0), angularVelocity=SPIN, rotateAroundZero=True, zeroPoint=(0.1, 0, -0.2)
    ),
    "screw": lambda ids: HelixEngine(ids=ids, rotationAxis=(0, 1, 0), angularVelocity=SPIN, linearVelocity=0.3),
}


@pytest.mark.parametrize("kind", list(ENGINES))
def test_balance_of_a_drum(kind: str) -> None:
    """What the drum gives is what the balls have, the height they gained, and what contacts took; every step, and in the sum.

    The work of the drum is evaluated here, from the forces that YADE shows and the velocities of the facets. Only roundings are left: sums of some
    1e5 terms, relative to the work done.
    """
    shell, inside = drum(24, ENGINES[kind])
    mass = np.array([state(b).mass for b in inside])

    def height_energy() -> float:  # in the middle of the step, to which the velocities belong
        return sum(state(b).mass * G * (state(b).pos[2] - 0.5 * O.dt * state(b).vel[2]) for b in inside)

    def momentum() -> np.ndarray:
        return sum(state(b).mass * vec(state(b).vel) for b in inside)

    def moment_of_momentum() -> np.ndarray:
        return sum(np.cross(vec(state(b).pos), state(b).mass * vec(state(b).vel)) + state(b).inertia[0] * vec(state(b).angVel) for b in inside)

    work, impulse, angular, start = 0.0, np.zeros(3), np.zeros(3), kinetic_energy() + height_energy()
    p0, l0 = momentum(), moment_of_momentum()
    for _ in range(150):
        at = {k: vec(state(k).pos) for k in shell}
        weight_moment = sum(np.cross(vec(state(b).pos), [0, 0, -state(b).mass * G]) for b in inside)
        O.step()
        assert cd().converged
        for k in shell:
            f, t = vec(O.forces.f(k)), vec(O.forces.t(k))
            work -= O.dt * (f @ vec(state(k).vel) + t @ vec(state(k).angVel))
            impulse -= O.dt * f
            angular -= O.dt * (np.cross(at[k], f) + t)
        impulse += O.dt * np.array([0, 0, -mass.sum() * G])
        angular += O.dt * weight_moment
    terms = {name: O.energy[name] for name in O.energy.keys() if name.startswith("contact")}
    gained = kinetic_energy() + height_energy() - start
    assert work > 0.2 * mass.sum() * G * R, "the drum has hardly done any work"
    assert terms["contactFriction"] > 0 and terms["contactImpact"] > 0
    assert -terms["contactBoundary"] == pytest.approx(work, rel=1e-10)
    assert gained + sum(terms.values()) == pytest.approx(0, abs=1e-10 * work)
    scale = mass.sum() * G * O.dt * 150
    assert momentum() - p0 == pytest.approx(impulse, abs=1e-10 * scale)
    # x+ differs from x by h v+, which is parallel to m v+: the moment of momentum at x+ is that at x plus the moments of the step.
    assert moment_of_momentum() - l0 == pytest.approx(angular, abs=1e-10 * scale * R)
    for b in inside:
        place = vec(state(b).pos) - (np.array([0.1, 0, -0.2]) if "off" in kind else 0)
        assert np.hypot(place[0], place[2]) < R + (0.3 if "off" in kind else 0) and cd().maxPenetration < 1e-3 * 0.1


def test_lifting_plate_does_the_work_of_the_weight() -> None:
    """A plate that rises at v does the work m g v t on a ball, and takes none when the ball is at rest on it."""
    from scenes import box

    material()
    plate = box((0, 0, -1), (3, 3, 1))
    ball = grain((0.2, 0.1, 1))
    equip(1e-3, tolerance=1e-12)
    O.trackEnergy = True
    for velocity in (0, 0.5):
        state(plate).vel = Vector3(0, 0, velocity)
        O.step()
        before = O.energy["contactBoundary"] if "contactBoundary" in O.energy.keys() else 0
        for _ in range(100):
            O.step()
        after = O.energy["contactBoundary"] if "contactBoundary" in O.energy.keys() else 0
        assert after - before == pytest.approx(-state(ball).mass * G * velocity * 0.1, rel=1e-9, abs=1e-9)
