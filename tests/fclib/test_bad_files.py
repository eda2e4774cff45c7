# SPDX-License-Identifier: GPL-2.0-or-later
"""Bad files give an error that names file and dataset; libfclib alone would end the program or write past its memory."""

import h5py
import numpy as np
import pytest
from problems import random_global, reduced, run, write


def refused(file, *said: str, commands=("solve", "info")) -> None:
    """The commands must refuse the file in one line with these words."""
    for command in commands:
        done = run(command, file)
        assert done.returncode == 1, (done.returncode, done.stdout, done.stderr)
        assert len(done.stderr.splitlines()) == 1
        for words in (str(file), *said):
            assert words in done.stderr


def test_missing_and_foreign_files(tmp_path):
    refused(tmp_path / "nothing.hdf5", "there is no such file")
    refused(tmp_path, "is a folder")
    (tmp_path / "text.hdf5").write_text("not HDF5\n" * 100)
    refused(tmp_path / "text.hdf5", "is not an HDF5 file")
    (tmp_path / "empty.hdf5").write_text("")
    refused(tmp_path / "empty.hdf5", "is not an HDF5 file")
    with h5py.File(tmp_path / "foreign.hdf5", "w") as file:
        file["something"] = np.arange(3)
    refused(tmp_path / "foreign.hdf5", "dataset /fclib_local is missing, and so is /fclib_global")
    with h5py.File(tmp_path / "rolling.hdf5", "w") as file:
        file.create_group("fclib_global_rolling")
    refused(tmp_path / "rolling.hdf5", "/fclib_global_rolling", "not supported")
    with h5py.File(tmp_path / "array.hdf5", "w") as file:
        file["fclib_local"] = np.arange(3)
    refused(tmp_path / "array.hdf5", "/fclib_local", "must be a group")


def test_truncated_at_any_length(tmp_path):
    whole = write(tmp_path / "whole.hdf5", random_global(3, 6, seed=1)).read_bytes()
    for part in np.linspace(0, len(whole) - 1, 25).astype(int):
        (tmp_path / "part.hdf5").write_bytes(whole[:part])
        refused(tmp_path / "part.hdf5")


def test_damaged_bytes_never_crash(tmp_path):
    """Whatever a flipped byte does, the program ends by itself: 0 when the damage is invisible, 1 with an error otherwise."""
    whole = write(tmp_path / "whole.hdf5", reduced(random_global(2, 3, seed=1))).read_bytes()
    random = np.random.default_rng(1)
    for _ in range(60):
        damaged = bytearray(whole)
        for position in random.integers(0, len(whole), 8):
            damaged[position] = random.integers(0, 256)
        (tmp_path / "damaged.hdf5").write_bytes(damaged)
        done = run("solve", "--max-iterations", 100, tmp_path / "damaged.hdf5")
        assert done.returncode in (0, 1), (done.returncode, done.stderr)


@pytest.mark.parametrize("layout, is_local", [("columns", True), ("rows", False), ("triplets", False)])
def test_every_dataset_is_missed_by_name(tmp_path, layout, is_local):
    problem = random_global(3, 3, seed=1, constraints=1)
    whole = write(tmp_path / "whole.hdf5", reduced(problem) if is_local else problem, layout)
    names = []
    with h5py.File(whole) as file:
        file.visititems(lambda name, item: names.append("/" + name) if isinstance(item, h5py.Dataset) else None)
    assert len(names) >= 10
    for name in names:
        (tmp_path / "p.hdf5").write_bytes(whole.read_bytes())
        with h5py.File(tmp_path / "p.hdf5", "a") as file:
            del file[name]
        refused(tmp_path / "p.hdf5", f"dataset {name} is missing", commands=["info"])
        (tmp_path / "p.hdf5").write_bytes(whole.read_bytes())
        with h5py.File(tmp_path / "p.hdf5", "a") as file:
            longer = np.append(file[name][:], file[name][:1])
            del file[name]
            file[name] = longer
        refused(tmp_path / "p.hdf5", f"dataset {name} has {len(longer)} entries, must have {len(longer) - 1}", commands=["info"])
        with h5py.File(tmp_path / "p.hdf5", "a") as file:
            del file[name]
            file[name] = ["text"] * (len(longer) - 1)
        refused(tmp_path / "p.hdf5", f"dataset {name} does not hold", commands=["info"])


