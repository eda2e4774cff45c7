# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares what ContactDynamicsEngine predicts with what NewtonIntegrator then does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from yade import O

from scenes import cd, contacts, engine, rotation, state, vec

# Both sides add the same few numbers, perhaps in another order: a handful of roundings, each 1.1e-16 of the largest
# term. The issue asks for 1e-12, which leaves room for some thousand of them and for none that is not a rounding.
RELATIVE = 1e-12


@dataclass
class Before:
    """State of one body before a step."""

    velocity: np.ndarray
    spin: np.ndarray
    momentum: np.ndarray
    rotation: np.ndarray
    size: float  # largest velocity among the terms of the sum


def integrated() -> list[int]:
    """Ids that NewtonIntegrator moves by itself: no clump members, no body outside its mask."""
    mask = _newton().mask
    return [b.id for b in O.bodies if not b.isClumpMember and (mask <= 0 or b.mask & mask)]


def exact_rotation(number: int) -> bool:
    """Whether NewtonIntegrator advances the angular momentum of this body instead of its angular velocity."""
    body = O.bodies[number]
    return _newton().exactAsphericalRot and body.aspherical and not set("XYZ") & set(body.state.blockedDOFs)


def step_and_compare(forces: float = 0.0, scaling: bool = False) -> None:
    """Make one step and compare both predictions of the engine with the motion, body by body.

    `forces` is the size of the external forces divided by mass, for the scale of the comparison. `scaling` says that
    `State.densityScaling` is in use.
    """
    before = {}
    for n in integrated():
        s = state(n)
        before[n] = Before(vec(s.vel), vec(s.angVel), vec(s.angMom), rotation(n), O.dt * forces)
    places, old_gradient = {n: state(n).pos for n in before}, _newton().prevVelGrad
    O.step()
    if O.periodic:  # the mean field and its change, velGrad x, are terms of the sum
        gradient = _norm(old_gradient) + _norm(O.cell.velGrad)
        for n, place in places.items():
            before[n].size += gradient * place.norm()
    pushes = {n: 0.0 for n in before}
    for i in contacts():
        for number in (i.id1, i.id2):
            owner = O.bodies[number].clumpId if O.bodies[number].isClumpMember else number
            if owner in pushes:
                pushes[owner] += i.phys.impulse.norm()
    predicted, momenta = cd().predictedVelocities(), cd().predictedAngularMomenta()
    assert len(predicted) == len(O.bodies)
    for body in O.bodies:
        number = body.id
        if number not in before:
            assert predicted[number] is None, f"body #{number} is not integrated"
            continue
        assert predicted[number] is not None, f"body #{number} is integrated"
        old, linear, spin = before[number], vec(predicted[number][0]), vec(predicted[number][1])
        new = state(number)
        push = pushes[number] / new.mass if new.mass > 0 else 0.0
        scale = np.linalg.norm(old.velocity) + new.vel.norm() + old.size + push
        kind = f"of #{number} (blocked {new.blockedDOFs!r}, aspherical {body.aspherical})"
        _close(linear, vec(new.vel), scale, f"velocity {kind}")
        if exact_rotation(number):
            # A lever arm is not larger than the body, whose size is of the order of sqrt(inertia / mass).
            arm = np.sqrt(max(vec(new.inertia)) / new.mass)
            scale = np.linalg.norm(old.momentum) + new.angMom.norm() + new.mass * arm * (old.size + push)
            _close(vec(momenta[number]), vec(new.angMom), scale, f"angular momentum of #{number}")
            inverse = old.rotation @ np.diag(1 / vec(new.inertia)) @ old.rotation.T
            expected = inverse @ vec(new.angMom) * (new.densityScaling if scaling else 1.0)
            _close(spin, expected, scale * np.linalg.norm(inverse), f"angular velocity of #{number}")
        else:
            heavy = new.mass > 0 and min(vec(new.inertia)) > 0
            rate = push / np.sqrt(min(vec(new.inertia)) / new.mass) if heavy else 0.0
            scale = np.linalg.norm(old.spin) + new.angVel.norm() + rate
            _close(spin, vec(new.angVel), scale, f"angular velocity {kind}")


def free_equals_predicted() -> None:
    """Where nothing touches, the velocities without contacts are those with contacts."""
    for without, with_contacts in zip(cd().freeVelocities(), cd().predictedVelocities()):
        assert (without is None) == (with_contacts is None)
        if without is not None:
            assert tuple(without[0]) == tuple(with_contacts[0]) and tuple(without[1]) == tuple(with_contacts[1])


def _newton():
    return engine("NewtonIntegrator")


def _norm(matrix) -> float:
    return float(np.sqrt(sum(matrix[i, j] ** 2 for i in range(3) for j in range(3))))


def _close(found: np.ndarray, expected: np.ndarray, scale: float, what: str) -> None:
    error = np.abs(found - expected).max()
    text = f"{what}: predicted {found}, realised {expected}, error {error:.2e} of {scale:.2e}"
    assert error <= RELATIVE * scale, text
