# SPDX-License-Identifier: GPL-2.0-or-later
"""A periodic cell under pressure: a gas of hard balls is compressed, then sheared at constant pressure."""
import math

from yade import pack
from yade.utils import *

import contactdynamics

# start of the script
radius, pressure = 0.01, 1e3
inertial = 2 * radius * math.sqrt(2600 / pressure)  # time in which the pressure moves a grain by its size [s]
O.periodic = True
O.cell.setBox(0.14, 0.14, 0.14)
balls = pack.SpherePack()
balls.makeCloud((0, 0, 0), O.cell.size, rMean=radius, rRelFuzz=0.1, num=150, periodic=True, seed=1)
balls.toSimulation(material=FrictMat(density=2600, frictionAngle=0.3))
cell = contactdynamics.ContactDynamicsCellController(stress=-pressure * Matrix3.Identity, stressMask=7, maxStrainRate=0.5 / inertial)
engines = contactdynamics.engines(gravity=(0, 0, 0))
O.engines = engines[:-2] + [cell] + engines[-2:]  # before the ContactDynamicsEngine
O.dt = 0.03 * inertial
O.run(600, True)
confined = getStress()
cell.velGrad = Matrix3(0, 0.01 / inertial, 0, 0, 0, 0, 0, 0, 0)  # simple shear, still under pressure on all sides
O.run(200, True)
# end of the script

print("stress after compression [Pa]:", [confined[i, i] for i in range(3)], "packing fraction:", 1 - porosity())
print("stress in shear [Pa]:", [cell.currentStress[i, i] for i in range(3)], "shear stress:", cell.currentStress[0, 1])
assert all(abs(confined[i, i] / -pressure - 1) < 0.01 for i in range(3))
assert cell.currentStress[0, 1] > 0.1 * pressure and O.cell.trsf[0, 1] > 0
