# SPDX-License-Identifier: GPL-2.0-or-later
"""Importing the plugin: only our classes come, the scene stays, and a YADE it does not fit is refused with a reason."""

from __future__ import annotations

import importlib
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import pytest
import yade
import yade.config
from yade import O, utils, wrapper

import contactdynamics
from contactdynamics import _build, _loading, _plugin

PACKAGES = Path(contactdynamics.__file__).parent.parent
YADE_PACKAGES = Path(yade.__file__).parent.parent
FLAVOURS = {"longdouble": 80, "float128": 128, "mpfr150": 498}


def run(command: Sequence[str], packages: Sequence[Path] = (PACKAGES,), **more) -> subprocess.CompletedProcess:
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(map(str, packages)), PYTHONDONTWRITEBYTECODE="1")
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, **more)


def run_script(folder: Path, source: str, program: str = "yade") -> str:
    """Execute a script in a YADE of its own; return what it wrote to the file named `out` in the folder."""
    script = folder / "script.py"
    out = folder / "out"
    script.write_text(f"out = open({str(out)!r}, 'w')\n{source}\nout.close()\n")
    done = run([program, "-n", "-x", str(script)], cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    return out.read_text()


# --- what an import does


def test_import_brings_our_classes_and_nothing_else(tmp_path) -> None:
    written = run_script(
        tmp_path,
        "from yade import wrapper\n"
        "before = dict(vars(wrapper))\n"
        "import contactdynamics\n"
        "added = sorted(name for name in vars(wrapper) if name not in before)\n"
        "changed = [name for name in before if getattr(wrapper, name) is not before[name]]\n"
        "print(added == sorted(contactdynamics._classes), changed, 'ContactDynamicsEngine' in added, file=out)\n",
    )
    assert written == "True [] True\n"


def test_star_import_exports_every_class() -> None:
    names: dict = {}
    exec("from contactdynamics import *", names)
    for name in _plugin.registerClasses():
        assert names[name] is getattr(wrapper, name)
    assert names["engines"] is contactdynamics.engines


def test_import_leaves_the_scene_alone(tmp_path) -> None:
    written = run_script(
        tmp_path,
        "O.bodies.append([sphere((0, 0, 0), 1), sphere((0, 0, 1.9), 1)])\n"
        "O.step(); O.step()\n"
        "kept = list(O.bodies), list(O.engines), O.iter, O.dt, len(O.interactions), dict(O.tags)\n"
        "import contactdynamics\n"
        "now = list(O.bodies), list(O.engines), O.iter, O.dt, len(O.interactions), dict(O.tags)\n"
        "O.step()\n"
        "print(kept == now, O.iter, file=out)\n",
    )
    assert written == "True 3\n"


def test_import_during_a_run(tmp_path) -> None:
    written = run_script(
        tmp_path,
        "O.bodies.append(sphere((0, 0, 0), 1))\n"
        "O.engines = O.engines + [PyRunner(command='import contactdynamics', iterPeriod=1)]\n"
        "O.run(3, True)\n"
        "import sys\n"
        "print(O.iter, 'contactdynamics._plugin' in sys.modules, file=out)\n",
    )
    assert written == "3 True\n"


def test_import_is_silent_and_quick(tmp_path) -> None:
    """Quick in seconds of this process's processor: the clock on the wall also counts what else the machine does."""
    written = run_script(
        tmp_path,
        "import os, sys, time\n"
        "streams = os.dup(1), os.dup(2)\n"
        "caught = os.open('caught', os.O_RDWR | os.O_CREAT)\n"
        "sys.stdout.flush(); os.dup2(caught, 1); os.dup2(caught, 2)\n"
        "start = time.process_time()\n"
        "import contactdynamics\n"
        "spent = time.process_time() - start\n"
        "sys.stdout.flush(); os.dup2(streams[0], 1); os.dup2(streams[1], 2)\n"
        "print(os.stat('caught').st_size, spent, file=out)\n",
    )
    printed, spent = written.split()
    assert int(printed) == 0, (tmp_path / "caught").read_text()
    assert float(spent) < 0.3


def test_import_twice_gives_the_same_classes(monkeypatch) -> None:
    first = dict(contactdynamics._classes)
    for name in [name for name in sys.modules if name.split(".")[0] == "contactdynamics"]:
        monkeypatch.delitem(sys.modules, name)
    again = importlib.import_module("contactdynamics")
    assert again is not contactdynamics
    assert again._classes == first


def test_modules_of_the_package_come_when_first_used(tmp_path) -> None:
    """`contactdynamics.fclib.write(...)` after `import contactdynamics`, as the README has it."""
    run_script(
        tmp_path,
        """
import sys
import contactdynamics
assert "contactdynamics.report" not in sys.modules
for name in ("fclib", "forcenetwork", "plane", "report", "takeover"):
    assert getattr(contactdynamics, name) is sys.modules["contactdynamics." + name]
assert not hasattr(contactdynamics, "noSuchModule")
""",
    )


def test_interactive_session(tmp_path) -> None:
    """The classes are there by name, as YADE's own, and tell what they are; a name that is taken stays as it is."""
    typed = "ContactDynamicsPhys = 3\nimport contactdynamics\nprint('tolerance', ContactDynamicsEngine().tolerance)\n"
    typed += "ContactDynamicsMat?\nprint('taken', ContactDynamicsPhys)\nexit()\n"
    done = run(["yade", "-n"], cwd=tmp_path, input=typed)
    for expected in ("tolerance 0.0001", "Material whose contacts bounce", "taken 3"):
        assert expected in done.stdout, done.stdout + done.stderr


def test_plain_python(tmp_path) -> None:
    code = "import contactdynamics; print('classes', len(contactdynamics._classes))"
    done = run([sys.executable, "-c", code], packages=(PACKAGES, YADE_PACKAGES), cwd=tmp_path)
    assert f"classes {len(contactdynamics._classes)}\n" in done.stdout, done.stdout + done.stderr


# --- what it does not fit


def test_without_yade(tmp_path) -> None:
    done = run([sys.executable, "-c", "import contactdynamics"], cwd=tmp_path)
    assert done.returncode == 1
    error = done.stderr.splitlines()[-1]
    assert error.startswith("ImportError: contactdynamics works inside YADE, and `import yade` failed")
    assert "PYTHONPATH" in error


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_other_precision_is_refused_before_the_plugin_is_opened(tmp_path, flavour: str) -> None:
    program = shutil.which(f"yade-{flavour}")
    if program is None:
        pytest.skip(f"yade-{flavour} is not installed")
    written = run_script(
        tmp_path,
        "try:\n"
        "    import contactdynamics\n"
        "except ImportError as error:\n"
        "    print(error, file=out)\n"
        "O.bodies.append(sphere((0, 0, 0), 1)); O.step()\n"
        "print(O.iter, '_plugin' in open('/proc/self/maps').read(), file=out)\n",
        program,
    )
    error, after = written.splitlines()
    assert f"computes with {FLAVOURS[flavour]} bits" in error
    assert f"`yade` instead of `yade-{flavour}`" in error
    assert after == "1 False"


def test_other_version_is_refused(monkeypatch) -> None:
    monkeypatch.setattr(yade.config, "version", "2099.01a")
    with pytest.raises(ImportError, match=rf"built for YADE {_build.VERSION}; this is YADE 2099.01a.*YADE_SOURCE_DIR"):
        _loading.load()


@pytest.mark.parametrize("changed", ["SPH", "MPI"])
def test_other_features_are_refused(monkeypatch, changed: str) -> None:
    """SPH, which Debian's YADE lacks, added; MPI, which it has, taken away."""
    monkeypatch.setattr(yade.config, "features", list({changed}.symmetric_difference(yade.config.features)))
    with pytest.raises(ImportError, match="features.*change YADE's classes.*YADE_SOURCE_DIR"):
        _loading.load()


def test_features_without_effect_on_classes_do_not_matter(monkeypatch) -> None:
    monkeypatch.setattr(yade.config, "features", [feature for feature in yade.config.features if feature != "VTK"])
    _loading.load()


# --- the look at the layout


def with_wrong(class_name: str, member: str, value) -> dict:
    table = _plugin.compiledLayout()
    table[class_name]["members"][member] = value
    return table


def test_layout_of_the_running_yade_agrees() -> None:
    assert _plugin.layoutDisagreements(_plugin.compiledLayout()) == []


@pytest.mark.parametrize("periodic", [False, True])
def test_layout_agrees_with_a_scene_in_use(periodic: bool) -> None:
    if periodic:
        O.periodic = True
        O.cell.setBox(10, 10, 10)
    O.bodies.append([utils.sphere((1, 1, 1 + 1.9 * i), 1) for i in range(4)])
    O.engines = contactdynamics.engines()
    O.dt = 1e-6
    O.step()
    O.bodies.erase(1)
    assert len(O.interactions) > 0
    assert _plugin.layoutDisagreements(_plugin.compiledLayout()) == []


def test_wrong_offset_is_named() -> None:
    offset, kind = _plugin.compiledLayout()["State"]["members"]["vel"]
    table = with_wrong("State", "vel", (offset + 8, kind))
    assert _plugin.layoutDisagreements(table) == [f"State.vel: expected offset {offset + 8}, found offset {offset}"]


def test_wrong_type_is_named() -> None:
    offset, kind = _plugin.compiledLayout()["FrictPhys"]["members"]["tangensOfFrictionAngle"]
    other = kind.replace("double", "long double")
    (disagreement,) = _plugin.layoutDisagreements(with_wrong("FrictPhys", "tangensOfFrictionAngle", (offset, other)))
    assert disagreement == f"FrictPhys.tangensOfFrictionAngle: expected {other}, found {kind}"


@pytest.mark.parametrize("member", ["noSuchMember", "pos"])
def test_what_is_no_data_member_is_named(member: str) -> None:
    """`pos` is a property with functions behind it: there is no offset in it to be misread."""
    table = with_wrong("State", member, (32, "double"))
    expected = f"State.{member}: expected a data member at offset 32, found none of that name"
    assert _plugin.layoutDisagreements(table) == [expected]


def test_unknown_class_is_named() -> None:
    table = _plugin.compiledLayout()
    table["NoSuchClass"] = {"members": {}}
    expected = "NoSuchClass: expected a class of that name in yade.wrapper, found none"
    assert _plugin.layoutDisagreements(table) == [expected]


@pytest.mark.parametrize("difference", [-16, 16])
def test_wrong_size_is_named(difference: int) -> None:
    """16 bytes are the grain of the heap, through which sizes are seen."""
    table = _plugin.compiledLayout()
    table["State"]["size"] += difference
    (disagreement,) = _plugin.layoutDisagreements(table)
    assert disagreement.startswith(f"State: expected {table['State']['size']} bytes")


def test_disagreement_stops_the_import(monkeypatch) -> None:
    table = with_wrong("Body", "state", (0, "boost::shared_ptr<yade::State>"))
    registered = []
    plugin = SimpleNamespace(
        compiledLayout=lambda: table,
        layoutDisagreements=_plugin.layoutDisagreements,
        registerClasses=lambda: registered.append(True),
    )
    monkeypatch.setitem(sys.modules, "contactdynamics._plugin", plugin)
    with pytest.raises(ImportError, match=r"(?s)Body\.state: expected offset 0, found offset 56.*YADE_SOURCE_DIR"):
        _loading.load()
    assert registered == []
