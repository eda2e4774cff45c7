# SPDX-License-Identifier: GPL-2.0-or-later
"""A ball on an incline: it rolls while tan(slope) < 3.5 mu and slips above, with the accelerations of the textbook."""
from math import atan, cos, sin, tan

from yade.utils import *

import contactdynamics


def acceleration(slope, friction, steps=200):
    """Mean acceleration [m/s2] along an incline; the incline is a level wall under a tilted gravity."""
    # start of the script
    O.reset()
    O.materials.append(FrictMat(frictionAngle=atan(friction)))
    O.bodies.append([wall(0, axis=2), sphere((0, 0, 0.01), 0.01)])
    O.engines = contactdynamics.engines(gravity=(9.81 * sin(slope), 0, -9.81 * cos(slope)), tolerance=1e-10)
    O.dt = 1e-3
    O.run(steps, True)
    # end of the script
    return O.bodies[1].state.vel[0] / O.time


mu = 0.2
for slope in (0.3, 0.8):  # tan is 0.31 and 1.03, the border 3.5 mu lies at 0.7
    rolling = tan(slope) < 3.5 * mu
    expected = 5 / 7 * 9.81 * sin(slope) if rolling else 9.81 * (sin(slope) - mu * cos(slope))
    computed = acceleration(slope, mu)
    print(f"slope {slope} rad: {'rolls' if rolling else 'slips'}, {computed:.6f} m/s2, textbook {expected:.6f} m/s2")
    assert abs(computed / expected - 1) < 1e-6
