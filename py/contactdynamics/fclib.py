# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems of a scene as files of the Frictional Contact Library (FCLIB, HDF5), so that any other solver can be run on them.

``scripts/fclib`` solves such files and says what is in them. Needs h5py (Debian: python3-h5py).
"""

from __future__ import annotations

import os

import numpy as np
from yade import O

from . import ContactDynamicsEngine


def write(path: str, engine: ContactDynamicsEngine | None = None, title: str = "") -> None:
    """Write the contact problem of the last step, with the solution that was applied.

    The file holds a local problem, ``/fclib_local``: u = W r + q with the relative velocities u [m/s] and the impulses r [N s] of
    all contacts of the last solve, three components each in the frame of ``ContactDynamicsPhys.localVelocity``, normal first. The
    gap velocity, max(0, g) / h under the default law, is part of u and q: 0 <= u_N _|_ r_N >= 0. ``/solution`` holds r and u.

    :param path: file to write; an existing one is replaced, and its folder is made if needed.
    :param engine: whose problem; ``None`` (default) for the only ``ContactDynamicsEngine`` in ``O.engines``.
    :param title: title in the file; ``""`` (default) for the number of the step.
    :raises TypeError: ``engine`` is no ``ContactDynamicsEngine``, or ``title`` no string
    :raises ValueError: ``engine`` not given and ``O.engines`` has none, or more than one; a step without contacts
    :raises RuntimeError: no step has been solved yet, or the cell of a ContactDynamicsCellController couples more than 1000 contacts, so that W is full
    """
    # Imported here: scenes that write no problem do without h5py.
    import h5py

    engine = _onlyEngine() if engine is None else engine
    if not isinstance(engine, ContactDynamicsEngine):
        raise TypeError(f"engine is a {type(engine).__name__}; it must be a ContactDynamicsEngine")
    if not isinstance(title, str):
        raise TypeError(f"title is {title!r}; it must be a string")
    problem = engine.lastProblem()
    if not problem["friction"]:
        raise ValueError("the last step had no contact, so there is no problem to write")
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    unfinished = f"{os.fspath(path)}.part"  # a file that is there already stays as it is until this one is complete
    try:
        with h5py.File(unfinished, "w") as file:
            _fill(file, problem, title or f"Contact Dynamics for YADE, step {O.iter}")
        os.replace(unfinished, path)
    except BaseException:
        if os.path.exists(unfinished):
            os.remove(unfinished)
        raise


def _fill(file, problem: dict, title: str) -> None:
    """All groups of a local problem with its solution."""
    contacts = len(problem["friction"])
    starts, rows, values = _compressedColumns(problem)
    local = file.create_group("fclib_local")
    _integers(local, spacedim=problem["dimension"])
    W = local.create_group("W")
    # nz = -1 stands for compressed columns, the one layout that every reader of the library knows.
    _integers(W, nzmax=len(values), m=3 * contacts, n=3 * contacts, nz=-1, p=starts, i=rows)
    W["x"] = values
    vectors = local.create_group("vectors")
    vectors["q"] = np.array(problem["q"])
    vectors["mu"] = np.array(problem["friction"])
    info = local.create_group("info")
    _text(info, "title", title)
    _text(info, "description", "Velocities in m/s, impulses in N s; components N, T1, T2; the gap velocity is part of q and u.")
    _text(info, "math_info", "W is symmetric and positive semi-definite; u is unique, r need not be.")
    solution = file.create_group("solution")
    solution["r"] = np.array(problem["impulse"])
    solution["u"] = np.array(problem["velocity"])


def _onlyEngine() -> ContactDynamicsEngine:
    found = [engine for engine in O.engines if isinstance(engine, ContactDynamicsEngine)]
    if len(found) != 1:
        raise ValueError(f"O.engines has {len(found)} ContactDynamicsEngine; say which one with engine=")
    return found[0]


def _compressedColumns(problem: dict) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Column starts, row indices and values of W. Zeros inside its blocks are kept: readers may count on whole blocks."""
    blocks = np.array(problem["blocks"]).reshape(-1, 3, 3)
    blockRow = np.repeat(np.arange(len(problem["friction"])), np.diff(problem["rowStart"]))
    row = (3 * blockRow[:, None, None] + np.arange(3)[None, :, None] + np.zeros((1, 1, 3), int)).ravel()
    column = (3 * np.array(problem["column"])[:, None, None] + np.arange(3)[None, None, :] + np.zeros((1, 3, 1), int)).ravel()
    order = np.lexsort((row, column))
    starts = np.concatenate([[0], np.cumsum(np.bincount(column, minlength=3 * len(problem["friction"])))])
    return starts, row[order], blocks.ravel()[order]


def _integers(group, **named) -> None:
    """Datasets of 32-bit integers; the library wants a single number as an array of length one."""
    for name, value in named.items():
        group[name] = np.atleast_1d(np.asarray(value, dtype="<i4"))


def _text(group, name: str, value: str) -> None:
    """A string of fixed length that ends with NUL: libfclib reads exactly its bytes and takes them for a C string."""
    import h5py

    content = value.encode() + b"\0"
    kind = h5py.h5t.C_S1.copy()
    kind.set_size(len(content))
    kind.set_strpad(h5py.h5t.STR_NULLTERM)
    dataset = h5py.h5d.create(group.id, name.encode(), kind, h5py.h5s.create(h5py.h5s.SCALAR))
    dataset.write(h5py.h5s.ALL, h5py.h5s.ALL, np.array(content, dtype=f"S{len(content)}"), mtype=kind)
