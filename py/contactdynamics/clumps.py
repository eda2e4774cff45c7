# SPDX-License-Identifier: GPL-2.0-or-later
"""Taking clumps apart and putting them together in mid-run, with the motion kept.

YADE stops a clump whenever its list of members changes (``O.bodies.clump``, ``addToClump``, ``releaseFromClump``), and leaves the angular momentum of
the old clump behind. The functions here do the same to the lists, and then give every body the velocity that the laws of motion ask for::

    from contactdynamics import clumps
    clumps.release(member, clump)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from yade import O, Vector3


def _body(number: int, what: str) -> Any:
    body = O.bodies[number] if 0 <= number < len(O.bodies) else None
    if body is None:
        raise ValueError(f"{what} {number}: there is no such body")
    return body


def _clump(number: int) -> Any:
    body = _body(number, "clump")
    if not body.isClump:
        raise ValueError(f"clump {number}: body #{number} is no clump")
    return body


def _times(factors: Vector3, vector: Vector3) -> Vector3:
    return Vector3(*(a * b for a, b in zip(factors, vector)))


def _spin_momentum(body: Any) -> Vector3:
    """Angular momentum about the mass centre, as the integrator keeps it."""
    s = body.state
    return Vector3(s.angMom) if body.aspherical else _times(s.inertia, s.angVel)


def _spin(body: Any) -> Vector3:
    """Angular velocity that belongs to the angular momentum; ``angVel`` of aspherical bodies is that of the middle of the step."""
    s = body.state
    if not body.aspherical or s.blockedDOFs:
        return Vector3(s.angVel)
    return s.ori * _times(Vector3(*(1 / i for i in s.inertia)), s.ori.conjugate() * s.angMom)


def _set_motion(body: Any, velocity: Vector3, spin: Vector3) -> None:
    s = body.state
    s.vel, s.angVel = velocity, spin
    if body.aspherical:
        s.angMom = s.ori * _times(s.inertia, s.ori.conjugate() * spin)
    if body.isClump:
        for number in body.shape.members:
            member = O.bodies[number].state
            member.vel, member.angVel = velocity + spin.cross(member.pos - s.pos), spin


def release(member: int, clump: int, discretization: int = 0) -> None:
    """Take a member out of a clump; it goes on with the rigid motion, and so does the rest. With only two members both are set free.

    Linear and angular momentum stay what they were, to round-off, if the masses of member and rest add up to that of the clump
    (members that do not overlap).

    :param member: id of the member
    :param clump: id of the clump
    :param discretization: for the mass and inertia of what is left, as in ``O.bodies.releaseFromClump``
    :raises ValueError: an id is not that of a body, of a clump, or of a member of this clump
    """
    whole = _clump(clump)
    if member not in whole.shape.members:
        raise ValueError(f"member {member}: body #{member} is not in clump #{clump}")
    if len(whole.shape.members) <= 2:
        dissolve(clump)
        return
    centre, velocity, spin = Vector3(whole.state.pos), Vector3(whole.state.vel), _spin(whole)
    O.bodies.releaseFromClump(member, clump, discretization)
    for body in (whole, O.bodies[member]):
        _set_motion(body, velocity + spin.cross(body.state.pos - centre), spin)


def dissolve(clump: int) -> list[int]:
    """Set all members of a clump free and erase the clump; returns the ids of the members. Momentum is kept as by :func:`release`.

    :raises ValueError: the id is not that of a clump
    """
    whole = _clump(clump)
    centre, velocity, spin = Vector3(whole.state.pos), Vector3(whole.state.vel), _spin(whole)
    members = sorted(whole.shape.members)
    O.bodies.erase(clump, False)
    for number in members:
        body = O.bodies[number]
        _set_motion(body, velocity + spin.cross(body.state.pos - centre), spin)
    return members


def _momenta(bodies: Iterable[Any]) -> tuple[Vector3, Vector3]:
    """Linear momentum, and angular momentum about the origin."""
    linear, angular = Vector3(0, 0, 0), Vector3(0, 0, 0)
    for body in bodies:
        p = body.state.mass * body.state.vel
        linear += p
        angular += body.state.pos.cross(p) + _spin_momentum(body)
    return linear, angular


def _give(clump: int, linear: Vector3, angular: Vector3) -> None:
    body = O.bodies[clump]
    s = body.state
    own = s.ori.conjugate() * (angular - s.pos.cross(linear))
    _set_motion(body, linear / s.mass, s.ori * _times(Vector3(*(1 / i for i in s.inertia)), own))


def join(ids: Sequence[int], discretization: int = 0) -> int:
    """Make one clump of free bodies, as if they stuck together in a perfectly inelastic impact; returns its id.

    Linear and angular momentum are kept, to round-off. Motion that the bodies had relative to each other is lost with its energy.

    :param ids: bodies that stand alone, at least two, free to move (``O.bodies.clump`` is for others)
    :param discretization: as in ``O.bodies.clump``
    :raises ValueError: fewer than two, or a body that does not exist, is in a clump or is not free to move in all directions
    """
    bodies = [_body(number, "body") for number in ids]
    if len(bodies) < 2:
        raise ValueError(f"ids = {list(ids)}: a clump needs at least two bodies")
    for body in bodies:
        if not body.isStandalone or body.state.blockedDOFs:
            raise ValueError(f"body #{body.id}: only bodies that stand alone and have no blocked degrees of freedom can be joined")
    momenta = _momenta(bodies)
    clump = O.bodies.clump(list(ids), discretization)
    _give(clump, *momenta)
    return clump


def add(ids: Sequence[int], clump: int, discretization: int = 0) -> None:
    """Add free bodies to a clump that is free to move; momentum and errors as for :func:`join`."""
    whole = _clump(clump)
    if whole.state.blockedDOFs:
        raise ValueError(f"clump #{clump}: it has blocked degrees of freedom ({whole.state.blockedDOFs}), so momentum cannot be kept")
    bodies = [_body(number, "body") for number in ids]
    for body in bodies:
        if not body.isStandalone or body.state.blockedDOFs:
            raise ValueError(f"body #{body.id}: only bodies that stand alone and have no blocked degrees of freedom can be added")
    momenta = _momenta([whole, *bodies])
    O.bodies.addToClump(list(ids), clump, discretization)
    _give(clump, *momenta)
