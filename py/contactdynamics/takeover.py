# SPDX-License-Identifier: GPL-2.0-or-later
"""Hand a packing made with a soft contact law over to Contact Dynamics."""

from __future__ import annotations

import math
import warnings
from typing import Any

from yade import KinematicEngine, NewtonIntegrator, O, PeriodicEngine, Sphere, TimeStepper, Vector3, utils

from . import ContactDynamicsEngine, _plugin

# In units of sqrt(r/g) and sqrt(g r), for the smallest radius r. A grain that falls freely for one step of _REPAIR reaches 0.75 % of the speed
# sqrt(4 g r) of a fall over one diameter. A step of _DESCENT at the speed of descent, or one that gravity makes, is a way of 0.0025 r.
_REPAIR, _DESCENT = 0.015, 0.05
_REST = 5e-4  # a hundredth of the speed that gravity gives in a step of the descent
_CALM, _LISTENED = 20, 300  # steps in a row at rest: with bodies stopped, and then with none
_LONGEST = 10000  # steps: descents of several radii one after the other


def takeOver(engines: list, dt: float, settle: int | None = None) -> int:
    """Replace ``O.engines`` and ``O.dt`` so that the forces of the soft contacts become the first guess of Contact Dynamics.

    Which forces hold a packing of rigid grains depends on its history (Jean 1999, section 8). With the soft forces to start from, a packing at
    rest is still at rest in the first step; from nothing, another set of forces might be found, and grains that were wedged slide. Overlaps
    are removed by penetration repair, if ``ContactDynamicsEngine.repairRate`` is not 0.

    A packing that loses overlaps of 1e-2 r swells by as much, its contacts turn by some hundredths, and here and there a grain that was wedged in
    by its elastic forces loses its hold. In a step of time it would fall. So a packing at rest under gravity is settled at once and quasi-statically:
    overlaps are repaired while all bodies are stopped after every step, too short a one for any to pass 1 % of the speed of a fall over one diameter;
    then what has lost its hold goes down to its next place at a limited pace, and each body is stopped when it gets slower. All bodies are at rest afterwards.
    These steps are numerical means, not a motion in time: engines that drive bodies (``KinematicEngine``), choose the time step or run now
    and then (``PeriodicEngine``: recorders, ``PyRunner``) wait until they are over; ``O.time`` and ``O.iter`` count them.
    Not settled by default are a scene that moves (a body faster than that 1 %, or a periodic cell with a velocity gradient) or is not in equilibrium (a tenth
    of the weight not carried by contacts), one without gravity or spheres, and ``repairRate=0``: there positions and velocities stay as they are.

    :param engines: the new engine list, for example ``contactdynamics.engines()``
    :param dt: the new time step [s], > 0
    :param settle: largest number of quasi-static steps [-], >= 0; 0: none. Default: up to 10,000 where the scene is at rest, as above, and none elsewhere
    :returns: number of contacts whose force was taken over; in a periodic cell 0 (contacts are found anew there)
    :raises ValueError: dt not positive, or settle negative. A packing that is not at rest after the last of the steps is told by a warning
    """
    if not dt > 0:
        raise ValueError(f"dt = {dt!r}: the time step must be positive")
    if settle is not None and settle < 0:
        raise ValueError(f"settle = {settle!r}: the number of steps must not be negative")
    forces = {}
    for contact in O.interactions:
        if contact.isReal and hasattr(contact.phys, "shearForce"):
            forces[contact.id1, contact.id2] = contact.phys.normalForce + contact.phys.shearForce
    O.interactions.clear()
    O.engines = engines
    _plugin.showBodiesToCollider()
    O.dt = dt
    settling = _Settling()
    if settle is None:
        settle = _LONGEST if settling.wanted(forces) else 0
    if settle > 0:
        O.dt = settling.step(_REPAIR)
    taken = 0 if O.periodic else sum(_start(pair, force * O.dt) for pair, force in forces.items())
    if settle > 0:
        settling.run(settle)
    return taken


def _start(pair: tuple[int, int], impulse: Any) -> bool:
    """Create the contact of a pair with the functors of the new engines; False if they make no Contact Dynamics contact of it."""
    contact = utils.createInteraction(*pair)
    if contact is None or not hasattr(contact.phys, "impulse"):
        return False
    contact.phys.impulse = impulse if contact.id1 == pair[0] else -impulse
    return True


