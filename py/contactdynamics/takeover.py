# SPDX-License-Identifier: GPL-2.0-or-later
"""Hand a packing made with a soft contact law over to Contact Dynamics."""

from __future__ import annotations

from typing import Any

from yade import O, utils


def takeOver(engines: list, dt: float) -> int:
    """Replace ``O.engines`` and ``O.dt`` so that the forces of the soft contacts become the first guess of Contact Dynamics.

    Which forces hold a packing of rigid grains depends on its history (Jean 1999, section 8). With the soft forces to start from, a packing at
    rest is still at rest in the first step; from nothing, another set of forces might be found, and grains that were wedged slide. Positions and
    velocities stay. Overlaps are then removed by penetration repair, if ``ContactDynamicsEngine.repairRate`` is not 0.

    :param engines: the new engine list, for example ``contactdynamics.engines(repairRate=0.1)``
    :param dt: the new time step [s], > 0
    :returns: number of contacts whose force was taken over; in a periodic cell 0 (contacts are found anew there)
    :raises ValueError: dt not positive
    """
    if not dt > 0:
        raise ValueError(f"dt = {dt!r}: the time step must be positive")
    forces = {}
    if not O.periodic:
        for contact in O.interactions:
            if contact.isReal and hasattr(contact.phys, "shearForce"):
                forces[contact.id1, contact.id2] = contact.phys.normalForce + contact.phys.shearForce
    O.interactions.clear()
    O.engines = engines
    O.dt = dt
    return sum(_start(pair, force * dt) for pair, force in forces.items())


def _start(pair: tuple[int, int], impulse: Any) -> bool:
    """Create the contact of a pair with the functors of the new engines; False if they make no Contact Dynamics contact of it."""
    contact = utils.createInteraction(*pair)
    if contact is None or not hasattr(contact.phys, "impulse"):
        return False
    contact.phys.impulse = impulse if contact.id1 == pair[0] else -impulse
    return True
