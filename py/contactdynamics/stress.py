# SPDX-License-Identifier: GPL-2.0-or-later
"""Moment tensors of bodies, and stresses made of them.

The moment tensor of a body is M = sum of x (outer) r over the contact forces r on it, with x from its mass centre to the point where r acts
(Jean 1999, section 9.3). For a body at rest the mean stress in it is its symmetric part over the volume; tension is positive, as in mechanics. Weight
adds nothing to it, because it acts at the mass centre::

    from contactdynamics import stress
    M = stress.momentTensors()[number]          # 3 x 3 [N m]
    sigma = stress.ofBody(number, volume=V)     # 3 x 3 [Pa]
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from yade import O


def _vec(v: Any) -> np.ndarray:
    return np.array([v[0], v[1], v[2]], dtype=float)


def _pushes(contact: Any) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Points of a contact, in the space of body 1, and the forces on body 2 there."""
    if hasattr(contact.phys, "pointForces"):  # several points, as between faces
        for point, force in zip(contact.geom.points, contact.phys.pointForces):
            yield _vec(point), _vec(force)
    else:
        yield _vec(contact.geom.contactPoint), _vec(contact.phys.normalForce) + _vec(contact.phys.shearForce)


def contactForces() -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
    """All contact forces of the last step, each twice: id of the body, lever arm from the mass centre [m], force on it [N], global axes.

    A member of a clump counts as its clump. Soft contacts of YADE are there as well as those of Contact Dynamics.
    """

    def centre(number: int) -> tuple[int, np.ndarray]:
        body = O.bodies[number]
        own = body.clumpId if body.isClumpMember else number
        return own, _vec(O.bodies[own].state.pos)

    for contact in O.interactions:
        if not (contact.isReal and hasattr(contact.phys, "shearForce")):
            continue
        shift = _vec(O.cell.hSize * contact.cellDist) if O.periodic else np.zeros(3)
        (one, place1), (two, place2) = centre(contact.id1), centre(contact.id2)
        if one == two:
            continue
        for point, force in _pushes(contact):
            yield one, point - place1, -force
            yield two, point - place2 - shift, force


def momentTensors() -> dict[int, np.ndarray]:
    """Moment tensor M = sum of x (outer) r [N m], first index that of the lever arm, of every body that carries a contact force, by its id."""
    tensors: dict[int, np.ndarray] = {}
    for number, arm, force in contactForces():
        if force.any():
            tensors[number] = tensors.get(number, np.zeros((3, 3))) + np.outer(arm, force)
    return tensors


def ofBody(number: int, volume: float) -> np.ndarray:
    """Mean stress sym(M) / V in a body [Pa], tension positive; zero without contact forces.

    Exact in equilibrium. Where the body accelerates, the inertia of its parts is left out, as in most definitions for grains.

    :param number: id of the body, of the clump for members
    :param volume: of the body [m3], > 0
    :raises ValueError: no such body, a member of a clump, or a volume that is not admissible
    """
    body = O.bodies[number] if 0 <= number < len(O.bodies) else None
    if body is None:
        raise ValueError(f"number = {number}: there is no such body")
    if body.isClumpMember:
        raise ValueError(f"number = {number}: the body is a member of clump #{body.clumpId}, whose parts have no moment tensor of their own")
    if not (volume > 0 and math.isfinite(volume)):
        raise ValueError(f"volume = {volume!r}: it must be positive and finite")
    moment = sum((np.outer(arm, force) for own, arm, force in contactForces() if own == number), np.zeros((3, 3)))
    return 0.5 * (moment + moment.T) / volume
