# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact Dynamics for YADE: rigid grains under the Signorini condition and Coulomb's law, after Jean (1999).

``from contactdynamics import *`` in a script of YADE gives the classes and :func:`engines`.
"""

from . import _loading

_classes = _loading.load()
globals().update(_classes)

from ._presets import engines  # noqa: E402 - needs the classes

__all__ = [*_classes, "engines"]
