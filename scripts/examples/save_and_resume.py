# SPDX-License-Identifier: GPL-2.0-or-later
"""Saving: the impulses are saved with the contacts, so a loaded scene continues with the same bits."""
import os
import tempfile

from yade.utils import *

import contactdynamics

file = os.path.join(tempfile.mkdtemp(), "column.yade.gz")
# start of the script
O.bodies.append(wall(0, axis=2))
O.bodies.append([sphere((0.001 * (k % 2), 0, 0.02 + 0.021 * k), 0.01) for k in range(5)])
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81))
O.dt = 1e-3
O.run(100, True)
O.save(file)
O.run(100, True)
straight = [tuple(body.state.pos) for body in O.bodies]
O.load(file)  # needs "import contactdynamics" before, in a new session, too
O.run(100, True)
resumed = [tuple(body.state.pos) for body in O.bodies]
# end of the script

print("largest difference:", max(abs(a - b) for one, two in zip(straight, resumed) for a, b in zip(one, two)), "m")
assert straight == resumed
