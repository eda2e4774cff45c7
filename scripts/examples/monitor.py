# SPDX-License-Identifier: GPL-2.0-or-later
"""Watching a run: what the solver did, step by step, in a YADE plot, and where the time went."""
import yade.timing
from yade import plot
from yade.utils import *

import contactdynamics

# start of the script
O.bodies.append(wall(0, axis=2))
O.bodies.append([sphere((0.0201 * (k % 5), 0.0201 * (k // 5 % 5), 0.02 + 0.021 * (k // 25)), 0.01) for k in range(100)])
O.engines = contactdynamics.engines(gravity=(0, 0, -9.81)) + [
    PyRunner(command="plot.addData(t=O.time, contacts=cd.activeContacts, iterations=cd.iterations, residual=cd.residual)", iterPeriod=1)
]
O.dt = 1e-3
O.timingEnabled = True
O.run(300, True)
plot.plots = {"t": ("contacts", None, "iterations")}  # plot.plot() shows it; plot.saveDataTxt(...) writes the numbers
yade.timing.stats()  # collect, solve and apply appear below ContactDynamicsEngine
# end of the script

assert len(plot.data["residual"]) >= 299 and max(plot.data["contacts"]) >= 25