class _Settling:
    """Quasi-static steps with the engines and the time step that the scene has now."""

    def __init__(self) -> None:
        self.dt, self.engines = O.dt, O.engines
        self.solver = next((e for e in self.engines if isinstance(e, ContactDynamicsEngine)), None)
        self.fall = sum((e.gravity for e in self.engines if isinstance(e, NewtonIntegrator) and not e.dead), Vector3(0, 0, 0))
        self.gravity = self.fall.norm()
        self.radius = min((b.shape.radius for b in O.bodies if isinstance(b.shape, Sphere)), default=0.0)
        self.speed = math.sqrt(self.gravity * self.radius)
        self.free = [b for b in O.bodies if b.dynamic and not b.isClumpMember]

    def wanted(self, forces: dict[tuple[int, int], Vector3]) -> bool:
        """Whether the scene is at rest under gravity, held by these forces of its contacts, and its overlaps are to be repaired."""
        if self.speed == 0 or self.solver is None or self.solver.repairRate == 0:
            return False
        if O.periodic and O.cell.velGrad.norm() > 0:
            return False
        return all(b.state.vel.norm() <= 0.01 * 2 * self.speed for b in O.bodies) and self._hanging(forces) < 0.1

    def _hanging(self, forces: dict[tuple[int, int], Vector3]) -> float:
        """What is missing to equilibrium, over the weight of all free bodies: 1 for bodies in the air."""
        load = {body.id: body.state.mass * self.fall for body in self.free}
        weight = sum(each.norm() for each in load.values())
        for pair, force in forces.items():
            for number, sign in zip(pair, (-1, 1)):
                body = O.bodies[number]
                number = body.clumpId if body.isClumpMember else number
                if number in load:
                    load[number] += sign * force
        return sum(each.norm() for each in load.values()) / weight if weight > 0 else 1.0

    def step(self, units: float) -> float:
        """A time step, at most that of the scene; the latter, where nothing gives a scale."""
        return min(self.dt, units * self.speed / self.gravity) if self.speed > 0 else self.dt

    def run(self, most: int) -> None:
        """Repair, then let down; the impulses of the contacts follow the time step by themselves."""
        O.engines = [e for e in self.engines if not isinstance(e, (KinematicEngine, PeriodicEngine, TimeStepper))]
        try:
            done = self._repair(most)
            if not self._descend(most - done) and most == _LONGEST:
                warnings.warn(f"takeOver: some bodies are still looking for a hold after {most} quasi-static steps; they go on as free bodies", stacklevel=3)
        finally:
            O.engines = self.engines
            O.dt = self.dt
        self._scale(self.free, 0)

    def _repair(self, most: int) -> int:
        """Steps until no overlap is deeper than 5e-5 of the smallest radius; returns their number."""
        O.dt = self.step(_REPAIR)
        for done in range(1, most + 1):
            O.step()
            self._scale(self.free, 0)
            if self.solver is not None and self.solver.remainingOverlap < 5e-5 * self.radius:
                return done
        return most

    def _descend(self, most: int) -> bool:
        """Let down what has lost its hold; whether all came to rest.

        Bodies gather speed, so that a slow roll off a flat place takes no longer than a fall, up to a limit; a body that gets slower has passed the lowest
        place on its way, and is stopped there. (Stopping all bodies in every step was rejected: a roll that begins slowly never ends.) Once all are at rest
        none is stopped for a while: one that lies on a summit shows it by rolling off.
        """
        O.dt = self.step(_DESCENT)
        before, calm = [0.0] * len(self.free), 0
        for _ in range(most):
            O.step()
            speeds = [body.state.vel.norm() for body in self.free]
            calm = calm + 1 if max(speeds, default=0.0) <= _REST * self.speed else 0
            if calm == _CALM + _LISTENED:
                return True
            before = speeds if calm > _CALM else [self._lower(*each) for each in zip(self.free, speeds, before)]
        return False

    def _lower(self, body: Any, speed: float, before: float) -> float:
        """Stop a body that got slower, and slow down one that is too fast; returns its speed."""
        limit = _DESCENT * self.speed
        if speed < before:
            self._scale([body], 0)
            return 0.0
        if speed > limit:
            self._scale([body], limit / speed)
            return limit * (1 - 1e-3)  # room for the rounding of the product
        return speed

    @staticmethod
    def _scale(bodies: list, factor: float) -> None:
        for body in bodies:
            state = body.state
            state.vel, state.angVel, state.angMom = factor * state.vel, factor * state.angVel, factor * state.angMom
