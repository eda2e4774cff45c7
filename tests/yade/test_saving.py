# SPDX-License-Identifier: GPL-2.0-or-later
"""Same bits for any number of threads and across saving and loading; round trip of a file."""

from __future__ import annotations

from pathlib import Path

import pytest
from yade import MatchMaker, O

import saving_cases
from halves import same_bits
from scenes import cd, engine, equip, floor, grain, isolated, material, steps, vec
from test_classes import FUNCTORS, OF_CONTACT, OTHERS


@pytest.fixture(scope="module")
def one_run(tmp_path_factory) -> tuple[Path, str]:
    """Folder for results, and the numbers of an uninterrupted run on one thread."""
    folder = tmp_path_factory.mktemp("saving")
    isolated("yade", "saving_cases", "straight", folder / "one")
    return folder, (folder / "one").read_text()


@pytest.mark.parametrize("threads", [1, 2])
def test_same_bits_again_and_with_two_threads(one_run, threads: int) -> None:
    folder, expected = one_run
    isolated("yade", "saving_cases", "straight", folder / "again", threads=threads)
    assert (folder / "again").read_text() == expected


def test_same_bits_of_many_contacts_with_any_number_of_threads(tmp_path) -> None:
    """Large enough for the solver to use its threads; three are more than some machines have cores."""
    for threads in (1, 2, 3):
        isolated("yade", "saving_cases", "together", tmp_path / str(threads), threads=threads)
    expected = (tmp_path / "1").read_text()
    assert (tmp_path / "2").read_text() == expected
    assert (tmp_path / "3").read_text() == expected


def test_same_bits_of_a_turning_mesh(tmp_path) -> None:
    """Seams of facets that an engine drives and bodies that vanish in mid-run: three threads, and a file between."""
    isolated("yade", "saving_mesh_cases", "to_the_end", tmp_path / "one")
    expected = (tmp_path / "one").read_text()
    isolated("yade", "saving_mesh_cases", "to_the_end", tmp_path / "three", threads=3)
    assert (tmp_path / "three").read_text() == expected
    isolated("yade", "saving_mesh_cases", "first", tmp_path / "half.xml")
    isolated("yade", "saving_mesh_cases", "to_the_end", tmp_path / "second", tmp_path / "half.xml", threads=2)
    assert (tmp_path / "second").read_text() == expected


@pytest.mark.parametrize("vessel", ["hopper", "drum"])
def test_same_bits_of_a_vessel(vessel: str, tmp_path) -> None:
    same_bits(f"{vessel}_cases", tmp_path)


@pytest.mark.parametrize("ending", [".xml", ".xml.bz2", ".yade", ".yade.gz"])
def test_same_bits_across_a_file_and_a_new_process(one_run, ending: str) -> None:
    folder, expected = one_run
    scene = folder / f"half{ending}"
    isolated("yade", "saving_cases", "until_half", scene, threads=2)
    isolated("yade", "saving_cases", "from_half", scene, folder / "second")
    assert (folder / "second").read_text() == expected


def test_same_bits_across_memory() -> None:
    """O.saveTmp and O.loadTmp in one process."""
    saving_cases.build()
    steps(saving_cases.FIRST)
    O.saveTmp()
    steps(20)
    expected = saving_cases.numbers()
    O.loadTmp()
    steps(20)
    assert saving_cases.numbers() == expected


def test_same_bits_across_reload() -> None:
    """Twice from the same state in memory, after the scene went on: nothing hides outside of the scene."""
    saving_cases.build()
    steps(40)
    O.saveTmp("early")
    steps(5)
    expected = saving_cases.numbers()
    steps(60)
    O.loadTmp("early")
    steps(5)
    assert saving_cases.numbers() == expected


@pytest.mark.parametrize("ending", [".xml", ".xml.bz2", ".yade", ".yade.gz"])
def test_round_trip_of_the_classes(tmp_path, ending: str) -> None:
    """Settings, functors with a MatchMaker, and the contact with its impulse."""
    rough, smooth = material(friction=0.7), material(friction=0.2)
    floor(material=rough)
    grain((0, 0, 1), velocity=(2, 0, 0), material=smooth)
    given = OTHERS["ContactDynamicsEngine"]
    equip(1e-3, **given)
    engine("InteractionLoop").physDispatcher.functors[0].frictAngle = MatchMaker(matches=((rough.id, smooth.id, 0.3),))
    steps(2)
    before = {name: str(getattr(O.interactions[0, 1].phys, name)) for name in OF_CONTACT}
    impulse = vec(O.interactions[0, 1].phys.impulse)
    assert any(impulse)
    O.save(str(tmp_path / f"scene{ending}"))
    O.reset()
    O.load(str(tmp_path / f"scene{ending}"))
    assert {name: getattr(cd(), name) for name in given} == given
    loop = engine("InteractionLoop")
    assert loop.physDispatcher.functors[0].frictAngle(rough.id, smooth.id) == 0.3
    dispatchers = [loop.geomDispatcher, loop.physDispatcher, loop.lawDispatcher]
    dispatchers.append(engine("InsertionSortCollider").boundDispatcher)
    kinds = [type(f).__name__ for d in dispatchers for f in d.functors]
    assert sorted(kinds) == sorted(FUNCTORS)
    assert tuple(O.interactions[0, 1].phys.impulse) == tuple(impulse)
    assert {name: str(getattr(O.interactions[0, 1].phys, name)) for name in OF_CONTACT} == before
    steps(1)
    assert cd().contacts == 1
