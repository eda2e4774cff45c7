# SPDX-License-Identifier: GPL-2.0-or-later
"""The triaxial box: six rigid walls around a packing, under prescribed stress or at prescribed strain rate.

Build the box, equip the scene, confine, shear::

    box = contactdynamics.triaxial.box((0, 0, 0), (0.2, 0.2, 0.4))
    pack.makeCloud(...).toSimulation()
    O.engines = contactdynamics.triaxial.engines(box, stress=-1e3)
    O.dt = ...
    ...                                   # until contactdynamics.triaxial.report() tells that the packing is at rest
    contactdynamics.triaxial.shear(rate=-0.01)

The loading itself is done by :class:`ContactDynamicsTriaxialController` (label ``triax``).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from yade import FrictMat, Matrix3, O, Vector3, utils, wrapper

from ._presets import engines as _engines

_AXES = {"x": 0, "y": 1, "z": 2}
# The bit of Body.mask that the walls have: they overlap along their edges and must not touch each other.
_WALLS = 1 << 20


def box(low: Sequence[float], high: Sequence[float], friction: float = 0, material: Any = None) -> list[int]:
    """Append six walls (bodies of shape Box, without thickness) around the space between two corners.

    :param low, high: opposite corners of the space inside [m]
    :param friction: Coulomb coefficient of the walls [-], >= 0; the smaller one of wall and grain counts. Default 0: stresses on the
        walls are principal stresses
    :param material: a material of your own instead, a ContactDynamicsMat for example
    :returns: their ids at -x, +x, -y, +y, -z, +z
    :raises ValueError: the corners span no volume, or friction is negative or not finite
    """
    if not all(math.isfinite(a) and math.isfinite(b) and a < b for a, b in zip(low, high, strict=True)):
        raise ValueError(f"low = {tuple(low)}, high = {tuple(high)}: every coordinate of low must be below that of high, and finite")
    if not (friction >= 0 and math.isfinite(friction)):
        raise ValueError(f"friction = {friction!r}: it must be finite and not negative")
    if material is None:
        material = FrictMat(young=1e7, poisson=0.3, frictionAngle=math.atan(friction), density=2600)
    # The walls overhang, so that no grain slips past an edge while they move.
    walls = utils.aabbWalls([Vector3(*low), Vector3(*high)], thickness=0, oversizeFactor=2, material=material)
    for wall in walls:
        wall.mask |= _WALLS
    return O.bodies.append(walls)


def engines(walls: Sequence[int], stress: float | Sequence[float], maxStrainRate: float = math.inf, **more: Any) -> list:
    """Return the complete ``O.engines`` of a triaxial test: those of :func:`contactdynamics.engines` without gravity, and the controller.

    :param walls: the ids that :func:`box` returned
    :param stress: confinement [Pa], negative in compression: one number for all axes, or three
    :param maxStrainRate: bound on the rate at which walls under stress compress a loose packing [1/s], > 0
    :param more: arguments of :func:`contactdynamics.engines`
    :raises ValueError: an attribute has a value that is not admissible; its message names attribute, value and what is allowed
    """
    more.setdefault("gravity", (0, 0, 0))
    goal = Vector3(stress, stress, stress) if isinstance(stress, (int, float)) else Vector3(*stress)
    made = _engines(**more)
    next(e for e in made if isinstance(e, wrapper.InsertionSortCollider)).avoidSelfInteractionMask = _WALLS
    place = next(i for i, e in enumerate(made) if isinstance(e, wrapper.ContactDynamicsEngine))
    made.insert(
        place,
        wrapper.ContactDynamicsTriaxialController(
            walls=list(walls), stress=goal, stressMask=7, maxStrainRate=maxStrainRate, label="triax"
        ),
    )
    return made


def controller() -> Any:
    """The controller of the scene.

    :raises RuntimeError: there is none, or more than one
    """
    found = [e for e in O.engines if isinstance(e, wrapper.ContactDynamicsTriaxialController)]
    if len(found) != 1:
        raise RuntimeError(f"there are {len(found)} engines ContactDynamicsTriaxialController in O.engines, needed is one; see contactdynamics.triaxial.engines()")
    return found[0]


def shear(rate: float, axis: str = "z", resetStrain: bool = True) -> None:
    """Drive one axis at a constant rate of strain; the others stay, or come, under stress.

    :param rate: rate of logarithmic strain [1/s], negative in compression
    :param axis: ``x``, ``y`` or ``z``
    :param resetStrain: measure strain from the present size of the box
    :raises ValueError: axis is another, or rate not finite
    """
    if axis not in _AXES:
        raise ValueError(f"axis = {axis!r}: it must be 'x', 'y' or 'z'")
    control = controller()
    rates = Vector3(0, 0, 0)
    rates[_AXES[axis]] = rate
    control.strainRate = rates
    control.stressMask = 7 & ~(1 << _AXES[axis])
    if resetStrain:
        control.referenceSize = Vector3(0, 0, 0)


@dataclass(frozen=True)
class Report:
    """State of a triaxial box; stress in Pa, positive in tension.

    The held walls carry what the moving ones do less the change of the packing's momentum. That is nothing in the mean, but some per cent from step to
    step while grains rearrange.
    """

    size: Vector3  #: edges between the walls at the start of the last step [m]
    strain: Vector3  #: logarithmic strain along the axes [-]
    wallStress: Vector3  #: normal force between grains and walls over area along the axes, mean of the two walls
    movingWallStress: Vector3  #: likewise, of the moving walls alone: along axes under stress the goal, but for the inertia of the wall
    imbalance: float  #: largest difference between two opposite walls over the largest wall stress [-]
    stress: Matrix3  #: stress tensor of all contacts, walls included, over the volume of the box
    packingFraction: float  #: volume of the grains (spheres, polyhedra; members of clumps in full) over that of the box [-]

    @property
    def mobilisedFriction(self) -> float:
        """Angle whose sine is (s1 - s3) / (s1 + s3), of the largest and smallest wall stress [degree]; 0 without stress."""
        largest, smallest = -min(self.wallStress), -max(self.wallStress)
        return math.degrees(math.asin((largest - smallest) / (largest + smallest))) if largest + smallest > 0 else 0.0


def report() -> Report:
    """Measure the box of the scene after a step.

    :raises RuntimeError: there is no controller in O.engines, or no step has been made
    """
    control = controller()
    size = Vector3(control.size)
    volume = size[0] * size[1] * size[2]
    if not volume > 0:
        raise RuntimeError("contactdynamics.triaxial.report: no step has been made yet, so the size of the box is not known")
    pressures = [_force(number)[place // 2] * (1, -1)[place % 2] * size[place // 2] / volume for place, number in enumerate(control.walls)]
    means = [0.5 * (pressures[2 * axis] + pressures[2 * axis + 1]) for axis in range(3)]
    differences = [abs(pressures[2 * axis] - pressures[2 * axis + 1]) for axis in range(3)]
    moving = pressures[1::2]
    largest = max(abs(p) for p in pressures)
    grains = sum(_volume(b.shape) for b in O.bodies)
    return Report(
        size=size,
        strain=Vector3(control.strain),
        wallStress=Vector3(*means),
        movingWallStress=Vector3(*moving),
        imbalance=max(differences) / largest if largest > 0 else 0.0,
        stress=utils.getStress(volume),
        packingFraction=grains / volume,
    )


def _volume(shape: Any) -> float:
    """Volume of a sphere or polyhedron [m3], 0 of anything else. Members of a clump that overlap count in full."""
    if isinstance(shape, wrapper.Sphere):
        return 4 / 3 * math.pi * shape.radius**3
    return shape.GetVolume() if isinstance(shape, wrapper.Polyhedra) else 0.0


def _force(number: int) -> Vector3:
    """Force of the contacts on a body in the last step [N]."""
    total = Vector3(0, 0, 0)
    for contact in O.bodies[number].intrs():
        if contact.isReal:
            force = contact.phys.normalForce + contact.phys.shearForce
            total += force if contact.id2 == number else -force
    return total
