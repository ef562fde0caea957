#!/usr/bin/env python3
"""Run time against error and against size, other programs, and the effect of optimisations: one command, CSV, Markdown and plots.

Usage: bench.py SAGEFE [-o FOLDER] [--only TABLE,...] [--runs N] [--largest N] [--threads N] [--no-peers]
       bench.py SAGEFE --quick        a few seconds, the smallest meshes, to see that everything works
       bench.py SAGEFE --check        name the ratios that moved by more than 15 % from docs/benchmarks; exit code 1 if any did
       bench.py SAGEFE --page         write the page again from the kept tables; measure nothing

All tables take about 20 minutes.  With --only the others stay as they are: every table is kept in FOLDER/benchmarks/tables.json
with its texts, options and date, and FOLDER/benchmarks.md is written from there.

Times are those of whole processes, medians of several runs; programs take turns on each scene and mesh, and ratios are between medians of the same
command.  CalculiX, FreeFEM and dolfinx take part where they are installed.  Nothing here passes or fails on a clock; a wrong
answer does fail: sagefe must come near each reference with one of its elements, and a peer with the same mesh and law must agree.
"""
import argparse
import csv
import dataclasses
import json
import pathlib
import re
import sys
import tempfile
import textwrap
import time
import traceback

import check
import general
import growth
import head
import measure
import nonlinear
import peers
import pictures
import precision
import same_mesh
import scenes
import shipped
import work

# In the order of the page: what --only takes, and what measures it.  Each gives {key: Table} and may draw charts.
PARTS = {
    "goals": shipped.goals,
    "linear": same_mesh.linear,
    "general": general.general,
    "plastic": same_mesh.plastic,
    "precision": precision.precision,
    "graded": precision.graded,
    "collapse": nonlinear.collapse,
    "safety": nonlinear.safety,
    "moment": nonlinear.moment,
    "ratio": nonlinear.ratio,
    "history": nonlinear.history,
    "solvers": precision.solvers,
    "scaling": growth.scaling,
    "interface": growth.interface,
    "footing": growth.footing,
    "assembly": work.assembly,
    "work": work.work,
    "skips": shipped.skips,
}
# The table behind which charts stand that are drawn from another file.
BESIDE = {"equal_error": "precision"}
ORDER = [key for part in PARTS for key in (("equal_mesh", "equal_error") if part == "precision" else (part,))]


class Bench:
    """What every part works with, and what it leaves behind besides its tables."""

    def __init__(self, args, folder, out):
        self.args, self.folder, self.out = args, folder, out
        self.sagefe = str(pathlib.Path(args.sagefe).resolve())
        self.notes = []  # what was not computed
        self.wrong = []  # answers that can't be
        self.points = []  # of time against error

    def turns(self, jobs, runs=None, strict=False):
        return measure.turns(jobs, self.folder, self.args.runs if runs is None else runs, self.args.threads, None if strict else self.notes)

    def threads(self):
        return ["--threads", str(self.args.threads)]


def with_threads(options, threads, runs):
    """runs: how many, or words where they are not the same for all rows."""
    words = f"Each time is the median of {runs} runs." if isinstance(runs, int) else runs
    if "--threads N" not in options:
        return f"{options} {words}"
    every = "one thread" if threads == 1 else f"{threads} threads"
    return f"{options.replace('--threads N', f'--threads {threads}')} All programs and their libraries use {every}. {words}"


def run_parts(bench, names, keep):
    """{key: what tables.json keeps of a table}.  keep: called with those of each part; a part that fails costs no other one."""
    found = {}
    peak = measure.dgemm(bench.args.threads)
    bench.dgemm = peak
    date, commit = time.strftime("%Y-%m-%d"), measure.commit()
    for name in names:
        start = time.perf_counter()
        bench.notes = []
        try:
            tables = PARTS[name](bench)
        except Exception as error:
            traceback.print_exc()
            bench.wrong.append(f"{name}: {error}")
            continue
        for key, table in tables.items():
            found[key] = dataclasses.asdict(table)
            options = with_threads(table.options, bench.args.threads, table.runs or bench.args.runs)
            found[key].update(part=name, options=options, notes=[], charts=[], machine=measure.machine(), dgemm=peak, date=date, commit=commit)
        found[list(tables)[-1]]["notes"] = bench.notes
        keep({key: found[key] for key in tables})
        print(f"  {name}: {time.perf_counter() - start:.0f} s", file=sys.stderr, flush=True)
    return found


