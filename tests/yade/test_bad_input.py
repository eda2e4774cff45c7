# SPDX-License-Identifier: GPL-2.0-or-later
"""Every kind of bad input gives a clear error, and the scene can be used afterwards."""

from __future__ import annotations

import json

import pytest

from bad_input_cases import cases
from scenes import isolated


@pytest.fixture(scope="module")
def results(tmp_path_factory) -> dict[str, str]:
    """Result of each case. One process runs them all; if one ends it, another process goes on with the next case."""
    protocol = tmp_path_factory.mktemp("bad_input") / "protocol"
    protocol.touch()
    done: dict[str, str] = {}
    while remaining := [case for case in cases() if case not in done]:
        try:
            isolated("yade", "bad_input_cases", "run_cases", protocol, *remaining, threads=2)
            death = "the process ended without running it"
        except AssertionError as error:
            death = f"the process ended: {error}"
        done.update(json.loads(line) for line in protocol.read_text().splitlines())
        if (killer := next((case for case in remaining if case not in done), None)) is not None:
            done[killer] = death
    return done


@pytest.mark.parametrize("case", cases())
def test_bad_input(case: str, results: dict[str, str]) -> None:
    assert results[case] == ""
