# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers that describe a packing of grains, for hard (Contact Dynamics) and soft contacts alike.

Every function reads the scene ``O`` as the last step left it and changes nothing. A *contact* means here an interaction that
carries a normal force; candidates at a distance, which Contact Dynamics keeps as well, do not count.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Iterable

import numpy as np
from yade import O, Sphere, utils


@dataclass(frozen=True)
class Packing:
    """State of a packing; lengths are relative to the mean grain radius, forces to the weight of the grains.

    :ivar grains: number of spheres that are free to move
    :ivar contacts: interactions with a normal force > 0
    :ivar meanOverlap: mean overlap of those contacts / mean radius [-], 0 where the bodies touch or are apart
    :ivar maxOverlap: largest overlap / mean radius [-]
    :ivar coordination: contacts per grain, rattlers left out, contacts with walls counted [-]
    :ivar rattlers: grains with fewer than two contacts, as YADE's ``avgNumInteractions(skipFree=True)`` counts them
    :ivar kineticEnergy: kinetic energy of translation per grain / (mean weight x mean radius) [-]
    """

    grains: int
    contacts: int
    meanOverlap: float
    maxOverlap: float
    coordination: float
    rattlers: int
    kineticEnergy: float


def grains() -> list:
    """Bodies that are spheres and free to move, in the order of their ids."""
    return [body for body in O.bodies if isinstance(body.shape, Sphere) and body.dynamic]


def meanRadius() -> float:
    """Mean radius of the free spheres [m].

    :raises ValueError: when the scene has no free sphere.
    """
    radii = [body.shape.radius for body in grains()]
    if not radii:
        raise ValueError("the scene has no free sphere, so there is no mean radius")
    return float(np.mean(radii))


def loadedContacts() -> list:
    """Interactions whose normal force on body 2 is not zero."""
    return [contact for contact in O.interactions if contact.isReal and contact.phys.normalForce.squaredNorm() > 0]


def fabric() -> np.ndarray:
    """Fabric tensor of the contacts that carry a normal force, the mean of n (outer) n over them [-], 3 x 3, global axes; its trace is 1.

    YADE's ``utils.fabricTensor()`` takes all real interactions, candidates at a distance as well.

    :raises ValueError: when no contact carries a normal force.
    """
    normals = np.array([np.array(contact.geom.normal) for contact in loadedContacts()])
    if not len(normals):
        raise ValueError("no contact of the scene carries a normal force, so there is no fabric tensor")
    return normals.T @ normals / len(normals)


def unbalancedForce() -> float:
    """Mean resultant of forces on the free bodies over the mean force of the contacts that carry one [-]; infinite where none does.

    YADE's ``utils.unbalancedForce()`` takes the mean over all real interactions, candidates at a distance as well, and so is larger: a criterion such as
    ``unbalancedForce() < 0.01`` is met later than with a soft law.
    """
    real = sum(contact.isReal for contact in O.interactions)
    loaded = len(loadedContacts())
    return utils.unbalancedForce() * loaded / real if loaded else math.inf


def kineticEnergyPerGrain(gravity: float = 9.81) -> float:
    """Kinetic energy of translation per grain in units of (mean weight x mean radius) [-]; small means at rest.

    Rotation is left out: a grain that spins about its only contact normal meets no resistance from a point contact, soft or hard,
    and goes on for ever in a packing that is at rest otherwise.

    :param gravity: magnitude of the gravity that makes the weight [m/s2], > 0.
    :raises ValueError: the scene has no free sphere
    """
    free = grains()
    energy = sum(0.5 * body.state.mass * body.state.vel.squaredNorm() for body in free)
    return energy / (gravity * sum(body.state.mass for body in free) * meanRadius())


def packing(gravity: float = 9.81) -> Packing:
    """All figures of :class:`Packing` for the scene as it is. Members of a clump count one by one.

    :param gravity: magnitude of the gravity [m/s2].
    :raises ValueError: the scene has no free sphere
    """
    ends = {body.id: 0 for body in grains()}
    contacts = loadedContacts()
    for contact in contacts:
        for body in (contact.id1, contact.id2):
            if body in ends:
                ends[body] += 1
    overlaps = np.array([max(0.0, contact.geom.penetrationDepth) for contact in contacts]) / meanRadius()
    held = [number for number in ends.values() if number > 1]
    return Packing(
        grains=len(ends),
        contacts=len(contacts),
        meanOverlap=float(overlaps.mean()) if len(overlaps) else 0.0,
        maxOverlap=float(overlaps.max()) if len(overlaps) else 0.0,
        coordination=float(np.mean(held)) if held else 0.0,
        rattlers=len(ends) - len(held),
        kineticEnergy=kineticEnergyPerGrain(gravity),
    )


def solidFraction(low: tuple[float, float, float], high: tuple[float, float, float], resolution: int = 200) -> float:
    """Volume of the grains in the box from ``low`` to ``high`` divided by the volume of the box [-].

    Grains that stick out of the box are cut at its faces. Counted by voxels, so good to about 1 / resolution.
    """
    return 1.0 - utils.voxelPorosity(resolution=resolution, start=low, end=high)


def supportForce(ids: Iterable[int]) -> np.ndarray:
    """Sum of the forces on the given bodies in the last step [N], global axes; for walls: what the grains press with."""
    return np.sum([np.array(O.forces.f(i, sync=True)) for i in ids], axis=0)


def supportTorque(ids: Iterable[int], point: Iterable[float] = (0, 0, 0)) -> np.ndarray:
    """Moment of the forces on the given bodies about a point in the last step [N m], global axes; for a drum: what the grains turn it with.

    The forces belong to the places of the bodies before the last step; a driven body has moved since, so its arm is off by one step.
    ``TorqueRecorder`` of YADE 2023.02a takes the arms of bodies off its axis with the wrong sign.
    """
    moments = [
        np.array(O.forces.t(i, sync=True)) + np.cross(np.array(O.bodies[i].state.pos) - np.array(list(point)), np.array(O.forces.f(i, sync=True)))
        for i in ids
    ]
    return np.sum(moments, axis=0)


def table(rows: Iterable[tuple[str, object]]) -> str:
    """Lines ``name   value`` with aligned columns; numbers to four significant digits, integers in full."""

    def text(value: object) -> str:
        if isinstance(value, float):
            return "not finite" if not math.isfinite(value) else f"{value:.4g}"
        return str(value)

    rows = [(name, text(value)) for name, value in rows]
    width = max(len(name) for name, _ in rows)
    return "\n".join(f"  {name:<{width}}  {value}" for name, value in rows)
