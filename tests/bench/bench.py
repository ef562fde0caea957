#!/usr/bin/env python3
"""Run time against error, peers, scaling and what the program leaves out: one command, CSV, Markdown and plots.

Usage: bench.py SAGEFE [-o FOLDER] [--parts precision,solvers,scaling,skips,goals] [--runs N] [--largest N] [--no-peers]
       bench.py SAGEFE --quick        a few seconds, the smallest meshes, to see that everything works

Times are those of whole processes, medians of several runs; programs take turns on each scene and mesh, and ratios are between medians of the same
command.  CalculiX and FreeFEM take part where they are installed.  Nothing here passes or fails on a clock; a wrong
answer does fail: sagefe must come near each reference with one of its elements.
"""
import argparse
import csv
import dataclasses
import math
import os
import pathlib
import platform
import random
import re
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import chart
import peers
import scaling
import scenes

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIME_LIMIT = 300  # seconds of one job
LONG = 3.0  # seconds: longer jobs are run twice less often


@dataclasses.dataclass
class Point:
    scene: str
    program: str
    variant: str
    mesh: str
    value: float
    error: float
    seconds: float
    fastest: float
    slowest: float
    megabytes: float
    runs: int


def once(command, folder):
    start = time.perf_counter()
    with open(folder / "stdout", "w+b") as out:
        process = subprocess.Popen(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT)
        alarm = threading.Timer(TIME_LIMIT, process.kill)
        alarm.start()
        _, status, usage = os.wait4(process.pid, 0)
        alarm.cancel()
        process.returncode = status
        wall = time.perf_counter() - start
        out.seek(0)
        text = out.read().decode(errors="replace")
    if status != 0:
        raise ValueError(f"exit status {os.waitstatus_to_exitcode(status)}: {text[-400:]}")
    return wall, usage.ru_maxrss / 1024.0, text


