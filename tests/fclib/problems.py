# SPDX-License-Identifier: GPL-2.0-or-later
"""Small contact problems, FCLIB files of every layout, and Siconos's error, all without the code under test."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

LAYOUTS = ("triplets", "columns", "rows")


@dataclass
class Global:
    """M v = H r + G l + f,  G^T v + b = 0,  u = H^T v + w."""

    dimension: int
    M: np.ndarray
    H: np.ndarray
    f: np.ndarray
    w: np.ndarray
    mu: np.ndarray
    G: np.ndarray | None = None
    b: np.ndarray | None = None


@dataclass
class Local:
    """u = W r + V l + q,  V^T r + R l + s = 0."""

    dimension: int
    W: np.ndarray
    q: np.ndarray
    mu: np.ndarray
    V: np.ndarray | None = None
    R: np.ndarray | None = None
    s: np.ndarray | None = None


def random_global(dimension: int, contacts: int, seed: int, constraints: int = 0) -> Global:
    """A few bodies that fall on each other. A third of H is zero, so that the compressed layouts have something to leave out."""
    random = np.random.default_rng(seed)
    unknowns, components = 2 * dimension * contacts + 1, dimension * contacts
    root = random.normal(size=(unknowns, unknowns))
    H = random.normal(size=(unknowns, components)) * (random.random((unknowns, components)) < 2 / 3)
    G = random.normal(size=(unknowns, constraints)) if constraints else None
    return Global(
        dimension,
        M=root @ root.T + unknowns * np.eye(unknowns),
        H=H,
        f=random.normal(size=unknowns) - 3 * H @ np.tile([1.0] + [0.0] * (dimension - 1), contacts),
        w=0.1 * random.normal(size=components),
        mu=random.uniform(0, 1, contacts),
        G=G,
        b=random.normal(size=constraints) if constraints else None,
    )


def reduced(problem: Global) -> Local:
    """The same problem in local form, densely."""
    K, B, c, d = problem.M, problem.H, problem.f, len(problem.M)
    if problem.G is not None:
        n = problem.G.shape[1]
        K = np.block([[problem.M, -problem.G], [problem.G.T, np.zeros((n, n))]])
        B = np.vstack([problem.H, np.zeros((n, problem.H.shape[1]))])
        c = np.concatenate([problem.f, -problem.b])
    return Local(
        problem.dimension, problem.H.T @ np.linalg.solve(K, B)[:d], problem.H.T @ np.linalg.solve(K, c)[:d] + problem.w, problem.mu
    )


def siconos_error(problem: Local, r: np.ndarray) -> float:
    """|r - P_K(r - u - mu |u_T| n)| / max(|q|, |r|, |u|), written from its definition with u = W r + q."""
    d = problem.dimension
    u = problem.W @ r + problem.q
    squares = 0.0
    for i, mu in enumerate(problem.mu):
        of = slice(d * i, d * (i + 1))
        z = r[of] - u[of]
        z[0] -= mu * np.linalg.norm(u[of][1:])
        squares += np.sum((r[of] - nearest_in_cone(z, mu)) ** 2)
    scale = max(np.linalg.norm(problem.q), np.linalg.norm(r), np.linalg.norm(u))
    return np.sqrt(squares) / (scale if scale > 2.2e-16 else 1)


def natural_map_residual(problem: Local, r: np.ndarray) -> float:
    """sqrt(sum F^T W_cc F / sum r^T W_cc r) with F = r - P_K(r - (u + mu |u_T| n) / W_nn); W_cc the symmetric part of a diagonal block."""
    d = problem.dimension
    u = problem.W @ r + problem.q
    above = below = 0.0
    for i, mu in enumerate(problem.mu):
        of = slice(d * i, d * (i + 1))
        W = (problem.W[of, of] + problem.W[of, of].T) / 2
        push = u[of].copy()
        push[0] += mu * np.linalg.norm(u[of][1:])
        F = r[of] - nearest_in_cone(r[of] - push / W[0, 0], mu)
        above += F @ W @ F
        below += r[of] @ W @ r[of]
    return np.sqrt(above / below)


def nearest_in_cone(z: np.ndarray, mu: float) -> np.ndarray:
    """Nearest point of |t| <= mu n: z itself, the tip, or a point on the generator (1, mu t / |t|) of the surface."""
    tangential = np.linalg.norm(z[1:])
    if tangential <= mu * z[0]:
        return z.copy()
    generator = np.concatenate([[1.0], mu * z[1:] / tangential if tangential > 0 else 0 * z[1:]])
    return max(0.0, z @ generator) / (generator @ generator) * generator


def write_matrix(parent: h5py.Group, name: str, matrix: np.ndarray, layout: str) -> None:
    """Unsorted within a line on purpose. Triplets also have room to spare (nzmax > nz) and one entry split in two."""
    rows, columns = np.nonzero(matrix)
    shuffled = np.random.default_rng(1).permutation(len(rows))
    rows, columns = rows[shuffled], columns[shuffled]
    if layout == "triplets":
        values = matrix[rows, columns]
        values[0] *= 0.25
        rows, columns, values = np.append(rows, rows[0]), np.append(columns, columns[0]), np.append(values, 3 * values[0])
        nz, nzmax, p, i = len(rows), len(rows) + 5, columns, rows
    else:
        line, along = (columns, rows) if layout == "columns" else (rows, columns)
        order = np.argsort(line, kind="stable")
        lines = matrix.shape[1] if layout == "columns" else matrix.shape[0]
        nz, nzmax = (-1 if layout == "columns" else -2), len(rows)
        p, i = np.concatenate([[0], np.cumsum(np.bincount(line, minlength=lines))]), along[order]
        values = matrix[rows, columns][order]
    group = parent.create_group(name)
    for key, value in dict(nzmax=nzmax, m=matrix.shape[0], n=matrix.shape[1], nz=nz, p=p, i=i).items():
        group[key] = np.atleast_1d(np.asarray(value, "<i4"))
    group["x"] = values


def write(path: Path, problem: Local | Global, layout: str = "columns") -> Path:
    """Write a problem as FCLIB does, without the optional group ``info``."""
    with h5py.File(path, "w") as file:
        is_local = isinstance(problem, Local)
        root = file.create_group("fclib_local" if is_local else "fclib_global")
        root["spacedim"] = np.array([problem.dimension], "<i4")
        for name in ("W", "V", "R") if is_local else ("M", "H", "G"):
            if getattr(problem, name) is not None:
                write_matrix(root, name, getattr(problem, name), layout)
        vectors = root.create_group("vectors")
        for name in ("q", "s", "mu") if is_local else ("f", "w", "b", "mu"):
            if getattr(problem, name) is not None:
                vectors[name] = getattr(problem, name)
    return path


def read_local(path: Path) -> tuple[Local, np.ndarray, np.ndarray]:
    """A local problem in compressed columns with its solution: problem, r, u."""
    with h5py.File(path) as file:
        W, vectors = file["fclib_local/W"], file["fclib_local/vectors"]
        assert W["nz"][0] == -1
        dense = np.zeros((W["m"][0], W["n"][0]))
        for column in range(dense.shape[1]):
            of = slice(W["p"][column], W["p"][column + 1])
            dense[W["i"][of], column] += W["x"][of]
        problem = Local(int(file["fclib_local/spacedim"][0]), dense, vectors["q"][:], vectors["mu"][:])
        return problem, file["solution/r"][:], file["solution/u"][:]


def run(*arguments: object) -> subprocess.CompletedProcess:
    """The program under test."""
    command = [os.environ["CONTACTDYNAMICS_FCLIB"], *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def solve(*arguments: object, folder: Path) -> list[dict]:
    """Run ``solve``, which must succeed, and return its JSON. The solved problems are left in ``folder``."""
    done = run("solve", "--json", folder / "out.json", "--write", folder, *arguments)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return json.loads((folder / "out.json").read_text())
