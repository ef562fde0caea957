"""Time of each kind of work: points of laws, assembly on threads, free surfaces, walls, files for viewers, a factor of safety."""
import csv
import json
import os
import re
import shutil
import subprocess

import growth
import nonlinear
import specimen
import walls
from measure import Job, Table
from same_mesh import unknowns
from specimen import ROOT, card

# ------------------------------------------------------------------------------------------------- laws and elements

STEPS = 8
# Name of a law, its code and its parameters for the triaxial specimen.
LAWS = {
    "linear elastic": ("1", ("3000.", ".3")),
    "Drucker-Prager": ("3", ("3000.", ".3", "1.", "30.", "0.", "1.", "1.", "-1.")),
    "Mohr-Coulomb": ("4", ("3000.", ".3", "1.", "30.", "30.")),
    "UMAT, Drucker-Prager": ("100", ("4.", "0.", "0.", "1.", "3000.", ".3", "1.", "30.")),
}
ELEMENTS = {"quad4 b-bar": ["--formulation", "2"], "quad8 reduced": ["--element", "quad8", "--formulation", "1"], "quad9": ["--element", "quad9"]}


def specimen_of(law, n):
    """Between rough ends; nearly all increments are beyond yield."""
    code, parameters = LAWS[law]
    top = (n + 1) * 2 * n + 1
    material = [card(1, int(code), len(parameters)) + "          soil", card(*parameters[:8])]
    if len(parameters) > 8:
        material.append(card(*parameters[8:]))
    stage = [
        card(1, 0, "50.", "50.", "50."),
        "Axial compression",
        card(STEPS, 0, 0, 0, 1, 0, 1, 0, 0, 0),
        card(top, top + n, 1, 1, 1, "0.", "-0.2"),
        card(n, 2, 2 * n * n, n, "50.", "50."),
        card(1, 1, top, top + n, 1, 1, "2.8", "", "50."),
    ]
    return specimen.cards(n, law, material, stage, 1)


def umat(bench):
    """The library of the UMAT, or None without a compiler."""
    if not shutil.which("gfortran"):
        return None
    file = bench.folder / "umat_of_bench.so"
    if not file.exists():
        source = ROOT / "tests/umat/drucker_prager.f"
        include = next(ROOT.glob("sage/**/ABA_PARAM.INC")).parent
        subprocess.run(["gfortran", "-shared", "-fPIC", "-O2", "-I", include, "-o", file, source], check=True, capture_output=True)
    return str(file)


def profiled(bench, job, runs, threads):
    """(seconds in assembly: the least of some runs, passes over the elements, integration points)"""
    least, text = None, ""
    for _ in range(runs):
        at = job.command.index("--threads")
        command = [*job.command[: at + 1], str(threads), *job.command[at + 2 :]]
        phases = growth.profile(bench, Job(job.labels, [*command, "-v"], job.find))
        seconds = growth.seconds(phases, "assembly")
        least = seconds if least is None else min(least, seconds)
    text = (bench.folder / "stdout").read_text(errors="replace")
    assemblies, forces = (int(re.search(rf"(\d+) {word}", text).group(1)) for word in ("assemblies", "force passes"))
    points = int(re.search(r"(\d+) points", text).group(1))
    return least, assemblies + forces, points


ASSEMBLY_TITLE = "Assembly by law, element and threads"
ASSEMBLY_NOTE = (
    f"A triaxial specimen of n x 2n elements between rough ends, compressed in {STEPS} increments far beyond yield, and models of seepage and walls. The times are those of the phase *assembly* of `sagefe run --profile`, the least of several runs. "
    "A *pass* evaluates all elements once, with or without the stiffness matrix. *us per point* is the time on one thread divided by passes and integration points, and so includes the element. The linear elastic law runs with `--without all`, so it is evaluated in each pass too. "
    "Points that do not yield in a pass cost less, so this is a mean. The UMAT is compiled from `tests/umat/drucker_prager.f` and safe for threads. The last column divides the times on one and on two threads."
)
ASSEMBLY_HEAD = ["case", "element", "points", "passes", "assembly s, one thread", "us per point", "assembly s, two threads", "one thread over two"]