class Bench:
    def __init__(self, args, folder):
        self.args, self.folder = args, folder
        self.sagefe = str(pathlib.Path(args.sagefe).resolve())
        (folder / "wide.toml").write_text(scenes.wide_layout())
        self.points, self.notes = [], []

    def measure(self, jobs):
        """jobs: [(labels, command, find)] take turns.  One run to warm up gives the answer."""
        live, records = [], {}
        for labels, command, find in jobs:
            try:
                wall, mb, text = once(command, self.folder)
                records[labels] = dict(value=find(text), walls=[], mb=mb, first=wall)
                live.append((labels, command))
            except ValueError as problem:
                self.notes.append(f"{', '.join(labels[:4])}: {problem}".splitlines()[0][:160])
        for k in range(self.args.runs):
            random.Random(k).shuffle(live)  # who comes after a large program finds its caches cold
            for labels, command in live:
                record = records[labels]
                if record["first"] > LONG and k >= max(1, self.args.runs // 3):
                    continue
                wall, mb, _ = once(command, self.folder)
                record["walls"].append(wall)
                record["mb"] = max(record["mb"], mb)
        return records

    def add(self, scene, records):
        for (name, program, variant, mesh), r in records.items():
            walls = r["walls"]
            error = abs(r["value"] / scene.reference - 1)
            self.points.append(
                Point(name, program, variant, mesh, r["value"], error, statistics.median(walls), min(walls), max(walls), r["mb"], len(walls))
            )

    def sage_job(self, scene, variant, mesh, deck, options):
        stem = re.sub(r"\W+", "_", f"{scene.name}_{variant}_{mesh}")
        path = self.folder / f"{stem}.dat"
        text, layout = deck
        path.write_text(text)
        command = [self.sagefe, "run", "--layout", layout, "-o", "out", "--no-listing", path.name, *options]

        def find(_):
            with open(self.folder / "out" / f"{stem}.report1.csv") as table:
                rows = list(csv.DictReader(row for row in table if not row.startswith("#")))
            column = next(c for c in rows[-1] if c.split("[")[0] == scene.column)
            return scene.answer(float(rows[-1][column]))

        return (scene.name, "sagefe", variant, mesh), command, find

    # ------------------------------------------------------------------------------------- (a), (b)

    def plain(self, scene, n):
        """Elements of low degree on the mesh n."""
        variants = [
            ("quad4 full", "quad", ["--formulation", "1"]),
            ("quad4 b-bar", "quad", ["--formulation", "2"]),
            ("quad8 reduced", "quad", ["--element", "quad8", "--formulation", "1"]),
            ("quad8 full", "quad", ["--element", "quad8", "--formulation", "2"]),
            ("quad9", "quad", ["--element", "quad9"]),
            ("tri6", "tri6", []),
        ]
        return [self.sage_job(scene, name, str(n), scenes.deck(scene, n, kind), options) for name, kind, options in variants]

    def high(self, scene, k):
        """High degrees on a few elements: graded to the singular corner, or finer where there is none."""
        graded = scene.data.get("grade")
        n = (1 if scene.data["family"] == "pinned" else 4) if graded else 2**k
        layers = 2 + 2 * k
        jobs = []
        for name in ("quad25", "quad49"):
            options = ["--element", name]
            if graded:
                options += ["--grade", f"{graded}:{layers}:0.15"]
            mesh = f"{n}, {layers} layers" if graded else str(n)
            jobs.append(self.sage_job(scene, name + (" graded" if graded else ""), mesh, scenes.deck(scene, n), options))
        return jobs

    def peer_jobs(self, scene, n):
        jobs = []
        if self.args.no_peers:
            return jobs
        if peers.CCX and peers.ccx_can(scene) and not (scene.data["family"] == "footing" and n > 4):
            for element, quadratic in peers.ccx_elements(scene):
                command, find = peers.ccx_job(scene, n, element, quadratic, self.folder)
                jobs.append(((scene.name, "CalculiX", element, str(n)), command, find))
        if peers.FREEFEM and peers.freefem_can(scene):
            for space in ("P1", "P2"):
                command, find = peers.freefem_job(scene, n, space, self.folder)
                jobs.append(((scene.name, "FreeFEM", space, str(n)), command, find))
        return jobs

    def precision(self):
        for scene in scenes.scenes():
            for n in scene.sizes[: self.args.sizes]:
                self.add(scene, self.measure(self.plain(scene, n) + self.peer_jobs(scene, n)))
            if scene.data["family"] != "footing":
                for k in range(1 if self.args.quick else 4):
                    self.add(scene, self.measure(self.high(scene, k)))
            print(f"  {scene.name}", file=sys.stderr, flush=True)

    def solver_rows(self):
        """Every solver on the same scene, quad8 reduced."""
        scene = scenes.scenes()[3]
        text = subprocess.run([self.sagefe, "list", "solvers"], capture_output=True, text=True, check=True).stdout
        names = re.findall(r"^\s*\d+\s+(\w+) \(", text, re.M)
        sizes = scene.sizes[: self.args.sizes]
        rows, before = [], len(self.points)
        for n in sizes:
            jobs = [
                self.sage_job(scene, f"quad8 {name}", str(n), scenes.deck(scene, n), ["--element", "quad8", "--formulation", "1", "--solver", name])
                for name in names
            ]
            self.add(scene, self.measure(jobs))
        for n in sizes:
            found = {p.variant: p for p in self.points[before:] if p.mesh == str(n)}
            rows.append([str(n), *(f"{1e3 * found[f'quad8 {s}'].seconds:.1f}" if f"quad8 {s}" in found else "-" for s in names)])
        self.solver_points = self.points[before:]
        del self.points[before:]
        return ["n", *(f"{s} ms" for s in names)], rows

    # ------------------------------------------------------------------------------------- (c)

    def scaling_rows(self):
        sizes = [n for n in (14, 28, 56, 112, 224, 448, 700) if n <= self.args.largest]
        (self.folder / "wide5.toml").write_text(scaling.wide_layout())
        columns = ["wall", *scaling.PARTS, "rest", "MB"]
        medians = []
        for n in sizes:
            path = self.folder / f"cylinder_{n}.dat"
            path.write_text(scaling.deck(n))
            command = [self.sagefe, "run", "--layout", str(self.folder / "wide5.toml"), "-o", str(self.folder / "out"), str(path)]
            runs = [scaling.run_once(command) for _ in range(3 if n > 100 else max(1, self.args.runs))]
            m = {c: statistics.median(r[0].get(c, 0.0) for r in runs) for c in ("wall", *scaling.PARTS)}
            m["rest"] = m["wall"] - sum(m[p] for p in scaling.PARTS if p != "whole run")
            m["MB"] = max(r[1] for r in runs)
            medians.append((n, m))
        rows = [[str(n), str(2 * (n + 1) * (2 * n + 1)), *(f"{m[c]:.4g}" for c in columns)] for n, m in medians]
        # Least squares over the larger half, where the start of the process no longer counts.
        fit = [(n, m) for n, m in medians if n >= 56] or medians
        if len(fit) > 1:
            rows.append(["exponent", "", *(exponent([(n, m[c]) for n, m in fit]) for c in columns)])
        self.scaling = medians
        names = {"factor": "factorise", "numbering": "number, analyse", "assembly": "assemble", "rest": "read, start, end"}
        return ["n", "dofs", *(c if c == "MB" else f"{names.get(c, c)} s" for c in columns)], rows

    # ------------------------------------------------------------------------------------- (d)

    def skip_rows(self):
        rows = []
        text = subprocess.run([self.sagefe, "run", "--help"], capture_output=True, text=True, check=True).stdout
        names = re.search(r"--without TEXT:\{([\w,]+)\}", text).group(1).split(",")
        names.sort(key=lambda name: name == "all")
        decks = ("friction_285_nu0495", "dp_285", "pinned_ld2_nu025")
        for deck in decks[-1:] if self.args.quick else decks:
            path = ROOT / "legacy_inputs/chapter7" / deck / "deck.dat"
            jobs = []
            for name in ["", *names]:
                options = ["--without", name] if name else []
                command = [self.sagefe, "run", "-o", "out", str(path), *options]
                jobs.append(((deck, "sagefe", name, ""), command, lambda text: text))
            records = self.measure(jobs)
            full = statistics.median(records[(deck, "sagefe", "", "")]["walls"])
            for (_, _, name, _), r in records.items():
                wall = statistics.median(r["walls"])
                work = re.search(r"work\s+(.*)", r["value"]).group(1)
                counts = re.sub(r" [\d.e+-]+ s(?=,|$)", "", work)
                left = re.search(r"left out\s+(.*)", r["value"])
                rows.append([deck, name or "(nothing off)", f"{1e3 * wall:.1f}", f"{wall / full:.2f}", counts, left.group(1) if left else "-"])
        return ["deck", "switched off", "ms", "ratio", "work", "left out"], rows

    # ------------------------------------------------------------------------------------- what is asked for

    def goal_rows(self):
        rows = []

        def deck(name, asked, best=None):
            path = ROOT / "legacy_inputs/chapter7" / name / "deck.dat"
            options = [] if best is None else ["--no-listing"]
            walls = [once([self.sagefe, "run", "-o", "out", str(path), *options], self.folder)[0] for _ in range(1 if self.args.quick else 2 * self.args.runs + 1)]
            rows.append([f"{name}, whole process", f"{1e3 * statistics.median(walls):.1f} ms ({1e3 * min(walls):.1f}-{1e3 * max(walls):.1f})", asked])

        deck("pinned_ld2_nu025", "")
        deck("pinned_ld2_nu0495_graded", "50 ms at an error of 1e-4")
        deck("pinned_ld2_nu0495_accurate", "500 ms at an error of 1e-6")
        deck("friction_285_nu0495", "30 ms")
        deck("dp_285", "100 ms")
        return ["what", "median (min-max)", "asked"], rows

    # ------------------------------------------------------------------------------------- tables

    def find(self, scene, program, variant, mesh):
        return next((p for p in self.points if (p.scene, p.program, p.variant, p.mesh) == (scene, program, variant, mesh)), None)

    def equal_mesh_rows(self):
        pairs = [("quad4 full", ("CAX4", "CPE4"), "P1"), ("quad8 reduced", ("CAX8R", "CPE8R"), "P2"), ("quad8 full", ("CAX8", "CPE8"), "P2")]
        rows = []
        for scene in scenes.scenes():
            for own, theirs, space in pairs:
                for n in map(str, scene.sizes):
                    mine = self.find(scene.name, "sagefe", own, n)
                    ccx = next((p for e in theirs if (p := self.find(scene.name, "CalculiX", e, n))), None)
                    ff = self.find(scene.name, "FreeFEM", space, n)
                    if not mine or not (ccx or ff):
                        continue
                    row = [scene.name, own, n, f"{1e3 * mine.seconds:.1f}", f"{mine.error:.1e}"]
                    for p in (ccx, ff):
                        row += [f"{p.variant} {1e3 * p.seconds:.0f}", f"{p.seconds / mine.seconds:.1f}", f"{p.error:.1e}"] if p else ["-"] * 3
                    rows.append(row)
        head = ["scene", "element", "n", "sagefe ms", "error", "CalculiX ms", "ratio", "error", "FreeFEM ms", "ratio", "error"]
        return head, rows

    def equal_error_rows(self):
        rows = []
        for scene in scenes.scenes():
            for target in (3e-2, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
                best = {}
                for p in self.points:
                    if p.scene == scene.name and p.error <= target and (p.program not in best or p.seconds < best[p.program].seconds):
                        best[p.program] = p
                if "sagefe" not in best:
                    continue
                mine = best["sagefe"]
                row = [scene.name, f"{target:g}", f"{1e3 * mine.seconds:.1f}", f"{mine.variant}, {mine.mesh}"]
                for program in ("CalculiX", "FreeFEM"):
                    p = best.get(program)
                    if p:
                        row += [f"{1e3 * p.seconds:.0f} ({p.variant}, {p.mesh})", f"{p.seconds / mine.seconds:.1f}"]
                    else:
                        tried = [q for q in self.points if q.scene == scene.name and q.program == program]
                        most = max(tried, key=lambda q: q.seconds, default=None)
                        row += [f"not reached in {1e3 * most.seconds:.0f}" if most else "-", f"> {most.seconds / mine.seconds:.0f}" if most else "-"]
                rows.append(row)
        return ["scene", "error <=", "sagefe ms", "with", "CalculiX ms", "ratio", "FreeFEM ms", "ratio"], rows

    def wrong(self):
        """Scenes that no element of a program comes near: a broken deck or script, not a slow machine."""
        found = []
        for scene in scenes.scenes():
            footing = scene.data["family"] == "footing"
            errors = [p.error for p in self.points if p.scene == scene.name and p.program == "sagefe"]
            bound = 0.15 if footing else 2e-3  # what the coarsest meshes reach
            if errors and not min(errors) <= bound:
                found.append(f"{scene.name}: the best is {min(errors):.1e} off, expected {bound:g}")
        return found

    def plots(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        made = []
        for scene in scenes.scenes():
            lines = {}
            for p in self.points:
                if p.scene == scene.name:
                    lines.setdefault((p.program, p.variant), []).append((p.seconds, p.error))
            series = [(v if program == "sagefe" else f"{program} {v}", sorted(points), program != "sagefe") for (program, v), points in lines.items()]
            name = f"{scene.name}.svg"
            if chart.loglog(folder / name, f"{scene.title}: reference {scene.reference:.7g}", "whole process, s", "relative error", series):
                made.append((scene.title, name))
        if getattr(self, "scaling", None) and len(self.scaling) > 1:
            parts = ("wall", "assembly", "numbering", "factor", "solve", "output", "rest")
            series = [(part, [(n, m[part]) for n, m in self.scaling], False) for part in parts]
            chart.loglog(folder / "scaling.svg", "n x 2n quad4, elastic cylinder", "n", "s", series)
            made.append(("Scaling", "scaling.svg"))
        return made


def exponent(points):
    points = [(math.log(x), math.log(y)) for x, y in points if y > 0]
    if len(points) < 2:
        return "-"
    mx, my = (statistics.mean(p[k] for p in points) for k in (0, 1))
    return f"{sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points):.2f}"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|---" * len(head) + "|", *("| " + " | ".join(r) + " |" for r in rows), ""])


def write_csv(path, head, rows):
    with open(path, "w", newline="") as out:
        csv.writer(out).writerows([head, *rows])


def machine():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    memory = re.search(r"MemTotal:\s+(\d+)", pathlib.Path("/proc/meminfo").read_text())
    system = platform.freedesktop_os_release().get("PRETTY_NAME", "Linux")
    return f"{os.cpu_count()} x {model.group(1) if model else platform.machine()}, {int(memory.group(1)) / 2**20:.0f} GB, {system}"


EXPLAIN = {
    "goals": ("What is asked for", "`--no-listing` is not given: these are runs as users make them."),
    "equal_mesh": ("The same mesh", "Ratio: time of the peer over that of sagefe on the same cells (FreeFEM cuts each into two triangles)."),
    "equal_error": ("The same error", "The fastest run of each program within the error. Where a peer did not reach it the ratio is to its longest run: a lower bound."),
    "solvers": ("Solvers", "Pinned cylinder, L/D = 2, nu = .495, quad8 reduced, whole process."),
    "scaling": ("Scaling", "Pinned cylinder, n x 2n quad4, one increment. MB: largest memory of the process. Exponents of n by least squares from n = 56 on; 2 = in proportion to the equations."),
    "skips": ("What is left out", "`sagefe run --without NAME`; the results are the same, as `test_analysis` proves. Ratio: time over that with nothing switched off."),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sagefe")
    parser.add_argument("-o", "--output", default="out/benchmarks", help="folder for CSV files, benchmarks.md and plots")
    parser.add_argument("--parts", default="goals,precision,solvers,scaling,skips")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--sizes", type=int, default=5, help="meshes of every scene, from the coarsest")
    parser.add_argument("--largest", type=int, default=448, help="largest n of the scaling")
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--quick", action="store_true")
    args = parser.parse_args()
    if args.quick:
        args.runs, args.sizes, args.largest, args.no_peers = 1, 1, 28, True
    out = pathlib.Path(args.output)
    (out / "benchmarks").mkdir(parents=True, exist_ok=True)
    parts = args.parts.split(",")
    versions = {} if args.no_peers else peers.versions()
    text = ["# Benchmarks: run time against error", "", "Written by `scripts/bench` (`tests/bench/bench.py`)."]
    text += ["Whole processes, median of " + str(args.runs) + " runs; programs take turns, and ratios are between medians of one command. Only ratios carry over to other machines."]
    text += ["", f"- Machine: {machine()}"]
    for name in ("CalculiX", "FreeFEM"):
        text.append(f"- {name}: {versions[name] if name in versions else 'not there, left out'}")
    text += ["- CalculiX has no Tresca law: it computes the strip with von Mises, which has the same collapse load in plane strain, on the coarsest mesh only (longer than sagefe on all of them)."]
    text += ["- FreeFEM has no law of plasticity: no footings.", ""]
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(args, pathlib.Path(name))
        tables = {}
        if "goals" in parts:
            tables["goals"] = bench.goal_rows()
        if "precision" in parts:
            bench.precision()
            tables["equal_mesh"] = bench.equal_mesh_rows()
            tables["equal_error"] = bench.equal_error_rows()
        if "solvers" in parts:
            tables["solvers"] = bench.solver_rows()
        if "scaling" in parts:
            tables["scaling"] = bench.scaling_rows()
        if "skips" in parts:
            tables["skips"] = bench.skip_rows()
        plots = bench.plots(out / "benchmarks")
    fields = [f.name for f in dataclasses.fields(Point)]
    everything = bench.points + getattr(bench, "solver_points", [])
    write_csv(out / "benchmarks/precision.csv", fields, [dataclasses.astuple(p) for p in everything])
    for key, (head, rows) in tables.items():
        write_csv(out / "benchmarks" / f"{key}.csv", head, rows)
        if rows:
            title, note = EXPLAIN[key]
            text += [f"## {title}", "", note, "", table(head, rows)]
    if plots:
        text += ["## Time against error", "", "Dashed: other programs. All points: `benchmarks/precision.csv`.", ""]
        text += [f"![{title}](benchmarks/{name})" for title, name in plots] + [""]
    if bench.notes:
        text += ["## Not computed", "", *(f"- {note}" for note in bench.notes), ""]
    (out / "benchmarks.md").write_text("\n".join(text))
    print(f"{out / 'benchmarks.md'}: {len(everything)} points, {len(plots)} plots")
    wrong = bench.wrong()
    if wrong or (args.quick and (bench.notes or not everything)):
        raise SystemExit("\n".join(["wrong:", *wrong, *bench.notes]))


if __name__ == "__main__":
    main()
