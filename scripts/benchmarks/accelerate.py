# SPDX-License-Identifier: GPL-2.0-or-later
"""Default against plain Gauss-Seidel on steps of warm-started pours, to the same certificate 1e-4; called by ``scripts/bench accelerate``.

Impact is a step in which the grains still move, with a mean kinetic energy of 1e-3 m g r or more; the others count as rest.
"""

import argparse
import csv
import os
import subprocess
from pathlib import Path

PROGRAM = Path(__file__).resolve().parents[2] / "build-benchmarks" / "contactdynamics_accelerate"


def pour(grains: int, friction: float, heavy: float, steps: int, every: int, seed: int) -> list[dict]:
    """The sampled steps of one pour, as rows of the CSV."""
    command = [str(PROGRAM), str(grains), repr(friction), repr(heavy), str(steps), str(every), str(seed)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True)
    return list(csv.DictReader(done.stdout.splitlines()))


def summary(rows: list[dict]) -> str:
    """Sums over the steps: ratios of sweeps and time, and how often each side missed the tolerance."""
    if not rows:
        return "no such step"
    total = {name: sum(float(row[name]) for row in rows) for name in ("sweeps", "seconds", "plain_sweeps", "plain_seconds", "converged", "plain_converged")}
    worst = max(float(row["sweeps"]) / float(row["plain_sweeps"]) for row in rows)
    return (
        f"{len(rows):3d} steps, sweeps {total['sweeps'] / len(rows):7.1f} against {total['plain_sweeps'] / len(rows):7.1f} (ratio {total['sweeps'] / total['plain_sweeps']:.3f}, "
        f"worst {worst:.2f}), time ratio {total['seconds'] / total['plain_seconds']:.3f}, missed {len(rows) - total['converged']:.0f} against {len(rows) - total['plain_converged']:.0f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(prog="scripts/bench accelerate", description=__doc__.splitlines()[0])
    parser.add_argument("--grains", type=int, default=1000)
    parser.add_argument("--frictions", type=float, nargs="*", default=[0.0, 0.3, 0.5, 0.8])
    parser.add_argument("--steps", type=int, default=400)
    parser.add_argument("--every", type=int, default=10, help="steps from one comparison to the next (default 10)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default=os.path.join("out", "bench"))
    options = parser.parse_args()
    rows = []
    for friction in options.frictions:
        for heavy in (0.0, 0.1):
            found = pour(options.grains, friction, heavy, options.steps, options.every, options.seed)
            rows += found
            moving = [row for row in found if float(row["kinetic_over_mgr"]) >= 1e-3]
            print(f"friction {friction:g}, {100 * heavy:g} % of the grains a hundred times heavier")
            print("    impact:", summary(moving))
            print("    rest:  ", summary([row for row in found if row not in moving]), flush=True)
    os.makedirs(options.out, exist_ok=True)
    path = os.path.join(options.out, "accelerate.csv")
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    print(f"certificate 1e-4, one thread, processor time; written to {path}")


main()
