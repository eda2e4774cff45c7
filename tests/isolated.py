# SPDX-License-Identifier: GPL-2.0-or-later
"""Executed by a YADE of its own: `yade -n -x isolated.py FOLDER MODULE FUNCTION [ARGUMENT ...]` calls the function.

Used where a test needs a fresh process: another number of threads, or a defect that would end the process.
"""

import importlib
import sys
from pathlib import Path

sys.dont_write_bytecode = True
tests = Path(sys.argv[0]).resolve().parent
sys.path[:0] = [str(tests), str(tests / sys.argv[1])]
getattr(importlib.import_module(sys.argv[2]), sys.argv[3])(*sys.argv[4:])
