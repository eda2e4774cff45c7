# SPDX-License-Identifier: GPL-2.0-or-later
"""Stacks, chains, packings, unsymmetric and badly scaled problems: solved; without a solution: said so. Judged by numpy at the points returned."""

import json

import numpy as np
import pytest
from problems import natural_map_residual, read_local, run, siconos_error, solve, write
from scenes import scenes, vice


@pytest.mark.parametrize("tolerance", [1e-4, 1e-8])
def test_all_are_solved_and_what_has_no_solution_is_not(tmp_path, tolerance):
    problems = scenes(small=True)
    files = [write(tmp_path / f"{name}.hdf5", problem) for name, problem in problems.items()]
    results = solve("--tolerance", tolerance, "--max-iterations", 30000, *files, folder=tmp_path / "solved")
    assert [result["problem"] for result in results] == list(problems)
    for result in results:
        name = result["problem"]
        problem, r, _ = read_local(tmp_path / "solved" / f"{name}.hdf5")
        error = siconos_error(problem, r)
        # Round-off of W r on both sides, relative to the scale of the error.
        assert result["error"] == pytest.approx(error, rel=1e-4, abs=1e-12 * max(1, np.abs(problem.W).max())), name
        assert result["converged"] is not name.startswith("unsolvable"), (name, result)


def test_a_vice_that_closes_is_called_unsolvable(tmp_path):
    done = run("solve", write(tmp_path / "p.hdf5", vice(2, 0.1)))
    assert done.returncode == 0 and "no solution" in done.stdout


def test_relative_natural_map_is_its_formula(tmp_path):
    for name in ("wall3d_mu03", "wall2d_mu05", "wall3d_gram", "arch_mu06"):
        problem = scenes(small=True)[name]
        solve("--tolerance", 1e-3, write(tmp_path / "p.hdf5", problem), folder=tmp_path / "solved")
        problem, r, _ = read_local(tmp_path / "solved" / "p.hdf5")
        said = run("info", tmp_path / "solved" / "p.hdf5").stdout
        assert float(said.split("relative natural map")[1]) == pytest.approx(natural_map_residual(problem, r), rel=2e-3), name


def test_plain_gauss_seidel_is_there_for_all(tmp_path):
    files = [write(tmp_path / f"{name}.hdf5", problem) for name, problem in scenes(small=True).items()]
    run("solve", "--acceleration", "none", "--max-iterations", 200, "--json", tmp_path / "out.json", *files)
    for result in json.loads((tmp_path / "out.json").read_text()):
        assert result["iterations"] <= 200 and np.isfinite(result["error"])
        assert result["converged"] is (result["error"] <= 1e-4) or result["problem"].startswith("unsolvable")