def prose(words):
    """In lines of 100 columns; code in `...` is not broken, and a list item goes on below its text."""
    whole = re.sub(r"`[^`]*`", lambda code: code.group().replace(" ", "\0"), words)
    indent = " " * len(re.match(r"( *- )?", words).group())
    return textwrap.fill(whole, 100, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False).replace("\0", " ")


INTRODUCTION = (
    "This page compares the run time and the error of sagefe with those of CalculiX, FreeFEM and dolfinx. It also shows how the run time of sagefe depends on the error, on the size of the problem and on the optimisations. "
    "[What bounds the run time](theory/speed.md) explains some of the times.\n"
    "\n"
    "The script `scripts/bench` measures all numbers and writes this page."
)
MEASURED = (
    "*Wall time* is elapsed time. *Processor time* is the sum over all threads of a process. Unless a table states otherwise, both include the whole process: start, input, computation and output. "
    "The programs of a table run alternately, after one run of each that is not counted. Each time is the median of several such runs, or of fewer runs if one takes more than three seconds. "
    "A ratio of two times divides medians that were measured in the same call of `scripts/bench`. On another machine the times differ, so use the ratios for comparisons."
)
AIMS = "Each measured value is a cell, or the range of the cells, of a table below. A goal is reached if all these cells reach it."
ELEMENTS = (
    "Names of elements and formulations are those of sagefe ([elements](theory/elements.md)). `quad25` and `quad49` are quadrilaterals of degree 4 and 6. "
    "`CAX4`, `CAX8` and `CAX8R` are quadrilaterals of CalculiX with 4 and 8 nodes in axisymmetry, `CPE4`, `CPE8` and `CPE8R` those in plane strain; R is reduced integration. "
    "`P1` and `P2` are triangles of FreeFEM of degree 1 and 2, with two triangles for each quadrilateral of sagefe. `Q1`, `Q2`, `Q4` and `Q6` are quadrilaterals of dolfinx of degree 1, 2, 4 and 6."
)


def header(kept, versions, overview):
    text = ["# Benchmarks: run time against error", "", *map(prose, head.sources(kept)), ""]
    text += [line for words in head.sentences(kept) for line in (prose(f"- {words}"),)] + [""]
    text += [f"![{title}](benchmarks/{name})" for title, name in overview] + [""] * bool(overview)
    text += [*(line for part in INTRODUCTION.split("\n\n") for line in (prose(part), "")), "## How the times were measured", "", prose(MEASURED), ""]
    for name in ("CalculiX", "FreeFEM", "dolfinx"):
        text.append(f"- {name}: {versions[name] if name in versions else 'not installed, so its columns are empty'}")
    text.append(prose("- CalculiX has no Tresca law. It computes the strip footings with the law of von Mises, which has the same collapse load in plane strain. It computes them only on the coarsest mesh."))
    text.append(prose("- FreeFEM has no law of plasticity, so it computes no footings."))
    text += ["", "## Problems, decks and elements", "", prose(scenes.WHAT_IS_COMPARED), "", scenes.problems(), prose(shipped.WHAT_DECKS_ARE), "", shipped.decks(), prose(ELEMENTS), ""]
    return text


