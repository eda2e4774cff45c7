# SPDX-License-Identifier: GPL-2.0-or-later
"""What the program says about its solutions is true."""

import json

import numpy as np
import pytest
from problems import Local, random_global, read_local, reduced, run, siconos_error, solve, write

KEYS = ["problem", "dimension", "contacts", "tolerance", "iterations", "seconds", "error", "converged"]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-8])
def test_error_is_that_of_siconos_at_the_returned_point(tmp_path, dimension, tolerance):
    for seed in range(5):
        file = write(tmp_path / "p.hdf5", reduced(random_global(dimension, 9, seed)))
        (result,) = solve("--tolerance", tolerance, file, folder=tmp_path / "solved")
        problem, r, u = read_local(tmp_path / "solved" / "p.hdf5")
        # The map is a difference of numbers of the size of r and u: round-off of that size, relative to the scale of the error.
        assert result["error"] == pytest.approx(siconos_error(problem, r), rel=1e-6, abs=1e-14)
        assert result["converged"] is True and result["error"] <= tolerance == result["tolerance"]
        np.testing.assert_allclose(u, problem.W @ r + problem.q, rtol=0, atol=1e-13 * np.abs(problem.q).max())


def test_a_solve_cut_short_is_not_called_converged(tmp_path):
    file = write(tmp_path / "p.hdf5", reduced(random_global(3, 9, seed=1)))
    (result,) = solve("--tolerance", 1e-10, "--max-iterations", 2, "--acceleration", "none", file, folder=tmp_path / "solved")
    problem, r, _ = read_local(tmp_path / "solved" / "p.hdf5")
    assert result["converged"] is False and result["iterations"] == 2
    assert result["error"] == pytest.approx(siconos_error(problem, r), rel=1e-6)
    assert result["error"] > 1e-10


def test_a_problem_without_solution_is_not_called_converged(tmp_path):
    """Two contacts press one immobile degree of freedom from both sides faster than it can give way."""
    W = np.array([[1.0, 0, -1, 0], [0, 1, 0, 1], [-1, 0, 1, 0], [0, 1, 0, 1]])
    problem = Local(2, W, np.array([-1.0, 0, -1, 0]), np.array([0.0, 0.0]))
    (result,) = solve("--max-iterations", 1000, write(tmp_path / "p.hdf5", problem), folder=tmp_path / "solved")
    assert result["converged"] is False and np.isfinite(result["error"])


def test_json_has_the_agreed_form(tmp_path):
    files = [write(tmp_path / f'{name}.hdf5', reduced(random_global(d, 3, seed=2))) for name, d in (('a "quoted"', 2), ("b", 3))]
    results = solve("--tolerance", 1e-6, "--threads", 2, *files, folder=tmp_path / "solved")
    assert [list(result) for result in results] == [KEYS, KEYS]
    assert [result["problem"] for result in results] == ['a "quoted"', "b"]
    assert [result["dimension"] for result in results] == [2, 3]
    for result in results:
        assert [type(result[key]) for key in KEYS] == [str, int, int, float, int, float, float, bool]
        assert result["seconds"] > 0


def test_both_accelerations_reach_the_same_velocities(tmp_path):
    file = write(tmp_path / "p.hdf5", reduced(random_global(3, 9, seed=4)))
    velocities = []
    for acceleration in ("none", "momentum"):
        solve("--tolerance", 1e-12, "--acceleration", acceleration, file, folder=tmp_path / acceleration)
        velocities.append(read_local(tmp_path / acceleration / "p.hdf5")[2])
    # The velocities are unique here (W is regular and friction moderate); 1e-12 times the condition, below 1e4.
    np.testing.assert_allclose(*velocities, rtol=0, atol=1e-8)


def test_info_judges_the_stored_solution(tmp_path):
    file = write(tmp_path / "p.hdf5", reduced(random_global(3, 4, seed=3)))
    (result,) = solve("--tolerance", 1e-5, file, folder=tmp_path / "solved")
    said = run("info", tmp_path / "solved" / "p.hdf5").stdout
    assert f"error {result['error']:.3e}" in said


@pytest.mark.parametrize("arguments, said", [
    ([], "solve or info"),
    (["sovle", "x"], "'sovle'"),
    (["solve"], "at least one file"),
    (["solve", "--tolerance", "0", "x"], "--tolerance is '0', must be a number > 0"),
    (["solve", "--tolerance", "1e-4x", "x"], "'1e-4x'"),
    (["solve", "--max-iterations", "-1", "x"], "--max-iterations"),
    (["solve", "--threads", "0", "x"], "--threads"),
    (["solve", "--acceleration", "magic", "x"], "'magic', must be none or momentum"),
    (["solve", "--json"], "--json needs a value"),
    (["info", "--json", "x", "y"], "'--json' is no option of info"),
])
def test_wrong_usage(arguments, said):
    done = run(*arguments)
    assert done.returncode == 2 and said in done.stderr and "Usage" in done.stderr


def test_unwritable_results(tmp_path):
    file = write(tmp_path / "p.hdf5", reduced(random_global(2, 3, seed=2)))
    (tmp_path / "file").write_text("")
    done = run("solve", "--json", tmp_path / "file" / "out.json", file)
    assert done.returncode == 1 and "out.json: cannot be written" in done.stderr and done.stdout == ""  # before anything is solved
    done = run("solve", "--write", tmp_path / "file", file)
    assert done.returncode == 1 and done.stderr.startswith(f"error: {tmp_path / 'file'}: cannot be made") and done.stdout == ""
    json_file = tmp_path / "out.json"
    assert run("solve", "--json", json_file, file).returncode == 0 and json.loads(json_file.read_text())


def test_what_is_read_is_never_replaced(tmp_path):
    """Refused before anything is solved: a target that is an input, one target for two inputs."""
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
    first, second = (write(tmp_path / folder / "p.hdf5", reduced(random_global(3, 3, seed=1))) for folder in ("a", "b"))
    before = first.read_bytes()
    for arguments, named in (
        (("--write", tmp_path / "a", first), str(first)),
        (("--write", tmp_path / "a", second, first), str(first)),
        (("--json", first, first), str(first)),
        (("--write", tmp_path / "c", first, second), str(tmp_path / "c" / "p.hdf5")),
    ):
        done = run("solve", *arguments)
        assert done.returncode == 2 and done.stdout == ""
        assert named in done.stderr.splitlines()[0]
    assert first.read_bytes() == before
    assert not (tmp_path / "c").exists()