def cases(bench):
    """(case, element, job)"""
    (bench.folder / "specimen.toml").write_text(specimen.wide_layout())
    library = umat(bench)
    common = ["--layout", "specimen.toml", "-o", "out", "--threads", "1"]
    for element, options in list(ELEMENTS.items())[: 1 if bench.args.quick else None]:
        for law in LAWS:
            if law.startswith("UMAT") and not library:
                bench.notes.append("UMAT: gfortran is not installed")
                continue
            stem = re.sub(r"\W+", "_", f"assembly_{law}_{element}")
            n = 6 if bench.args.quick else 28 if element.startswith("quad4") else 20  # above the limit for threads
            (bench.folder / f"{stem}.dat").write_text(specimen_of(law, n))
            more = ["--umat", library] if law.startswith("UMAT") else ["--without", "all"] if law.startswith("linear") else []
            yield law, element, Job((stem,), [bench.sagefe, "run", f"{stem}.dat", *common, *options, *more], lambda text: 0.0)
    columns = 14 if bench.args.quick else 56
    (bench.folder / "assembly_dam.dat").write_text(dam(columns, 2 * columns))
    yield "seepage with a free surface", "quad4", Job(("dam",), [bench.sagefe, "run", "assembly_dam.dat", *common], lambda text: 0.0)
    if not bench.args.quick:
        (bench.folder / "assembly_walls.dat").write_text(walls.deck(True, 3, walls.UNYIELDING))
        yield "walls in Mohr-Coulomb soil", "quad4 full", Job(("walls",), [bench.sagefe, "run", "assembly_walls.dat", "-o", "out", "--threads", "1"], lambda text: 0.0)


def assembly(bench):
    rows = []
    runs = max(1, bench.args.runs)
    for case, element, job in cases(bench):
        one, passes, points = profiled(bench, job, runs, 1)
        two = profiled(bench, job, runs, 2)[0] if (os.cpu_count() or 1) > 1 else None
        us = 1e6 * one / passes / points
        row = [case, element, str(points), str(passes), f"{one:.4g}", f"{us:.3f}"]
        rows.append(row + ([f"{two:.4g}", f"{one / two:.2f}"] if two else ["-", "-"]))
    return {"assembly": Table(ASSEMBLY_TITLE, ASSEMBLY_NOTE, "`sagefe run --threads 1|2 --profile`, with `--without all` for the linear elastic law.", ASSEMBLY_HEAD, rows, "Each time is the least of several runs.")}


# ------------------------------------------------------------------------------------------------- whole runs


def dam(columns, rows):
    """legacy_inputs/seepage/dam with other numbers of elements: vertical faces, 7 m high and long, water 7 and 2 m high."""
    across = columns + 1
    top, last, water = across * rows + 1, across * (rows + 1), rows * 2 // 7
    head = lambda *fields: card(*fields, "") + "head"
    return "\n".join(
        [
            f"Dam of {columns} x {rows} elements",
            "m       kN      kPa        101.325      9.81",
            card(1, 0, 4, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0),
            *(card(node, 0, 0, x, y) for node, x, y in ((1, "0.", "0."), (across, "7.", "0."), (top, "0.", "7."), (last, "7.", "7."))),
            card(1, columns, 1, rows, across),
            card(1, 42, 1) + "          dam",
            card("1.E-3"),
            card(1, 41, 0, 1) + "dam",
            card(1, 1, 1, 2, across + 2, across + 1, 0, 0, 0, 0, columns, rows, 1, across),
            "seepage",
            card(1, 0, 0, 0, 3, 0, 0, 0, 0, 0, "0.", "0.", "0."),
            head(1, top, across, 1, 0, "7."),
            head(across, across * (water + 1), across, 1, 0, "2."),
            head(across * (water + 2), last, across, 2, 0, "0."),
            card(4, 0, across, last, across, 1),
            "END",
            "",
        ]
    )


DUPUIT = 1e-3 * (7.0**2 - 2.0**2) / (2 * 7.0)  # discharge, exact for this dam (Charny 1951)


def dam_job(bench, columns):
    stem = f"dam_{columns}"
    (bench.folder / "specimen.toml").write_text(specimen.wide_layout())
    (bench.folder / f"{stem}.dat").write_text(dam(columns, 2 * columns))

    def find(_):
        with open(bench.folder / "out" / f"{stem}.report1.csv") as table:
            rows = list(csv.DictReader(line for line in table if not line.startswith("#")))
        return float(next(value for name, value in rows[-1].items() if name.startswith("discharge")))

    return Job((stem,), [bench.sagefe, "run", "--layout", "specimen.toml", "-o", "out", f"{stem}.dat"], find)


WORK_TITLE = "Time of each kind of work"
WORK_NOTE = (
    "Whole runs, with the threads that sagefe chooses.\n\n"
    "- *free surface*: the dam of [seepage](theory/seepage.md) with n x 2n quad4; its discharge is within 1 % of the exact one, otherwise the benchmark fails.\n"
    "- *walls*: 200 x 100 quad4 with three walls in Mohr-Coulomb soil that does not yield (`tests/bench/walls.py`). The ratio divides the times of one iteration with and without the walls: the least time of the phase *iteration* of several runs with `--profile`.\n"
    "- *viewer file*: the linear specimen with 224 x 448 quad4 without listing, with no file for viewers, with `--vtu` and with `--msh`.\n"
    "- *factor of safety*: `sagefe safety` of decks of [`legacy_inputs/slopes`](../legacy_inputs/slopes/README.md); the bracket contains or exceeds the log-spiral by at most 2 %, otherwise the benchmark fails."
)
WORK_HEAD = ["work", "wall s", "processor s", "MB", "result", "ratio"]
SLOPES = {"one_to_one": nonlinear.SPIRAL, "griffiths_lane": 1.36821452}  # log-spirals


