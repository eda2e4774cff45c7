# SPDX-License-Identifier: GPL-2.0-or-later
"""Two-dimensional scenes: disks that move in a coordinate plane.

YADE has no disks; a sphere with the mass and inertia of a disk, kept in its plane by ``state.blockedDOFs``, is one. The engine recognises such
scenes by itself (``ContactDynamicsEngine.plane``)::

    from contactdynamics import plane
    O.bodies.append([plane.disk((0.02 * k, 0), 0.01) for k in range(10)])
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from yade import Vector3, utils

#: Degrees of freedom that are blocked for motion in each plane, as ``state.blockedDOFs`` writes them (x: translation, X: rotation).
BLOCKED = {"xy": "zXY", "yz": "xYZ", "zx": "yZX"}

_AXES = {"xy": (0, 1, 2), "yz": (1, 2, 0), "zx": (2, 0, 1)}  # first and second axis of the plane, and its normal


def _axes(plane: str) -> tuple[int, int, int]:
    if plane not in _AXES:
        raise ValueError(f'plane = {plane!r}: allowed are "xy", "yz" and "zx"')
    return _AXES[plane]


def _require_positive(name: str, value: float) -> None:
    if not (value > 0 and math.isfinite(value)):
        raise ValueError(f"{name} = {value!r}: it must be positive and finite")


def disk(
    center: Sequence[float],
    radius: float,
    plane: str = "xy",
    thickness: float = 1.0,
    **more: Any,
) -> Any:
    """Return a body that is a disk in a coordinate plane: a sphere with a disk's mass and inertia and blocked degrees of freedom.

    Mass is pi r^2 t rho; the moment of inertia about the axis of the disk is m r^2 / 2, about a diameter m (r^2 / 4 + t^2 / 12).

    :param center: two coordinates in the plane (third one 0), in the order of the plane's name, or all three [m]; disks of a scene need the
        same third one, exactly, or their contacts do not lie in the plane
    :param radius: [m], > 0
    :param plane: ``xy`` (default), ``yz`` or ``zx``
    :param thickness: t along the normal of the plane [m], > 0; default 1, so that forces are those per metre
    :param more: further arguments of ``yade.utils.sphere``, such as ``material``, ``color``, ``mask``; ``fixed=True`` blocks everything
    :raises ValueError: plane, radius or thickness not admissible, or center neither of length 2 nor 3
    """
    axes = _axes(plane)
    _require_positive("radius", radius)
    try:
        coordinates = [float(x) for x in center]
    except (TypeError, ValueError):
        coordinates = []
    if len(coordinates) not in (2, 3):
        raise ValueError(f"center = {center!r}: it must have two coordinates (in the plane) or three")
    position = Vector3(*coordinates) if len(coordinates) == 3 else Vector3(0, 0, 0)
    if len(coordinates) == 2:
        position[axes[0]], position[axes[1]] = coordinates
    body = utils.sphere(position, radius, **more)
    make_disk(body, plane, thickness)
    return body


def make_disk(body: Any, plane: str = "xy", thickness: float = 1.0) -> None:
    """Turn a sphere into a disk: sets ``state.mass``, ``state.inertia`` and, unless the body is fixed, ``state.blockedDOFs``.

    The position stays; velocities out of the plane are set to zero. Parameters as for :func:`disk`.

    :raises ValueError: the body is not a sphere of its own (a member of a clump has no mass of its own), or an argument is not admissible
    """
    normal = _axes(plane)[2]
    _require_positive("thickness", thickness)
    if type(body.shape).__name__ != "Sphere" or body.isClumpMember:
        raise ValueError(f"body #{body.id}: only a sphere that is not in a clump can be made a disk")
    radius = body.shape.radius
    mass = math.pi * radius**2 * thickness * body.material.density
    inertia = Vector3(1, 1, 1) * mass * (radius**2 / 4 + thickness**2 / 12)
    inertia[normal] = mass * radius**2 / 2
    body.state.mass, body.state.inertia = mass, inertia
    restrict([body], plane)


def restrict(bodies: Iterable[Any], plane: str = "xy") -> None:
    """Keep bodies of any kind in a plane: block the degrees of freedom and stop the motion that leads out of it. Mass and inertia stay.

    For a clump give the clump itself; its members follow. Bodies that cannot move at all stay so.

    :param bodies: bodies, for example ``[O.bodies[i] for i in ids]``
    :param plane: ``xy`` (default), ``yz`` or ``zx``
    :raises ValueError: another plane, or a member of a clump
    """
    normal = _axes(plane)[2]
    for body in bodies:
        if body.isClumpMember:
            raise ValueError(f"body #{body.id} is a member of clump #{body.clumpId}: restrict the clump")
        if not body.dynamic:
            continue
        body.state.blockedDOFs = BLOCKED[plane]
        velocity, spin = Vector3(body.state.vel), Vector3(0, 0, 0)
        velocity[normal] = 0
        spin[normal] = body.state.angVel[normal]
        body.state.vel, body.state.angVel = velocity, spin
