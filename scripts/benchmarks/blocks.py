# SPDX-License-Identifier: GPL-2.0-or-later
"""Random polyhedra poured to rest: time per step and contacts; called by ``scripts/bench blocks``."""

import argparse
import csv
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))


def main() -> None:
    parser = argparse.ArgumentParser(prog="scripts/bench blocks", description="Random polyhedra poured to rest: time per step and contacts.")
    parser.add_argument("--bodies", type=int, default=1000, help="number of polyhedra (default 1000)")
    parser.add_argument("--seed", type=int, default=1, help="seed of shapes and orientations (default 1)")
    parser.add_argument("--threads", type=int, default=1, help="threads of YADE (default 1)")
    parser.add_argument("--time", type=float, default=8.0, help="longest simulated time, in units of sqrt(height of the fall / g) (default 8)")
    parser.add_argument("--out", default=os.path.join("out", "bench"), help="folder of the CSV file (default out/bench)")
    options = parser.parse_args()
    if options.bodies < 1 or options.threads < 1:
        parser.error("--bodies and --threads must be at least 1")

    command = ["yade", "-n", "-x", f"-j{options.threads}", os.path.join(HERE, "blocks_job.py")]
    command += [str(options.bodies), str(options.seed), repr(options.time)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    if done.returncode != 0 or not lines:
        sys.exit(f"{' '.join(command)} failed with code {done.returncode}:\n{done.stdout}")
    result = json.loads(lines[0][len("RESULT "):])
    os.makedirs(options.out, exist_ok=True)
    path = os.path.join(options.out, "blocks.csv")
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(result))
        writer.writeheader()
        writer.writerow(result)
    width = max(len(name) for name in result)
    for name, value in result.items():
        print(f"  {name:<{width}}" + (f"{value:>14.4g}" if isinstance(value, float) else f"{value:>14}"))
    print(f"written to {path}; times of one thread are processor times, of several wall times")


main()
