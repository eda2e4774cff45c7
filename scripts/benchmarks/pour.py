# SPDX-License-Identifier: GPL-2.0-or-later
"""The same pour with Contact Dynamics and with YADE's soft law, side by side; called by ``scripts/bench pour``.

Each run is a process of its own; the two laws alternate, so that a machine that slows down or speeds up meets both. The stiffness of
the soft law is not a free choice: it is found here, as the one that brings the mean overlap at rest to the asked value.
"""

import argparse
import csv
import json
import os
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SHOWN = ["law", "repeat", "wall_s", "processor_s", "time_to_rest_s", "wall_per_simulated_s", "steps", "dt_s", "contacts", "mean_overlap_over_r", "max_overlap_over_r_in_pour",
         "coordination", "rattlers", "packing_fraction", "support_over_weight"]


def run(law: str, repeat: int, seed: int, young: float) -> dict:
    """One pour in a fresh YADE process; the dictionary that pour_job.py prints."""
    command = ["yade", "-n", "-x", os.path.join(HERE, "pour_job.py"), law, str(repeat), str(seed), repr(young)]
    print(f"running {law:4} (repeat {repeat}, seed {seed}" + (f", young {young:.3g} Pa)" if law == "soft" else ")"), flush=True)
    # YADE executes a script without telling it where it lies, so the job finds the scene of the example by the search path.
    examples = os.path.join(os.path.dirname(HERE), "examples")
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join([examples, os.environ["PYTHONPATH"]]))
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, env=environment)
    lines = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    if done.returncode != 0 or not lines:
        sys.exit(f"{' '.join(command)} failed with code {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return json.loads(lines[0][len("RESULT "):])


def stiffness(overlap: float, seed: int, guess: float) -> float:
    """Young's modulus [Pa] at which the mean overlap at rest is just below ``overlap``.

    At rest the forces are given by the weight, so the overlap is inversely proportional to the modulus; one trial is enough to scale
    from. Another modulus ends in another packing, though, whose mean overlap differs by a tenth or so: hence the margin.
    """
    return guess * run("soft", 0, seed, guess)["mean_overlap_over_r"] / overlap * 1.2


def show(results: list[dict]) -> None:
    """Print the results as a table, one column a run."""
    width = max(len(name) for name in SHOWN)
    for name in SHOWN:
        cells = [result[name] for result in results]
        print(f"  {name:<{width}}" + "".join(f"{cell:>12.4g}" if isinstance(cell, float) else f"{cell:>12}" for cell in cells))


def main() -> None:
    parser = argparse.ArgumentParser(prog="scripts/bench pour", description="Contact Dynamics and soft contacts, the same pour to rest.")
    parser.add_argument("--repeats", type=int, default=1, help="pairs of runs; the ratio is taken from the medians (default 1)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the grains' random velocities (default 1)")
    parser.add_argument("--overlap", type=float, default=1e-3, help="mean overlap / radius at rest allowed to the soft law (default 1e-3)")
    parser.add_argument("--young", type=float, help="Young's modulus of the soft law in Pa, instead of finding it from --overlap")
    parser.add_argument("--out", default=os.path.join("out", "bench"), help="folder of the CSV file (default out/bench)")
    options = parser.parse_args()
    if options.repeats < 1 or not 0 < options.overlap < 0.1:
        parser.error("--repeats must be at least 1 and --overlap between 0 and 0.1")

    young = options.young or stiffness(options.overlap, options.seed, 4e5)
    results = []
    for repeat in range(1, options.repeats + 1):
        results += [run(law, repeat, options.seed, young) for law in ("cd", "soft")]

    os.makedirs(options.out, exist_ok=True)
    path = os.path.join(options.out, "pour.csv")
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(results[0]))
        writer.writeheader()
        writer.writerows(results)
    show(results)
    print("\none thread; at rest: unbalancedForce() < 1e-4 twice in a row, looked at every 5 ms; coordination without rattlers; only the steps are timed")
    print(f"soft law: CundallStrack, young {young:.3g} Pa, dt = 0.3 PWaveTimeStep, local damping 0.4; written to {path}")

    hard, soft = ([result for result in results if result["law"] == law] for law in ("cd", "soft"))
    if not all(result["at_rest"] for result in results):
        sys.exit("a run did not come to rest, so there is no ratio")
    deepest = max(result["mean_overlap_over_r"] for result in soft)
    if deepest > options.overlap:
        sys.exit(f"the soft law ended at a mean overlap of {deepest:.2e} r, above the {options.overlap:g} r that it was allowed")
    for name, what in (("wall_s", "wall"), ("processor_s", "processor")):
        ratio = statistics.median(r[name] for r in soft) / statistics.median(r[name] for r in hard)
        print(f"ratio of {what} times to rest, soft / Contact Dynamics: {ratio:.2f}")


main()