@pytest.mark.parametrize("layout, name, entry, value, said", [
    ("columns", "W/nz", 0, -3, "must be -2"),
    ("columns", "W/m", 0, -9, "must not be negative"),
    ("columns", "W/n", 0, 12, "has 10 entries, must have 13"),
    ("columns", "W/nzmax", 0, -1, "must not be negative"),
    ("columns", "W/p", 0, 1, "must start with 0"),
    ("columns", "W/p", 4, 0, "decreases at entry 4"),
    ("rows", "W/p", 9, 1000, "more than nzmax"),
    ("columns", "W/i", 2, 9, "is 9 at entry 2, must be in 0 ... 8"),
    ("triplets", "W/p", 2, -1, "is -1 at entry 2"),
    ("triplets", "W/nz", 0, 10**6, "more than nzmax"),
    ("columns", "W/x", 3, np.nan, "is nan at entry 3, must be finite"),
    ("columns", "vectors/q", 1, np.inf, "is inf at entry 1, must be finite"),
    ("columns", "vectors/mu", 2, -0.1, "is -0.100000 at entry 2, must not be negative"),
    ("columns", "spacedim", 0, 5, "is 5, must be 2 or 3"),
    ("columns", "spacedim", 0, 2, "must be a multiple of spacedim = 2"),
])
def test_inadmissible_values(tmp_path, layout, name, entry, value, said):
    path = write(tmp_path / "p.hdf5", reduced(random_global(3, 3, seed=1)), layout)
    with h5py.File(path, "a") as file:
        file[f"fclib_local/{name}"][entry] = value
    refused(path, "dataset /fclib_local/", said)


def test_singular_mass(tmp_path):
    problem = random_global(3, 3, seed=1)
    problem.M[:, 0] = problem.M[0, :] = 0
    refused(write(tmp_path / "p.hdf5", problem), "/fclib_global/M", "singular")


def test_left_over_solution_of_another_size(tmp_path):
    """The problem is none the worse for it; only ``info``, which judges the solution, complains."""
    path = write(tmp_path / "p.hdf5", reduced(random_global(3, 3, seed=1)))
    with h5py.File(path, "a") as file:
        file["solution/r"] = file["solution/u"] = np.zeros(8)
    assert run("solve", path).returncode == 0
    done = run("info", path)
    assert done.returncode == 1 and "3 contacts" in done.stdout
    assert "dataset /solution/r has 8 entries, must have 9" in done.stderr


def test_strings_of_any_kind(tmp_path):
    """libfclib takes the bytes of a string for C's; h5py writes pointers unless told otherwise."""
    path = write(tmp_path / "p.hdf5", reduced(random_global(3, 3, seed=1)))
    with h5py.File(path, "a") as file:
        file["fclib_local/info/title"] = "variable length"
        file["fclib_local/info/description"] = np.bytes_("padded")
        file["fclib_local/info/math_info"] = 3
    for command in ("solve", "info"):
        assert run(command, path).returncode == 0
    with h5py.File(path, "a") as file:
        del file["fclib_local/info/title"]
        file["fclib_local/info/title"] = np.array([b"more", b"than", b"one"])
    refused(path, "dataset /fclib_local/info/title has 3 entries, must have 1")


def test_a_bad_file_does_not_keep_the_others_from_being_solved(tmp_path):
    good = write(tmp_path / "good.hdf5", reduced(random_global(3, 3, seed=1)))
    done = run("solve", tmp_path / "bad.hdf5", good)
    assert done.returncode == 1 and "bad.hdf5" in done.stderr and "good" in done.stdout
