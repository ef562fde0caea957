#!/usr/bin/env python3
"""Whole-process time and peak memory of `sagefe run` on the pinned cylinder with n x 2n Q4 elements, and where both go.

Usage: scaling.py SAGEFE [-n RUNS] [--options "..."] [N ...]      (default: 14 56 112 224 448)
The scene: quarter of an elastic specimen, L/D = 2, nu = .25, pinned ends, one increment of axial compression.
Prints medians (with minimum and maximum: machines are noisy) as a Markdown table, and the exponent of every
column between the last two sizes.  Nothing here passes or fails.
"""
import argparse
import math
import os
import pathlib
import re
import shlex
import statistics
import subprocess
import tempfile
import time

import specimen

PARTS = {
    "assembly": r"passes ([\d.e+-]+) s",
    "numbering": r"numbering ([\d.e+-]+) s",
    "factor": r"factorisations? ([\d.e+-]+) s",
    "solve": r"solves? ([\d.e+-]+) s",
    "condensation": r"condensation ([\d.e+-]+) s",
    "iteration": r"iteration ([\d.e+-]+) s",
    "checks": r"checks ([\d.e+-]+) s",
    "output": r"output ([\d.e+-]+) s",
    "reading": r"reading ([\d.e+-]+) s",
    "model": r"model ([\d.e+-]+) s",
    "files": r"files ([\d.e+-]+) s",
    "whole run": r"whole run ([\d.e+-]+) s",
}


def run_once(command):
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    text = process.stdout.read().decode()
    errors = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    if status != 0:
        raise SystemExit(f"{' '.join(command)}: exit status {status}\n{errors}")
    parts = {name: float(m.group(1)) for name, pattern in PARTS.items() if (m := re.search(pattern, text))}
    times = {"wall": wall, "processor": usage.ru_utime + usage.ru_stime, **parts}
    return times, usage.ru_maxrss / 1024.0, text  # seconds, MB, summary


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sagefe")
    parser.add_argument("sizes", nargs="*", type=int)
    parser.add_argument("-n", type=int, default=3, help="runs of every size")
    parser.add_argument("--options", default="", help="options for sagefe run")
    parser.add_argument("--show", action="store_true", help="print the summary of every size's last run")
    args = parser.parse_intermixed_args()
    columns = ["wall", "processor", *PARTS]
    print("| n | wall s (min-max) | processor | " + " | ".join(PARTS) + " | rest | peak MB |")
    print("|---" * (len(PARTS) + 5) + "|")
    medians = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "wide.toml").write_text(specimen.wide_layout())
        for n in args.sizes or [14, 56, 112, 224, 448]:
            (folder / f"cylinder_{n}.dat").write_text(specimen.elastic(n))
            command = [args.sagefe, "run", "--layout", str(folder / "wide.toml"), "-o", str(folder / "out")]
            command += [str(folder / f"cylinder_{n}.dat"), *shlex.split(args.options)]
            runs = [run_once(command) for _ in range(args.n)]
            median = {c: statistics.median(r[0].get(c, 0.0) for r in runs) for c in columns}
            walls = [r[0]["wall"] for r in runs]
            known = sum(median[p] for p in PARTS if p != "whole run")
            median["rest"] = median["wall"] - known
            median["MB"] = max(r[1] for r in runs)
            medians.append((n, median))
            print(
                f"| {n} | {median['wall']:.4g} ({min(walls):.4g}-{max(walls):.4g}) | {median['processor']:.4g} | "
                + " | ".join(f"{median[p]:.4g}" for p in PARTS)
                + f" | {median['rest']:.4g} | {median['MB']:.0f} |",
                flush=True,
            )
            if args.show:
                print(runs[-1][2])
    if len(medians) > 1:
        (n0, first), (n1, last) = medians[-2:]
        print("\nExponents of n between the last two sizes (2 = in proportion to the equations):")
        for key in first:
            if first[key] > 0 and last[key] > 0:
                print(f"  {key:10s} {math.log(last[key] / first[key]) / math.log(n1 / n0):.2f}")


if __name__ == "__main__":
    main()
