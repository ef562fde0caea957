#!/usr/bin/env python3
"""Whole-process time and peak memory of `sagefe run` on decks, and where the time goes.

Usage: whole_run.py SAGEFE [-n RUNS] [DECK ...]      (default: the chapter's elastic and Drucker-Prager decks)
Prints medians (with minimum and maximum: machines are noisy) as a Markdown table.  Nothing here passes or fails.
"""
import argparse
import pathlib
import statistics
import tempfile

from scaling import PARTS, run_once

ROOT = pathlib.Path(__file__).resolve().parents[2]
DECKS = ["chapter7/pinned_ld2_nu025", "chapter7/friction_285_nu0495", "chapter7/dp_285"]


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
            command = [args.sagefe, "run", str(deck), "-o", folder]
            run_once(command)  # warm-up
            runs = [run_once(command) for _ in range(args.n)]
            walls = [1e3 * times["wall"] for times, _, _ in runs]
            parts = {p: 1e3 * statistics.median(times.get(p, 0.0) for times, _, _ in runs) for p in PARTS}
            wall = statistics.median(walls)
            print(
                f"| {deck.parent.name} | {wall:.1f} ({min(walls):.1f}-{max(walls):.1f}) | {max(mb for _, mb, _ in runs):.1f} | "
                + " | ".join(f"{parts[p]:.2f}" for p in PARTS)
                + f" | {wall - parts['whole run']:.1f} |"
            )


if __name__ == "__main__":
    main()
