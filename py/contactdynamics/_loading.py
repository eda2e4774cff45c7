# SPDX-License-Identifier: GPL-2.0-or-later
"""Brings the compiled classes into the running YADE, after making sure that they fit."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType

from . import _build

_REMEDY = (
    "Use Debian's package (apt-get install yade) and start it as `yade`, or build contactdynamics for this YADE: "
    "cmake -DYADE_EXECUTABLE=<this yade> -DYADE_SOURCE_DIR=<tree of its sources>."
)


def load() -> dict[str, type]:
    """Register the classes of the plugin with YADE and return them by name.

    Loading again returns the same classes and changes nothing. The scene is left alone, but a dispatcher made before
    the first load has no room for new classes: define ``O.engines`` after importing.

    :raises ImportError: YADE cannot be imported, is of another version or flavour, or lays out its objects differently
    """
    wrapper = _import_yade()
    # The plugin is opened only now. Another flavour of YADE has libraries of the same names with other number types in
    # them: opening the plugin there would not fail, but compute with garbage.
    try:
        plugin = importlib.import_module("._plugin", __package__)
    except ImportError as error:
        raise ImportError(
            f"The compiled part of contactdynamics cannot be opened ({error}). Build or install it again."
        ) from error
    _check_layout(plugin)
    names = plugin.registerClasses()
    if not names:
        raise ImportError(
            "Another copy of contactdynamics is already loaded in this process. Start YADE again to use this one."
        )
    return {name: getattr(wrapper, name) for name in names}


def name_in_session(classes: dict[str, type]) -> None:
    """Let sessions and scripts of YADE use the classes by name, as they use YADE's own: ``ContactDynamicsEngine?``.

    Names that a script has given to something else stay as they are.
    """
    main = sys.modules["__main__"]
    spaces = [sys.modules["yade"]]
    if getattr(main, "O", None) is spaces[0].O:  # `from yade import *` has been done there, as YADE does at its start
        spaces.append(main)
    for space in spaces:
        for name, made in classes.items():
            vars(space).setdefault(name, made)


def _import_yade() -> ModuleType:
    """Return the module yade.wrapper of a YADE that the plugin was built for."""
    try:
        import yade.config
    except Exception as error:  # YADE's own start-up raises all kinds
        raise ImportError(
            f"contactdynamics works inside YADE, and `import yade` failed ({type(error).__name__}: {error}). Run your "
            "script as `yade script.py`; or run it with the Python that YADE uses (the first line of the program "
            "`yade` names it) and YADE's package directory in PYTHONPATH (Debian: /usr/lib/<architecture>/yade-double/py)."
        ) from error
    check_build(yade.config)
    return importlib.import_module("yade.wrapper")


def check_build(config: ModuleType) -> None:
    """Compare version, precision and features of a YADE with those that the plugin was built for.

    :param config: its module ``yade.config``
    :raises ImportError: naming what was expected and found
    """
    if config.highPrecisionBits != 64:
        raise ImportError(
            "contactdynamics needs YADE in double precision (64 bits); this one computes with "
            f"{config.highPrecisionBits} bits (yade{config.suffix}, {config.highPrecisionName}). "
            f"Start your script with `yade` instead of `yade{config.suffix}`."
        )
    if config.version != _build.VERSION:
        raise ImportError(
            f"contactdynamics was built for YADE {_build.VERSION}; this is YADE {config.version} in {config.libDir}. "
            f"{_REMEDY}"
        )
    features = _build.LAYOUT_FEATURES.intersection(config.features)
    if features != _build.FEATURES:
        raise ImportError(
            f"contactdynamics was built for a YADE with the features {sorted(_build.FEATURES)}; this one, in "
            f"{config.libDir}, has {sorted(features)} of those that change YADE's classes. {_REMEDY}"
        )


def _check_layout(plugin: ModuleType) -> None:
    disagreements = plugin.layoutDisagreements(plugin.compiledLayout())
    if disagreements:
        raise ImportError(
            "The classes of the running YADE are laid out differently from what contactdynamics was compiled for:\n  "
            + "\n  ".join(disagreements)
            + f"\n{_REMEDY}"
        )
