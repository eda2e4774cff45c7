# SPDX-License-Identifier: GPL-2.0-or-later
"""The last step's problem as a file: what is in it is the step that YADE made, and any solver can be run on it."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from yade import O

import contactdynamics
from contactdynamics import fclib
from heap import heap
from scenes import cd, equip, floor, grain, law

PROGRAM = Path(contactdynamics.__file__).resolve().parents[2] / "bin" / "contactdynamics-fclib"
with_program = pytest.mark.skipif(not PROGRAM.exists(), reason="built without libfclib")


def read(path: Path) -> tuple[np.ndarray, ...]:
    """W, q, mu, r, u, the vectors of contacts by rows of three."""
    with h5py.File(path) as file:
        W, vectors, solution = file["fclib_local/W"], file["fclib_local/vectors"], file["solution"]
        dense = np.zeros((W["m"][0], W["n"][0]))
        for column in range(len(dense)):
            of = slice(W["p"][column], W["p"][column + 1])
            dense[W["i"][of], column] = W["x"][of]
        return dense, vectors["q"][:], vectors["mu"][:], solution["r"][:], solution["u"][:]


def residual(W: np.ndarray, u: np.ndarray, mu: np.ndarray, r: np.ndarray) -> float:
    """The certificate of the engine from its formula: F = r - P(r - (u + mu |u_T| n) / W_NN), relative, weighted with the diagonal blocks."""
    above = below = 0.0
    for i, friction in enumerate(mu):
        of = slice(3 * i, 3 * i + 3)
        z = r[of] - u[of] / W[3 * i, 3 * i]
        z[0] -= friction * np.linalg.norm(u[of][1:]) / W[3 * i, 3 * i]
        tangential = np.linalg.norm(z[1:])
        nearest = z
        if tangential > friction * z[0]:
            normal = max(0.0, z[0] + friction * tangential) / (1 + friction**2)
            nearest = np.append(normal, z[1:] * (friction * normal / tangential))
        F = r[of] - nearest
        above += F @ W[of, of] @ F
        below += r[of] @ W[of, of] @ r[of]
    return np.sqrt(above / below)


@pytest.mark.parametrize("law", ["quasiInelasticShock", "velocitySignorini"])
def test_file_holds_the_step(tmp_path, law):
    heap(contactLaw=law, tolerance=1e-6)
    fclib.write(str(tmp_path / "new folder" / "step.hdf5"))
    W, q, mu, r, u = read(tmp_path / "new folder" / "step.hdf5")
    assert len(mu) == cd().contacts
    # The solver gets u from the velocities of the bodies, never from W: two independent ways, different by round-off only.
    size = np.abs(W) @ np.abs(r) + np.abs(q)
    assert np.all(np.abs(W @ r + q - u) <= 1e-12 * size.max())
    np.testing.assert_allclose(W, W.T, rtol=0, atol=1e-14 * np.abs(W).max())
    assert np.linalg.eigvalsh(W).min() > -1e-12 * np.abs(W).max()
    # The engine leaves out what is below round-off, hence the absolute part.
    assert residual(W, u, mu, r) == pytest.approx(cd().residual, rel=1e-3, abs=1e-12)


def test_components_are_those_of_the_interactions():
    heap()
    problem = cd().lastProblem()
    found = sorted(np.round(np.reshape(problem["velocity"], (-1, 3))[np.array(problem["impulse"]).reshape(-1, 3)[:, 0] > 0], 12).tolist())
    solved = [i for i in O.interactions if i.isReal and i.phys.impulse.norm() > 0]
    # Contacts that carry an impulse overlap or close, so under this law u is localVelocity with max(0, gap) / h on its normal component.
    expected = sorted(
        np.round([i.phys.localVelocity[0] + max(0, i.phys.gap) / O.dt, i.phys.localVelocity[1], i.phys.localVelocity[2]], 12).tolist() for i in solved
    )
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10)
    ids = {body.id for body in O.bodies}
    assert all(first in ids and second in ids and first != second for first, second in problem["bodies"])


@with_program
def test_another_solver_finds_the_same_residual_and_velocities(tmp_path):
    heap(tolerance=1e-9, maxIterations=20000)
    assert cd().converged
    fclib.write(str(tmp_path / "step.hdf5"), title="a heap")
    said = subprocess.run([PROGRAM, "info", tmp_path / "step.hdf5"], capture_output=True, text=True, check=True).stdout
    assert f"local, 3D, {cd().contacts} contacts" in said and "title         a heap" in said
    assert float(said.rsplit("relative natural map", 1)[1]) == pytest.approx(cd().residual, rel=1e-2, abs=1e-12)

    command = [PROGRAM, "solve", "--tolerance", "1e-10", "--json", tmp_path / "out.json", "--write", tmp_path / "solved", tmp_path / "step.hdf5"]
    subprocess.run(command, capture_output=True, check=True)
    (result,) = json.loads((tmp_path / "out.json").read_text())
    assert result["converged"] and result["contacts"] == cd().contacts
    *_, u = read(tmp_path / "step.hdf5")
    *_, again = read(tmp_path / "solved" / "step.hdf5")
    # Both are within 1e-9 of the same velocities, relative to impulses that change speeds of order 1 m/s; room for the condition of the heap.
    np.testing.assert_allclose(again, u, rtol=0, atol=1e-5)


def test_refusals(tmp_path):
    path = str(tmp_path / "step.hdf5")
    with pytest.raises(ValueError, match="has 0 ContactDynamicsEngine"):
        fclib.write(path)
    floor()
    grain((0, 0, 5))
    equip(dt=1e-3)
    with pytest.raises(RuntimeError, match="no step has been solved"):
        fclib.write(path)
    O.step()
    with pytest.raises(ValueError, match="no contact"):
        fclib.write(path)
    assert not Path(path).exists()


def test_problem_of_a_step_that_did_not_converge(tmp_path):
    """The very problem that one wants to hand to somebody else."""
    heap(tolerance=1e-3)
    cd().tolerance, cd().maxIterations, cd().onNonConvergence = 1e-14, 1, "raise"
    with pytest.raises(RuntimeError, match="residual"):
        O.step()
    fclib.write(str(tmp_path / "step.hdf5"))
    W, q, mu, r, u = read(tmp_path / "step.hdf5")
    assert residual(W, u, mu, r) == pytest.approx(cd().residual, rel=1e-3)


def test_what_is_there_survives_a_write_that_fails(tmp_path):
    """Wrong arguments are refused before anything is written; a write that fails in the middle leaves the file of before."""
    heap()
    path = tmp_path / "step.hdf5"
    fclib.write(str(path))
    before = path.read_bytes()
    with pytest.raises(TypeError, match="engine is a ForceResetter"):
        fclib.write(str(path), engine=O.engines[0])
    with pytest.raises(TypeError, match="title is 5"):
        fclib.write(str(path), title=5)
    with pytest.raises(UnicodeEncodeError):
        fclib.write(str(path), title="\ud800")
    assert path.read_bytes() == before
    assert [file.name for file in tmp_path.iterdir()] == ["step.hdf5"]


def test_problem_of_a_step_that_did_not_converge_with_laws() -> None:
    """Bonds and restitution shift the problem, and apply() undoes it: after an error before that the problem is the same to the bit."""

    def problem(mode: str) -> dict:
        O.reset()
        law(cohesionForce=5e3, normalRestitution=0.5, tangentialRestitution=0.5, frictionAngle=0.5)
        floor()
        for k in range(6):
            grain((0.05 * k, 0, 1 + 2 * k), velocity=(0.1 * k, 0, -1))
        equip(1e-3, tolerance=1e-14, maxIterations=1, onNonConvergence=mode)
        if mode == "raise":
            with pytest.raises(RuntimeError, match="residual"):
                O.step()
        else:
            O.step()
        return cd().lastProblem()

    assert problem("raise") == problem("ignore")
