#!/usr/bin/env python3
"""Whole-process time and peak memory of `sagefe run` on decks, and where the time goes.

Usage: whole_run.py SAGEFE [-n RUNS] [DECK ...]      (default: the chapter's elastic and Drucker-Prager decks)
Prints medians (with minimum and maximum: machines are noisy) as a Markdown table.  Nothing here passes or fails.
"""
import argparse
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
DECKS = ["chapter7/pinned_ld2_nu025", "chapter7/friction_285_nu0495", "chapter7/dp_285"]
# Seconds as the summary prints them.
PARTS = {
    "assembly": r"passes ([\d.e+-]+) s",
    "factor": r"factorisations? ([\d.e+-]+) s",
    "solve": r"solves? ([\d.e+-]+) s",
    "numbering": r"numbering ([\d.e+-]+) s",
    "output": r"output ([\d.e+-]+) s",
    "whole run": r"whole run ([\d.e+-]+) s",
}


def run_once(sagefe, deck, folder):
    start = time.perf_counter()
    process = subprocess.Popen([sagefe, "run", str(deck), "-o", folder], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    text = process.stdout.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    if status != 0:
        raise SystemExit(f"{deck}: exit status {status}")
    parts = {name: float(m.group(1)) for name, pattern in PARTS.items() if (m := re.search(pattern, text))}
    return wall, usage.ru_maxrss / 1024.0, parts


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sagefe")
    parser.add_argument("decks", nargs="*")
    parser.add_argument("-n", type=int, default=11)
    args = parser.parse_args()
    decks = [pathlib.Path(d) for d in args.decks] or [ROOT / "legacy_inputs" / d / "deck.dat" for d in DECKS]
    print("| deck | wall ms (min-max) | peak MB | " + " | ".join(f"{p} ms" for p in PARTS) + " | start and end ms |")
    print("|---" * (len(PARTS) + 4) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for deck in decks:
            run_once(args.sagefe, deck, folder)  # warm-up
            runs = [run_once(args.sagefe, deck, folder) for _ in range(args.n)]
            walls = [1e3 * r[0] for r in runs]
            parts = {p: 1e3 * statistics.median(r[2].get(p, 0.0) for r in runs) for p in PARTS}
            wall = statistics.median(walls)
            print(
                f"| {deck.parent.name} | {wall:.1f} ({min(walls):.1f}-{max(walls):.1f}) | {max(r[1] for r in runs):.1f} | "
                + " | ".join(f"{parts[p]:.2f}" for p in PARTS)
                + f" | {wall - parts['whole run']:.1f} |"
            )


if __name__ == "__main__":
    main()
