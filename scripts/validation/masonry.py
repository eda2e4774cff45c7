# SPDX-License-Identifier: GPL-2.0-or-later
"""Short words for the scenes of dry masonry in this folder. All scenes lie in the x-z plane; along y a body is one unit deep or what `depth` says."""

from yade import polyhedra_utils
import math

from yade import utils
from yade.utils import *

import contactdynamics

G = 9.81


def stone(friction):
    """A new material with the Coulomb coefficient `friction`."""
    return O.materials[O.materials.append(FrictMat(density=2000, frictionAngle=math.atan(friction), young=1e9, poisson=0.2))]


def prism(outline, material, depth=1.0):
    """A body with the convex polygon `outline` in x, z as its cross-section; returns its id."""
    return O.bodies.append(polyhedra_utils.polyhedra(material, v=[Vector3(x, y, z) for x, z in outline for y in (-depth / 2, depth / 2)]))


def equip(dt, gravity=(0, 0, -G), **more):
    more.setdefault("tolerance", 1e-6)
    more.setdefault("maxIterations", 3000)
    more.setdefault("onNonConvergence", "ignore")
    O.engines = contactdynamics.engines(gravity=gravity, **more)
    O.dt = dt


def moved(number, place):
    """Distance of a body from where it was [m]."""
    return (O.bodies[number].state.pos - place).norm()
