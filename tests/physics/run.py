# SPDX-License-Identifier: GPL-2.0-or-later
"""Executed by YADE: `PYTHONPATH=build/python yade -n -x tests/physics/run.py [pytest options]`."""

import sys
from pathlib import Path

sys.dont_write_bytecode = True
# YADE executes scripts without setting __file__, but the script's path is the first argument.
folder = Path(sys.argv[0]).resolve().parent
sys.path.insert(0, str(folder.parent))

from runner import run  # noqa: E402  (the path has to be set first)

run(folder, sys.argv[1:])
