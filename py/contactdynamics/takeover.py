# SPDX-License-Identifier: GPL-2.0-or-later
"""Hand a packing made with a soft contact law over to Contact Dynamics."""

from __future__ import annotations

import math
from typing import Any

from yade import NewtonIntegrator, O, Sphere, Vector3, utils


def takeOver(engines: list, dt: float, settle: int = 0) -> int:
    """Replace ``O.engines`` and ``O.dt`` so that the forces of the soft contacts become the first guess of Contact Dynamics.

    Which forces hold a packing of rigid grains depends on its history (Jean 1999, section 8). With the soft forces to start from, a packing at
    rest is still at rest in the first step; from nothing, another set of forces might be found, and grains that were wedged slide. Positions and
    velocities stay. Overlaps are then removed by penetration repair, if ``ContactDynamicsEngine.repairRate`` is not 0.

    A packing that loses overlaps of 1e-2 r swells by as much, and here and there a grain that was wedged in by its elastic forces loses its hold.
    Left to itself it falls to its next place. With ``settle`` steps made at once, quasi-statically, it is let down there instead: after each of them all
    free bodies are stopped, and the time step is so small that none gets faster than gravity makes it in 1.5 % of sqrt(r/g), 0.75 % of the speed
    of a fall over one diameter; 1000 steps let a grain down by up to a fifth of a radius. For packings at rest only.

    :param engines: the new engine list, for example ``contactdynamics.engines()``
    :param dt: the new time step [s], > 0
    :param settle: number of quasi-static steps [-], >= 0; 1000 remove overlaps of 1e-2 r. ``O.time`` and ``O.iter`` count them
    :returns: number of contacts whose force was taken over; in a periodic cell 0 (contacts are found anew there)
    :raises ValueError: dt not positive, or settle negative
    """
    if not dt > 0:
        raise ValueError(f"dt = {dt!r}: the time step must be positive")
    if settle < 0:
        raise ValueError(f"settle = {settle!r}: the number of steps must not be negative")
    forces = {}
    if not O.periodic:
        for contact in O.interactions:
            if contact.isReal and hasattr(contact.phys, "shearForce"):
                forces[contact.id1, contact.id2] = contact.phys.normalForce + contact.phys.shearForce
    O.interactions.clear()
    O.engines = engines
    O.dt = dt
    taken = sum(_start(pair, force * dt) for pair, force in forces.items())
    _settle(settle)
    return taken


def _settle(number: int) -> None:
    """Make quasi-static steps; the impulses of the contacts follow the time step by themselves."""
    dt = O.dt
    gravity = max((engine.gravity.norm() for engine in O.engines if isinstance(engine, NewtonIntegrator)), default=0.0)
    radius = min((body.shape.radius for body in O.bodies if isinstance(body.shape, Sphere)), default=0.0)
    slow = 0.015 * math.sqrt(radius / gravity) if gravity > 0 and radius > 0 else dt
    free = [body for body in O.bodies if body.dynamic and not body.isClumpMember]
    still = Vector3(0, 0, 0)
    for _ in range(number):
        O.dt = min(dt, slow)
        O.step()
        for body in free:
            body.state.vel = body.state.angVel = body.state.angMom = still
    O.dt = dt


def _start(pair: tuple[int, int], impulse: Any) -> bool:
    """Create the contact of a pair with the functors of the new engines; False if they make no Contact Dynamics contact of it."""
    contact = utils.createInteraction(*pair)
    if contact is None or not hasattr(contact.phys, "impulse"):
        return False
    contact.phys.impulse = impulse if contact.id1 == pair[0] else -impulse
    return True
