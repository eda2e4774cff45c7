# SPDX-License-Identifier: GPL-2.0-or-later
"""Run YADE's own ``--test`` and ``--check`` with and without the plugin and compare, test by test.

    PYTHONPATH=build/python python3 scripts/lib/stock_suites.py LOG_FOLDER

``yade -L contactdynamics`` imports the plugin before YADE starts its suite, so it is YADE's own command that runs, unchanged.
Failures of stock YADE on this machine are not ours: what counts is that the plugin adds none and takes none away.
"""

import os
import re
import subprocess
import sys


def run(suite: str, plugin: bool, folder: str) -> tuple[int, str]:
    """Run ``yade --SUITE`` in a folder of its own, because the suites write files where they run; exit code and all that it printed."""
    name = os.path.join(folder, f"stock-{suite}-{'with' if plugin else 'without'}-plugin")
    os.makedirs(name, exist_ok=True)
    command = ["yade", "-n", *(["-L", "contactdynamics"] if plugin else []), f"--{suite}"]
    # -L imports YADE before it has read its own options, so the number of threads has to come from outside.
    environment = dict(os.environ, OMP_NUM_THREADS="1", PYTHONPATH=os.path.abspath(os.environ["PYTHONPATH"]))
    with open(name + ".log", "w") as out:
        code = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, env=environment, cwd=name).returncode
    with open(name + ".log", errors="replace") as log:
        return code, log.read()


def unitTests(text: str) -> dict[str, str]:
    """Outcome of ``yade --test``: how many tests ran, and each one that did not pass."""
    ran = re.search(r"^Ran (\d+) tests? in", text, re.MULTILINE)
    outcome = {"tests that ran": ran.group(1) if ran else "0"}
    outcome.update({name: kind for kind, name in re.findall(r"^(FAIL|ERROR): (.+)$", text, re.MULTILINE)})
    outcome.update({f"skipped {reason}": "skipped" for reason in re.findall(r"\.\.\. skipped (.+)$", text, re.MULTILINE)})
    return outcome


def checks(text: str) -> dict[str, str]:
    """Outcome of ``yade --check``: every script with passed, failed or skipped."""
    outcome = {name: "skipped" for name in re.findall(r"^Skipping (\S+),", text, re.MULTILINE)}
    for name, rest in re.findall(r"^running: +(\S+)$(.*?)(?=^#{20}|\Z)", text, re.MULTILINE | re.DOTALL):
        outcome[name] = "passed" if re.search(r"^Status:.* success", rest, re.MULTILINE) else "failed"
    return outcome


def main(folder: str) -> int:
    different, lines = False, []
    for suite, read in (("test", unitTests), ("check", checks)):
        # One after the other: the doctest of plot.saveDataTxt writes, reads and removes a file of a fixed name in /tmp, and fails beside its twin.
        codes, texts = zip(*[run(suite, plugin, folder) for plugin in (False, True)])
        stock, ours = (read(text) for text in texts)
        if len(stock) == 0 or stock.get("tests that ran") == "0":
            sys.exit(f"yade --{suite} ran nothing; see {folder}/stock-{suite}-*.log")
        for name in sorted(set(stock) | set(ours)):
            if stock.get(name) != ours.get(name):
                different = True
                print(f"yade --{suite}: {name}: {stock.get(name, 'absent')} without the plugin, {ours.get(name, 'absent')} with it")
        if codes[0] != codes[1]:
            different = True
            print(f"yade --{suite}: exit code {codes[0]} without the plugin, {codes[1]} with it")
        passed = sum(value == "passed" for value in stock.values())
        skipped = sum(value == "skipped" for value in stock.values())
        lines.append(f"--test {ours['tests that ran']} tests" if suite == "test" else f"--check {passed} passed, {skipped} skipped")
        lines[-1] += f", exit code {codes[1]}"
    print(f"The plugin {'CHANGES' if different else 'changes nothing in'} YADE's own suites: {'; '.join(lines)}")
    return int(different)


sys.exit(main(sys.argv[1]))
