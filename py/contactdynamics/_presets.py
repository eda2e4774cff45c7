# SPDX-License-Identifier: GPL-2.0-or-later
"""Ready-made engine lists."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from yade import Vector3, wrapper

from . import _plugin


def engines(
    gravity: Sequence[float] = (0, 0, -9.81),
    tolerance: float = 1e-4,
    maxIterations: int = 3000,
    contactLaw: str = "quasiInelasticShock",
    timeStepper: bool | Any = False,
    collider: Any = None,
    **more: Any,
) -> list:
    """Return the complete ``O.engines`` of a Contact Dynamics scene of Sphere, Polyhedra, Box, Wall, Facet and Clump bodies.

    The list is ForceResetter, InsertionSortCollider, InteractionLoop, ContactDynamicsEngine (label ``cd``) and
    NewtonIntegrator without damping (label ``newton``). Engines of your own that set velocities go right behind ForceResetter, those
    that add forces between it and ``cd``, recorders and controllers behind the NewtonIntegrator::

        O.engines = contactdynamics.engines(gravity=(0, 0, -9.81)) + [PyRunner(command="report()", iterPeriod=100)]

    :param gravity: acceleration of gravity [m/s2], global axes
    :param tolerance: bound on the residual of the solve [-], > 0 (``ContactDynamicsEngine.tolerance``)
    :param maxIterations: largest number of sweeps a step, >= 1 (``ContactDynamicsEngine.maxIterations``)
    :param contactLaw: ``quasiInelasticShock``, ``velocitySignorini`` or ``signorini``, Jean (1999) eqs. (25), (23), (24)
    :param timeStepper: True puts a ContactDynamicsTimeStepper (label ``timeStepper``) with its defaults between ForceResetter and
        collider, so that ``O.dt`` follows the motion; a ContactDynamicsTimeStepper of your own is put there as it is
    :param collider: an InsertionSortCollider of your own, such as ``InsertionSortCollider([], allowBiggerThanPeriod=True)``; it gets the functors
        of this list, and ``verletDist`` 0. Default: a new one
    :param more: further attributes of ContactDynamicsEngine, such as ``warmStart=False``, ``acceleration="none"`` (the plain Gauss-Seidel
        loop of the paper) or ``onNonConvergence="raise"``
    :raises ValueError: gravity is not three numbers, or an attribute has a value that is not admissible; its message names attribute, value and what is allowed
    :raises AttributeError: ContactDynamicsEngine has no attribute of that name
    """
    try:
        gravity = Vector3(*gravity)
    except TypeError as error:
        raise ValueError(f"gravity = {gravity!r}: it must be three numbers [m/s2]") from error
    for name in more:
        if not hasattr(wrapper.ContactDynamicsEngine, name):
            raise AttributeError(f"ContactDynamicsEngine has no attribute {name!r}")
    more.setdefault("label", "cd")
    if timeStepper is True:
        timeStepper = wrapper.ContactDynamicsTimeStepper(label="timeStepper")
    if collider is None:
        collider = wrapper.InsertionSortCollider()
    collider.boundDispatcher.functors = [
        wrapper.Bo1_Sphere_Aabb_Proximity(),
        wrapper.Bo1_Polyhedra_Aabb_Proximity(),
        wrapper.Bo1_Box_Aabb_Proximity(),
        wrapper.Bo1_Facet_Aabb_Proximity(),
        wrapper.Bo1_Wall_Aabb_Proximity(),
    ]
    # Contact Dynamics steps are long: bodies move a good part of the margin in each of them, so sorting every step costs less than the larger
    # margin that would make it worth to skip some.
    collider.verletDist = 0
    _plugin.showBodiesToCollider()
    return [
        wrapper.ForceResetter(),
        *([timeStepper] if timeStepper else []),
        collider,
        wrapper.InteractionLoop(
            [
                wrapper.Ig2_Sphere_Sphere_ScGeom_Proximity(),
                wrapper.Ig2_Box_Sphere_ScGeom_Proximity(),
                wrapper.Ig2_Facet_Sphere_ScGeom_Proximity(),
                wrapper.Ig2_Wall_Sphere_ScGeom_Proximity(),
                wrapper.Ig2_Sphere_Polyhedra_ScGeom_Proximity(),
                wrapper.Ig2_Polyhedra_Polyhedra_ManifoldGeom(),
                wrapper.Ig2_Box_Polyhedra_ManifoldGeom(),
                wrapper.Ig2_Facet_Polyhedra_ManifoldGeom(),
                wrapper.Ig2_Wall_Polyhedra_ManifoldGeom(),
                wrapper.Ig2_Box_Box_ManifoldGeom(),
                wrapper.Ig2_Facet_Box_ManifoldGeom(),
                wrapper.Ig2_Wall_Box_ManifoldGeom(),
            ],
            [
                wrapper.Ip2_FrictMat_FrictMat_ContactDynamicsPhys(),
                wrapper.Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys(),
            ],
            [wrapper.Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb()],
        ),
        wrapper.ContactDynamicsEngine(
            tolerance=tolerance, maxIterations=maxIterations, contactLaw=contactLaw, **more
        ),
        wrapper.NewtonIntegrator(damping=0, gravity=gravity, label="newton"),
    ]