def page(kept, versions, overview):
    text = header(kept, versions, overview)
    for key in ORDER:
        if key not in kept:
            continue
        table = kept[key]
        recorded = f" Recorded {table['date']}." if "date" in table else ""
        text += [f"## {table['title']}", "", *(line for part in table["note"].split("\n\n") for line in (*map(prose, part.split("\n")), "")), prose(f"Options: {table['options']}{recorded}"), ""]
        text += [measure.markdown(table["head"], table["rows"])]
        text += [f"![{title}](benchmarks/{name})" for title, name in table["charts"]] + [""] * bool(table["charts"])
        if key == "goals" and head.aims(kept):
            text += ["## Goals of each kind of work", "", prose(AIMS), "", measure.markdown(["work", "measured", "goal", "reached"], head.aims(kept))]
        if table["notes"]:
            text += ["Not computed:", "", *(prose(f"- {note}") for note in table["notes"]), ""]
    return "\n".join(text).rstrip() + "\n"


def write(out, found, versions):
    folder = out / "benchmarks"
    file = folder / "tables.json"
    kept = json.loads(file.read_text()) if file.exists() else {}
    kept.setdefault("tables", {}).update(found)
    kept["versions"] = {**kept.get("versions", {}), **versions}
    for key, table in found.items():
        with open(folder / f"{key}.csv", "w", newline="") as stream:
            csv.writer(stream).writerows([table["head"], *table["rows"]])
    drawn = pictures.draw(folder, folder)
    for key, table in kept["tables"].items():
        table["charts"] = drawn.get(BESIDE.get(key, key), [])
    file.write_text(json.dumps(kept, indent=1) + "\n")
    (out / "benchmarks.md").write_text(page(kept["tables"], kept["versions"], drawn.get("overview", [])))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sagefe")
    parser.add_argument("-o", "--output", default="out/benchmarks", help="folder for benchmarks.md and, below it, benchmarks/")
    parser.add_argument("--only", "--parts", default=",".join(PARTS), help="parts, with commas: " + ",".join(PARTS))
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--sizes", type=int, default=5, help="meshes of every scene, from the coarsest")
    parser.add_argument("--largest", type=int, default=448, help="largest n of the n x 2n specimens")
    parser.add_argument("--threads", type=int, default=1, help="of every program")
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--check", action="store_true", help="compare every ratio with that of --kept; exit code 1 if one moved by more than 15 %%")
    parser.add_argument("--kept", type=pathlib.Path, default=scenes.ROOT / "docs/benchmarks/tables.json", help="tables for --check")
    parser.add_argument("--page", action="store_true", help="write page and charts from the kept tables; measure nothing")
    args = parser.parse_args()
    if args.check and (pathlib.Path(args.output) / "benchmarks").resolve() == args.kept.resolve().parent:
        parser.error("--check would overwrite the tables with which it compares: give another folder with -o")
    if args.quick:
        args.runs, args.sizes, args.largest, args.no_peers = 1, 1, 28, True
    args.only = args.only.split(",")
    unknown = [name for name in args.only if name not in PARTS]
    if unknown:
        parser.error(f"no part {', '.join(unknown)}: there are {', '.join(PARTS)}")
    return args


def report_moved(kept, found):
    """Prints the ratios that moved; True if there are none, and something was compared."""
    count, moved = check.compare(json.loads(kept.read_text())["tables"], found)
    for one in moved:
        print(one)
    print(f"{count} ratios compared with {kept}: {len(moved)} moved by more than {check.MOVED:.0%}")
    return count > 0 and not moved


def main():
    args = arguments()
    if args.quick:
        check.self_test()
    if args.no_peers:
        peers.CCX = peers.FREEFEM = peers.DOLFINX = None
    out = pathlib.Path(args.output)
    (out / "benchmarks").mkdir(parents=True, exist_ok=True)
    if args.page:
        write(out, {}, {})
        return
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(args, pathlib.Path(name), out / "benchmarks")
        versions = peers.versions()
        found = run_parts(bench, [part for part in PARTS if part in args.only], lambda tables: write(out, tables, versions))
    print(f"{out / 'benchmarks.md'}: {len(found)} tables")
    notes = [note for table in found.values() for note in table["notes"]]
    if bench.wrong or (args.quick and notes):
        raise SystemExit("\n".join(["wrong:", *bench.wrong, *notes]))
    if args.check and not report_moved(args.kept, found):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
