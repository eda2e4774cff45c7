# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact Dynamics for YADE: rigid grains under the Signorini condition and Coulomb's law, after Jean (1999).

After ``import contactdynamics`` the classes are there by name, like YADE's own; ``from contactdynamics import *`` adds :func:`engines`. The modules
of the package (``contactdynamics.report``, ``contactdynamics.fclib``, ...) are imported when they are first used.
"""

import importlib
from pathlib import Path
from types import ModuleType

from . import _loading

_classes = _loading.load()
globals().update(_classes)
_loading.name_in_session(_classes)

from ._presets import engines  # noqa: E402 - needs the classes

__all__ = [*_classes, "engines"]


def __dir__() -> list[str]:
    return [*__all__, *sorted(file.stem for file in Path(__file__).parent.glob("[!_]*.py"))]


def __getattr__(name: str) -> ModuleType:
    # Not imported above: numpy, h5py and matplotlib take longer than everything else.
    if not name.startswith("_"):
        try:
            return importlib.import_module(f".{name}", __name__)
        except ModuleNotFoundError as error:
            if error.name != f"{__name__}.{name}":
                raise
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
