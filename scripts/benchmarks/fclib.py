# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems of a folder with this solver and with those of Siconos, in one run; called by ``scripts/bench fclib``.

Both sides start from zero impulses, use one thread and stop on the tolerance asked for; a problem counts as solved when Siconos's error
of the impulses returned (see ``scripts/fclib --help``), computed by one and the same formula, is at most the tolerance, whatever the
solver says. Sides alternate problem by problem. Siconos is called from Python, which costs some 20 microseconds a call: the means are
therefore also given for problems with more than 20 contacts alone.
"""

import argparse
import csv
import importlib.util
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROGRAM = HERE.parents[1] / "build" / "bin" / "contactdynamics-fclib"
SOLVERS = {
    3: ["nsgs", "nsgs-full", "nsgs-projection", "nsgs-projection-iterated", "nsgs-quartic", "newton-alart-curnier", "admm"],
    2: ["nsgs"],
}
FIELDS = ["problem", "dimension", "contacts", "tolerance", "solver", "iterations", "seconds", "error", "solved"]


def ours(file: Path, tolerance: float, iterations: int, folder: str) -> dict:
    """This solver on one file; its problem is left in ``folder`` in local form."""
    out = Path(folder) / "ours.json"
    command = [str(PROGRAM), "solve", "--tolerance", repr(tolerance), "--max-iterations", str(iterations), "--json", str(out), "--write", folder, str(file)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stderr}")
    result = json.loads(out.read_text())[0]
    return dict(result, solver="contactdynamics", solved=result["converged"])


def siconos(local: Path, solver: str, tolerances: list[float], iterations: int, limit: float) -> list[dict]:
    """One solver of Siconos on one file, for all tolerances; without time and error where it crashed or met the limit."""
    command = [sys.executable, str(HERE / "fclib_siconos.py"), str(local), solver, str(iterations), *map(repr, tolerances)]
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    try:
        output = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=limit * len(tolerances), env=environment).stdout
    except subprocess.TimeoutExpired as expired:
        output = (expired.stdout or b"").decode()
    # Siconos prints to standard output as well.
    results = [json.loads(line.split("RESULT ", 1)[1]) for line in output.splitlines() if "RESULT " in line]
    for result in results:
        result["solved"] = result["error"] is not None and result["error"] <= result["tolerance"] and result["seconds"] <= limit
    for tolerance in tolerances[len(results):]:
        results.append({"tolerance": tolerance, "iterations": None, "seconds": None, "error": None, "solved": False})
    return [dict(result, solver="siconos-" + solver) for result in results]


def geometric_mean(ratios: list[float]) -> str:
    return f"{math.exp(sum(map(math.log, ratios)) / len(ratios)):8.2f} (of {len(ratios)})" if ratios else "       - (of 0)"


def summary(rows: list[dict], tolerance: float) -> None:
    """How many each solver solves, and how much faster this one is than Siconos's default and than the best of Siconos per problem."""
    of_problem: dict[str, dict[str, dict]] = {}
    for row in rows:
        if row["tolerance"] == tolerance:
            of_problem.setdefault(row["problem"], {})[row["solver"]] = row
    print(f"\ntolerance {tolerance:g}: solved")
    for solver in ["contactdynamics"] + ["siconos-" + name for name in SOLVERS[3]]:
        asked = [results[solver] for results in of_problem.values() if solver in results]
        if asked:
            print(f"  {solver:<34}{sum(row['solved'] for row in asked):4} of {len(asked)}")
    for least, which in ((0, "all problems"), (20, "more than 20 contacts")):
        default, best = [], []
        for results in of_problem.values():
            own = results["contactdynamics"]
            if not own["solved"] or own["contacts"] <= least:
                continue
            peers = {name: row for name, row in results.items() if name != "contactdynamics" and row["solved"]}
            if "siconos-nsgs" in peers:
                default.append(peers["siconos-nsgs"]["seconds"] / own["seconds"])
            if peers:
                best.append(min(row["seconds"] for row in peers.values()) / own["seconds"])
        print(f"  times faster, geometric mean over problems that both solve, {which}:")
        print(f"    than Siconos's default NSGS       {geometric_mean(default)}")
        print(f"    than the best Siconos per problem {geometric_mean(best)}")
    behind = [name for name, results in of_problem.items() if not results["contactdynamics"]["solved"] and any(row["solved"] for row in results.values())]
    print("  solved by Siconos and not here: " + (", ".join(behind) or "none"))


def main() -> None:
    parser = argparse.ArgumentParser(prog="scripts/bench fclib", description="FCLIB problems with this solver and with Siconos (Debian: python3-siconos).")
    parser.add_argument("folder", type=Path, help="folder of *.hdf5 files; none comes with the project")
    parser.add_argument("--tolerances", type=float, nargs="+", default=[1e-4, 1e-8], help="default 1e-4 1e-8")
    parser.add_argument("--max-iterations", type=int, default=100000, help="for both sides (default 100000)")
    parser.add_argument("--limit", type=float, default=60, help="seconds that Siconos may take for one solve (default 60)")
    parser.add_argument("--out", default=os.path.join("out", "bench"), help="folder of the CSV file (default out/bench)")
    options = parser.parse_args()
    files = sorted(options.folder.glob("*.hdf5")) + sorted(options.folder.glob("*.h5"))
    if not files:
        parser.error(f"there is no *.hdf5 in {options.folder}")
    with_siconos = importlib.util.find_spec("siconos") is not None
    if not with_siconos:
        print("Siconos is not installed (apt-get install python3-siconos), so there is only one side.")

    rows: list[dict] = []
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            results = [ours(file, tolerance, options.max_iterations, folder) for tolerance in options.tolerances]
            same = {key: results[0][key] for key in ("problem", "dimension", "contacts")}
            if with_siconos:
                for solver in SOLVERS[same["dimension"]]:
                    results += siconos(Path(folder) / f"{file.stem}.hdf5", solver, options.tolerances, options.max_iterations, options.limit)
        results = [dict(result, **same) for result in results]
        rows += results
        for tolerance in options.tolerances:
            print(f"{same['problem']:<40}{same['contacts']:6} {tolerance:7.0e}", end="")
            for result in results:
                if result["tolerance"] == tolerance:
                    took = "-" if result["seconds"] is None else f"{result['iterations']}/{result['seconds']:.2e}"
                    print(f"  {result['solver'].removeprefix('siconos-')} {took}{'' if result['solved'] else 'x'}", end="")
            print(flush=True)

    os.makedirs(options.out, exist_ok=True)
    path = os.path.join(options.out, "fclib.csv")
    with open(path, "w", newline="") as out:
        writer = csv.DictWriter(out, FIELDS, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    print(f"\nsweeps/seconds, x: tolerance not reached; one thread; written to {path}")
    for tolerance in options.tolerances:
        summary(rows, tolerance)


main()
