# SPDX-License-Identifier: GPL-2.0-or-later
"""Every kind of bad input gives a clear error, and the scene can be used afterwards."""

import pytest

from bad_input_cases import cases
from scenes import isolated


@pytest.mark.parametrize("case", cases())
def test_bad_input(case: str) -> None:
    isolated("yade", "bad_input_cases", case, threads=2)
