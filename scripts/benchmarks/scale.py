# SPDX-License-Identifier: GPL-2.0-or-later
"""Whole steps of YADE for more and more spheres: share of each engine, error and memory; called by ``scripts/bench scale``.

The steps timed are those of a packing that has just come together and settles, after a warming-up that brings the contacts. The memory is what a process that
has loaded the last scene, interactions included, grows by when ContactDynamicsEngine and NewtonIntegrator join its engines, over the contacts of the solve.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))


def job(threads: int, *words: str) -> dict:
    """The dictionary that scale_job.py prints in a fresh YADE process."""
    command = ["yade", "-n", "-x", f"-j{threads}", os.path.join(HERE, "scale_job.py"), *words]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    if done.returncode != 0 or not lines:
        sys.exit(f"{' '.join(command)} failed with code {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return json.loads(lines[0][len("RESULT "):])


def run(spheres: int, threads: int, options: argparse.Namespace) -> dict:
    """Time and memory of one scene."""
    print(f"running {spheres} spheres on {threads} threads", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.yade.gz")
        times = job(threads, "time", *(str(number) for number in (spheres, options.seed, options.warming, options.steps)), scene)
        return {**times, **job(threads, "memory", scene)}


def main() -> None:
    parser = argparse.ArgumentParser(prog="scripts/bench scale", description=__doc__.splitlines()[0])
    parser.add_argument("--spheres", type=int, nargs="*", default=[1000, 10000, 100000])
    parser.add_argument("--threads", type=int, nargs="*", default=[1, 2])
    parser.add_argument("--warming", type=int, default=30, help="steps before the clock starts (default 30)")
    parser.add_argument("--steps", type=int, default=10, help="steps that are timed (default 10)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default=os.path.join("out", "bench"))
    options = parser.parse_args()
    results = [run(spheres, threads, options) for spheres in options.spheres for threads in options.threads]
    os.makedirs(options.out, exist_ok=True)
    path = os.path.join(options.out, "scale.csv")
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(results[0]))
        writer.writeheader()
        writer.writerows(results)
    width = max(len(name) for name in results[0])
    for name in results[0]:
        print(f"  {name:<{width}}" + "".join(f"{result[name]:>12.4g}" for result in results))
    print(f"wall times; written to {path}")


main()
