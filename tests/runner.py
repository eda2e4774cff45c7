# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs one folder of tests with pytest inside the YADE process that executes it."""

from __future__ import annotations

import sys
from pathlib import Path


def run(folder: Path, arguments: list[str]) -> None:
    """Run every test below `folder` and leave the process with pytest's exit status.

    `arguments` go to pytest (so does the environment variable PYTEST_ADDOPTS). Neither bytecode nor pytest's cache is
    written, because the folder belongs to the source tree.
    """
    import pytest

    sys.dont_write_bytecode = True
    options = [str(folder), f"--rootdir={folder.parent}", "-p", "no:cacheprovider", "--durations=5", "--tb=short"]
    status = int(pytest.main(options + arguments))
    sys.stdout.flush()
    sys.exit(status)
