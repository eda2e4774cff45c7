# SPDX-License-Identifier: GPL-2.0-or-later
"""Fixtures of the tests that run inside YADE."""

import pytest


@pytest.fixture(autouse=True)
def fresh_scene():
    """Every test starts from an empty scene without engines and leaves none of its settings behind."""
    from yade import O

    def clear() -> None:
        O.reset()
        O.timingEnabled = False

    clear()
    yield
    clear()
