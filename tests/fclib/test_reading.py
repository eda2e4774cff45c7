# SPDX-License-Identifier: GPL-2.0-or-later
"""Every layout of the format is read as what it means."""

import dataclasses

import h5py
import numpy as np
import pytest
from problems import LAYOUTS, Local, random_global, read_local, reduced, run, solve, write


def assert_same(found: Local, expected: Local) -> None:
    # Two dense solves of well-conditioned systems of some dozen unknowns: round-off grows by the condition, below 1e3.
    assert found.dimension == expected.dimension
    np.testing.assert_array_equal(found.mu, expected.mu)
    np.testing.assert_allclose(found.W, expected.W, rtol=0, atol=1e-12 * np.abs(expected.W).max())
    np.testing.assert_allclose(found.q, expected.q, rtol=0, atol=1e-12 * np.abs(expected.q).max())


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("constraints", [0, 2])
def test_global(tmp_path, layout, dimension, constraints):
    problem = random_global(dimension, 7, seed=dimension, constraints=constraints)
    file = write(tmp_path / "falling bodies.hdf5", problem, layout)
    (result,) = solve(file, folder=tmp_path / "solved")
    assert (result["problem"], result["dimension"], result["contacts"]) == ("falling bodies", dimension, 7)
    found, r, u = read_local(tmp_path / "solved" / "falling bodies.hdf5")
    assert_same(found, reduced(problem))


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_local_and_unsymmetric(tmp_path, layout, dimension):
    problem = reduced(random_global(dimension, 7, seed=5))
    problem.W[0, -1] *= 1.01
    problem.W[:dimension, dimension : 2 * dimension] = 0  # a block in one triangle only
    solve(write(tmp_path / "p.hdf5", problem, layout), folder=tmp_path / "solved")
    assert_same(read_local(tmp_path / "solved" / "p.hdf5")[0], problem)


def test_local_with_equality_constraints(tmp_path):
    problem = reduced(random_global(3, 4, seed=6))
    random = np.random.default_rng(2)
    V, s = random.normal(size=(12, 2)), random.normal(size=2)
    R = -10 * np.eye(2) + 0.1 * random.normal(size=(2, 2))
    eliminated = Local(3, problem.W - V @ np.linalg.solve(R, V.T), problem.q - V @ np.linalg.solve(R, s), problem.mu)
    solve(write(tmp_path / "p.hdf5", dataclasses.replace(problem, V=V, R=R, s=s), "rows"), folder=tmp_path / "solved")
    assert_same(read_local(tmp_path / "solved" / "p.hdf5")[0], eliminated)


def test_triplets_with_their_spare_room_stored(tmp_path):
    problem = reduced(random_global(3, 3, seed=2))
    path = write(tmp_path / "p.hdf5", problem, "triplets")
    with h5py.File(path, "a") as file:
        W = file["fclib_local/W"]
        x = np.append(W["x"][:], np.full(W["nzmax"][0] - W["nz"][0], 7.0))
        del W["x"]
        W["x"] = x
    solve(path, folder=tmp_path / "solved")
    assert_same(read_local(tmp_path / "solved" / "p.hdf5")[0], problem)


def test_contact_without_diagonal_block(tmp_path):
    """A contact between two bodies that cannot move has no W at all; it must neither crash nor be called solved when it closes."""
    W = np.zeros((4, 4))
    W[0, 0] = W[1, 1] = 2
    for speed, converged in ((1.0, True), (-1.0, False)):
        problem = Local(2, W, np.array([-1.0, 0.5, speed, 0.0]), np.array([0.3, 0.3]))
        (result,) = solve("--max-iterations", 50, write(tmp_path / "p.hdf5", problem), folder=tmp_path / "solved")
        assert result["converged"] is converged


def test_info(tmp_path):
    done = run("info", write(tmp_path / "p.hdf5", random_global(3, 5, seed=1, constraints=1)))
    assert done.returncode == 0, done.stderr
    for said in ("global, 3D, 5 contacts, 31 velocities, 1 equality constraints", "friction", "solution      none"):
        assert said in done.stdout
