# SPDX-License-Identifier: GPL-2.0-or-later
"""One problem with one solver of Siconos; started by fclib.py as a process of its own, because some of them crash or hang.

Usage: fclib_siconos.py FILE SOLVER MAX_ITERATIONS TOLERANCE...     prints one line of JSON for each tolerance
"""

import json
import sys
import time
import warnings

import h5py
import numpy as np
import scipy.sparse
import siconos.numerics as siconos


def nsgs(*settings: tuple[str, str], local: str = ""):
    """Nonlinear Gauss-Seidel with entries of iparam (key, value) and another local solver, all by the names of Siconos."""

    def options():
        chosen = siconos.SolverOptions(siconos.SICONOS_FRICTION_3D_NSGS)
        for key, value in settings:
            chosen.iparam[getattr(siconos, key)] = getattr(siconos, value)
        if local:
            siconos.solver_options_update_internal(chosen, 0, getattr(siconos, local))
        return chosen

    return siconos.fc3d_nsgs, options


def plain(function: str, number: str):
    return getattr(siconos, function), lambda: siconos.SolverOptions(getattr(siconos, number))


FULL = ("SICONOS_FRICTION_3D_IPARAM_ERROR_EVALUATION", "SICONOS_FRICTION_3D_NSGS_ERROR_EVALUATION_FULL")
SOLVERS = {
    3: {
        "nsgs": nsgs(),
        "nsgs-full": nsgs(FULL),
        "nsgs-projection": nsgs(local="SICONOS_FRICTION_3D_ONECONTACT_ProjectionOnCone"),
        "nsgs-projection-iterated": nsgs(local="SICONOS_FRICTION_3D_ONECONTACT_ProjectionOnConeWithLocalIteration"),
        "nsgs-quartic": nsgs(local="SICONOS_FRICTION_3D_ONECONTACT_QUARTIC"),
        "newton-alart-curnier": plain("fc3d_nonsmooth_Newton_AlartCurnier", "SICONOS_FRICTION_3D_NSN_AC"),
        "admm": plain("fc3d_admm", "SICONOS_FRICTION_3D_ADMM"),
    },
    2: {"nsgs": plain("fc2d_nsgs_sbm", "SICONOS_FRICTION_2D_NSGS")},
}


def read(path: str) -> tuple[int, scipy.sparse.csc_matrix, np.ndarray, np.ndarray]:
    """Dimension, W, q and mu of a local problem in compressed columns, as contactdynamics-fclib writes it."""
    with h5py.File(path) as file:
        local = file["fclib_local"]
        W, vectors = local["W"], local["vectors"]
        # Siconos's indices have 64 bits; others it converts, with a warning.
        matrix = scipy.sparse.csc_matrix((W["x"][:], W["i"][:].astype(np.int64), W["p"][:].astype(np.int64)), shape=(W["m"][0], W["n"][0]))
        return int(local["spacedim"][0]), matrix, vectors["q"][:], vectors["mu"][:]


def error(dimension: int, W: scipy.sparse.csc_matrix, q: np.ndarray, mu: np.ndarray, r: np.ndarray) -> float:
    """Siconos's error of the impulses r, the same for all solvers and both sides."""
    u = W @ r + q
    R, U = r.reshape(-1, dimension), u.reshape(-1, dimension)
    z = R - U
    z[:, 0] -= mu * np.linalg.norm(U[:, 1:], axis=1)
    tangential = np.linalg.norm(z[:, 1:], axis=1)
    normal = np.maximum(0, z[:, 0] + mu * tangential) / (1 + mu**2)
    inside, polar = tangential <= mu * z[:, 0], mu * tangential <= -z[:, 0]
    nearest = np.column_stack([normal, z[:, 1:] * (mu * normal / np.where(tangential > 0, tangential, 1))[:, None]])
    nearest[polar] = 0
    nearest[inside] = z[inside]
    scale = max(np.linalg.norm(q), np.linalg.norm(r), np.linalg.norm(u))
    return float(np.linalg.norm(R - nearest) / (scale if scale > 2.2e-16 else 1))


def main() -> None:
    path, name, iterations, *tolerances = sys.argv[1:]
    warnings.simplefilter("ignore")
    dimension, W, q, mu = read(path)
    solver, make = SOLVERS[dimension][name]
    for tolerance in map(float, tolerances):
        seconds, total = float("inf"), 0.0
        # The same rule as in contactdynamics-fclib: the fastest of up to five while they take less than a few milliseconds.
        for _ in range(5):
            # Blocks are its fastest storage. Some solvers change the problem, so each run gets its own.
            problem = siconos.FrictionContactProblem(dimension, siconos.SBM_from_csparse(dimension, W)[1], q.copy(), mu.copy())
            options = make()
            options.dparam[siconos.SICONOS_DPARAM_TOL] = tolerance
            options.iparam[siconos.SICONOS_IPARAM_MAX_ITER] = int(iterations)
            r, u = np.zeros(len(q)), np.zeros(len(q))
            start = time.perf_counter()
            solver(problem, r, u, options)
            once = time.perf_counter() - start
            seconds, total = min(seconds, once), total + once
            if total > 5e-3:
                break
        reached = error(dimension, W, q, mu, r)
        done = int(options.iparam[siconos.SICONOS_IPARAM_ITER_DONE])
        result = {"tolerance": tolerance, "iterations": done, "seconds": seconds, "error": reached if np.isfinite(reached) else None}
        print("RESULT " + json.dumps(result), flush=True)


if __name__ == "__main__":
    main()