def work_row(name, record, result, ratio="-"):
    return [name, f"{record.wall:.3g}", f"{record.cpu:.3g}", f"{record.mb:.0f}", result, ratio]


def free_surfaces(bench):
    for columns in (14,) if bench.args.quick else [n for n in (112, 224, 448) if n <= bench.args.largest] or [28]:
        record = bench.turns([dam_job(bench, columns)], 0 if columns > 112 else 1, strict=True)[(f"dam_{columns}",)]
        if not abs(record.value / DUPUIT - 1) < 0.01:
            bench.wrong.append(f"free surface, n = {columns}: discharge {record.value:g}, exact {DUPUIT:g}")
        yield work_row(f"free surface, {unknowns(record.text)} heads", record, f"discharge {record.value:.5g} m3/s, error {abs(record.value / DUPUIT - 1):.1e}")


def iteration_seconds(bench, job):
    """Of the phase `iteration` and all below it."""
    growth.profile(bench, job)
    run = json.loads(next((bench.folder / "out").glob("*.profile.json")).read_text())["run"]
    below = lambda phase: phase["seconds"] if phase["phase"] == "iteration" else sum(map(below, phase.get("phases", [])))
    return below(run)


def wall_rows(bench):
    jobs = []
    for name, with_walls in (("without", False), ("with", True)):
        (bench.folder / f"walls_{name}.dat").write_text(walls.deck(with_walls, 3, walls.UNYIELDING))
        jobs.append(Job((name,), [bench.sagefe, "run", f"walls_{name}.dat", "-o", "out", "--threads", "1"], lambda text: int(re.search(r"(\d+) iterations", text).group(1))))
    records = bench.turns(jobs, strict=True)
    least = {name: min(iteration_seconds(bench, job) for _ in range(2 * bench.args.runs + 1)) for name, job in zip(("without", "with"), jobs)}
    each = {name: least[name] / records[(name,)].value for name in least}
    for name in each:
        yield work_row(f"walls: soil {name} walls", records[(name,)], f"{records[(name,)].value} iterations", f"{each[name] / each['without']:.2f}")


def viewer_rows(bench):
    n = 14 if bench.args.quick else min(224, bench.args.largest)
    (bench.folder / "specimen.toml").write_text(specimen.wide_layout())
    (bench.folder / "viewer.dat").write_text(specimen.elastic(n))
    jobs = []
    for option in ("none", "--vtu", "--msh"):
        folder = f"out_{option.strip('-')}"
        command = [bench.sagefe, "run", "--layout", "specimen.toml", "-o", folder, "viewer.dat", "--no-listing", *([option] if option != "none" else [])]
        jobs.append(Job((option,), command, lambda text: 0.0))
    records = bench.turns(jobs, strict=True)
    for option in ("none", "--vtu", "--msh"):
        files = list((bench.folder / f"out_{option.strip('-')}").rglob("*.*"))
        size = sum(f.stat().st_size for f in files if f.suffix in (".vtu", ".msh"))
        if option != "none" and not size:
            bench.wrong.append(f"{option}: no file")
        yield work_row(f"viewer file: {option}", records[(option,)], f"{1e-6 * size:.1f} MB of files", f"{records[(option,)].wall / records[('--vtu',)].wall:.2f}")


def safety_rows(bench):
    for name, spiral in list(SLOPES.items())[:1] if bench.args.quick else SLOPES.items():
        deck = str(ROOT / "legacy_inputs/slopes" / name / "deck.dat")
        job = Job((name,), [bench.sagefe, "safety", deck, "--json", "-q", "-o", "out_safety"], nonlinear.result_of)
        record = bench.turns([job], strict=True)[(name,)]
        low, high = record.value["lower"], record.value["upper"]
        if not (0.99 * spiral <= low <= high <= 1.02 * spiral):
            bench.wrong.append(f"{name}: factor {low:g} to {high:g}, log-spiral {spiral:g}")
        yield work_row(f"factor of safety: {name}", record, f"{low:.4f} to {high:.4f}")


def work(bench):
    rows = [*free_surfaces(bench), *([] if bench.args.quick else wall_rows(bench)), *viewer_rows(bench), *safety_rows(bench)]
    runs = f"Each time is the median of {bench.args.runs} runs, or of one run for the free surfaces."
    return {"work": Table(WORK_TITLE, WORK_NOTE, "`sagefe run` and `sagefe safety`.", WORK_HEAD, rows, runs)}
