# SPDX-License-Identifier: GPL-2.0-or-later
"""Kernels of the solver for grains against the memory bandwidth of the machine, in one run; called by ``scripts/bench sweep``.

Bandwidth is what a triad (STREAM) over 256 MB reaches with as many threads, in the same run; shares compare processor times. The bytes of a sweep are those that must cross the
border of the caches: each contact read once, its impulse, increment and direction written, each body read and written once. Small problems stay in
the caches, so their share may be above one.
"""

import argparse
import csv
import json
import os
import subprocess
from pathlib import Path

PROGRAM = Path(__file__).resolve().parents[2] / "build-benchmarks" / "contactdynamics_sweep"
FIELDS = ["kernel", "contacts", "threads", "ns_per_contact", "cpu_ns_per_contact", "bytes_per_contact", "share_of_bandwidth", "speed_up", "residual"]


def main() -> None:
    parser = argparse.ArgumentParser(prog="scripts/bench sweep", description=__doc__.splitlines()[0])
    parser.add_argument("--filter", default="", help="regular expression for the kernels, as Google Benchmark takes it")
    parser.add_argument("--repetitions", type=int, default=3, help="of each kernel; the fastest counts (default 3)")
    parser.add_argument("--out", default=os.path.join("out", "bench"))
    options = parser.parse_args()
    command = [str(PROGRAM), "--benchmark_format=json", f"--benchmark_repetitions={options.repetitions}"]
    command += [f"--benchmark_filter=triad|{options.filter}"] if options.filter else []
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, check=True)
    runs = [run for run in json.loads(done.stdout)["benchmarks"] if run["run_type"] == "iteration"]
    fastest = {}
    for run in runs:
        kept = fastest.setdefault(run["name"], run)
        if run["real_time"] < kept["real_time"]:
            fastest[run["name"]] = run
    bandwidth, rows = {}, []
    for run in fastest.values():
        kernel, *arguments = run["name"].split("/")
        sizes = {key: int(value) for key, value in (part.split(":") for part in arguments if ":" in part)}
        if kernel == "triad":
            # By processor time, as the kernels: on a busy machine the wall time tells what the others do.
            bandwidth[sizes["threads"]] = run["bytes"] / (run["cpu_time"] * 1e-3) * sizes["threads"]
            print(f"triad, {sizes['threads']} threads: {bandwidth[sizes['threads']] / 1e9:.1f} GB/s of processor time, {1e-6 * run['bytes'] / run['real_time']:.1f} GB/s of wall time")
            continue
        seconds = run["real_time"] * 1e-9
        alone = next((row for row in rows if (row["kernel"], row["asked"], row["threads"]) == (kernel, sizes["contacts"], 1)), None)
        own = 1e9 * seconds / run["contacts"]
        rows.append({
            "kernel": kernel, "asked": sizes["contacts"], "contacts": int(run["contacts"]), "threads": sizes["threads"], "ns_per_contact": own,
            "cpu_ns_per_contact": run["cpu_time"] / run["contacts"], "bytes_per_contact": run["bytes"] / run["contacts"],
            "share_of_bandwidth": run["bytes"] / (run["cpu_time"] * 1e-9) * sizes["threads"] / bandwidth[sizes["threads"]] if kernel in ("sweep", "generalSweep") else "",
            "speed_up": alone["ns_per_contact"] / own if alone else "", "residual": run["residual"],
        })
    os.makedirs(options.out, exist_ok=True)
    path = os.path.join(options.out, "sweep.csv")
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=FIELDS, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    for name in FIELDS:
        print(f"{name:>18}", end="")
    print()
    for row in rows:
        for name in FIELDS:
            print(f"{row[name]:>18.3g}" if isinstance(row[name], float) else f"{row[name]:>18}", end="")
        print()
    print(f"the fastest of {options.repetitions}; ns of wall and of processor time (all threads together); written to {path}")


main()
