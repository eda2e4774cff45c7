# SPDX-License-Identifier: GPL-2.0-or-later
"""Triaxial compression: six rigid walls, three of them bodies under force, confine a packing and shear it."""
import math

from yade import pack
from yade.utils import *

import contactdynamics
from contactdynamics import triaxial

# start of the script
radius, pressure = 0.01, 1e3
inertial = 2 * radius * math.sqrt(2600 / pressure)
walls = triaxial.box((0, 0, 0), (0.14, 0.14, 0.14))
balls = pack.SpherePack()
balls.makeCloud((0, 0, 0), (0.14, 0.14, 0.14), rMean=radius, rRelFuzz=0.1, num=150, seed=1)
balls.toSimulation(material=FrictMat(density=2600, frictionAngle=0.4))
O.engines = triaxial.engines(walls, stress=-pressure, maxStrainRate=0.5 / inertial)
O.dt = 0.03 * inertial
O.run(600, True)
confined = triaxial.report()
triaxial.shear(rate=-0.01 / inertial, axis="z")
O.run(500, True)
sheared = triaxial.report()
# end of the script

print("confined:", confined)
print("sheared:", sheared, "mobilised friction angle [degree]:", sheared.mobilisedFriction)
assert all(abs(s / -pressure - 1) < 0.01 for s in confined.wallStress)
assert sheared.strain[2] < -0.14 and sheared.mobilisedFriction > 10
