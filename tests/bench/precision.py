"""Run time against error on scenes with known answers: the same mesh, the same error, graded meshes, the solvers."""
import csv
import dataclasses
import re
import subprocess

import peers
import scenes
from measure import Job, Table, ms
from same_mesh import Dolfinx


@dataclasses.dataclass
class Point:
    scene: str
    program: str
    variant: str
    mesh: str
    value: float
    error: float
    seconds: float  # wall, median
    processor: float  # seconds
    megabytes: float
    runs: int


def points_of(scene, records):
    found = []
    for labels, r in records.items():
        error = abs(r.value / scene.reference - 1)
        found.append(Point(*labels, r.value, error, r.wall, r.cpu, r.mb, len(r.walls)))
    return found


def sage_job(bench, scene, variant, mesh, deck, options):
    stem = re.sub(r"\W+", "_", f"{scene.name}_{variant}_{mesh}")
    text, layout = deck
    (bench.folder / "wide.toml").write_text(scenes.wide_layout())
    (bench.folder / f"{stem}.dat").write_text(text)
    command = [bench.sagefe, "run", "--layout", layout, "-o", "out", f"{stem}.dat", *bench.threads(), *options]

    def find(_):
        with open(bench.folder / "out" / f"{stem}.report1.csv") as table:
            rows = list(csv.DictReader(row for row in table if not row.startswith("#")))
        column = next(c for c in rows[-1] if c.split("[")[0] == scene.column)
        return scene.answer(float(rows[-1][column]))

    return Job((scene.name, "sagefe", variant, mesh), command, find)


VARIANTS = [
    ("quad4 full", "quad", ["--formulation", "1"]),
    ("quad4 b-bar", "quad", ["--formulation", "2"]),
    ("quad8 reduced", "quad", ["--element", "quad8", "--formulation", "1"]),
    ("quad8 full", "quad", ["--element", "quad8", "--formulation", "2"]),
    ("quad9", "quad", ["--element", "quad9"]),
    ("tri6", "tri6", []),
]


def plain_jobs(bench, scene, n):
    """Elements of low degree on the mesh n."""
    return [sage_job(bench, scene, name, str(n), scenes.deck(scene, n, kind), options) for name, kind, options in VARIANTS]


def graded_jobs(bench, scene, k):
    """High degrees on a few elements: graded to the singular corner, or finer where there is none."""
    grade = scene.data.get("grade")
    n = (1 if scene.data["family"] == "pinned" else 4) if grade else 2**k
    layers = 2 + 2 * k
    jobs = []
    for name in ("quad25", "quad49"):
        options = ["--element", name] + (["--grade", f"{grade}:{layers}:0.15"] if grade else [])
        mesh = f"{n}, {layers} layers" if grade else str(n)
        jobs.append(sage_job(bench, scene, name + (" graded" if grade else ""), mesh, scenes.deck(scene, n), options))
    return jobs


def three_layers(bench, scene):
    return sage_job(bench, scene, "quad25 graded", "1, 3 layers", scenes.deck(scene, 1), ["--element", "quad25", "--grade", "auto:3:0.15"])


def peer_jobs(bench, scene, n):
    jobs = []
    if peers.CCX and peers.ccx_can(scene) and not (scene.data["family"] == "footing" and n > 4):
        jobs += [peers.ccx_job(scene, n, element, quadratic, bench.folder) for element, quadratic in peers.ccx_elements(scene)]
    if peers.FREEFEM and peers.freefem_can(scene):
        jobs += [peers.freefem_job(scene, n, space, bench.folder) for space in ("P1", "P2")]
    return jobs


# Cells each way, and the powers of the grading.
GRADED_CELLS, POWERS = (4, 6, 8, 12, 16, 24, 32, 48), (3, 4, 5)


def graded_peer_jobs(bench, scene):
    """Meshes that get finer towards the singular corners; CalculiX for the pinned specimens only."""
    if "grade" not in scene.data:
        return []
    jobs = []
    cells = GRADED_CELLS[: 2 * bench.args.sizes]
    if peers.FREEFEM:
        jobs += [peers.freefem_graded_job(scene, n, "P2", power, bench.folder) for n in cells for power in POWERS]
    if peers.CCX and scene.data["family"] == "pinned":
        jobs += [peers.ccx_graded_job(scene, n, power, bench.folder) for n in cells[:-1] for power in POWERS]
    return jobs


def precision(bench):
    points = []
    for scene in scenes.scenes():
        for n in scene.sizes[: bench.args.sizes]:
            points += points_of(scene, bench.turns(plain_jobs(bench, scene, n) + peer_jobs(bench, scene, n)))
        if scene.data["family"] != "footing":
            for k in range(1 if bench.args.quick else 4):
                points += points_of(scene, bench.turns(graded_jobs(bench, scene, k)))
            if scene.data["family"] == "pinned":
                points += points_of(scene, bench.turns([three_layers(bench, scene)]))
        points += points_of(scene, bench.turns(graded_peer_jobs(bench, scene)))
    bench.wrong += wrong(points)
    bench.points = points
    with open(bench.out / "precision.csv", "w", newline="") as stream:
        fields = [f.name for f in dataclasses.fields(Point)]
        csv.writer(stream).writerows([fields, *(dataclasses.astuple(p) for p in points)])
    return {"equal_mesh": equal_mesh(points), "equal_error": equal_error(points)}


def find(points, scene, program, variant, mesh):
    return next((p for p in points if (p.scene, p.program, p.variant, p.mesh) == (scene, program, variant, mesh)), None)


SAME_MESH_TITLE = "The same mesh, all problems"
SAME_MESH_NOTE = (
    "The times are wall times of whole processes, with all output of sagefe. A ratio is the time of the other program divided by that of sagefe on the same mesh. FreeFEM divides each element of this mesh into two triangles. "
    "*P1* and similar words in a cell are the element of the other program."
)
SAME_MESH_OPTIONS = "`sagefe run --element ... --formulation ... --threads N`."
SAME_MESH_HEAD = ["problem", "element", "n", "sagefe ms", "error of sagefe", "CalculiX ms", "ratio", "error of CalculiX", "FreeFEM ms", "ratio", "error of FreeFEM"]


def equal_mesh(points):
    pairs = [("quad4 full", ("CAX4", "CPE4"), "P1"), ("quad8 reduced", ("CAX8R", "CPE8R"), "P2"), ("quad8 full", ("CAX8", "CPE8"), "P2")]
    rows = []
    for scene in scenes.scenes():
        for own, theirs, space in pairs:
            for n in map(str, scene.sizes):
                mine = find(points, scene.name, "sagefe", own, n)
                ccx = next((p for e in theirs if (p := find(points, scene.name, "CalculiX", e, n))), None)
                ff = find(points, scene.name, "FreeFEM", space, n)
                if not mine or not (ccx or ff):
                    continue
                row = [scene.name, own, n, ms(mine.seconds), f"{mine.error:.1e}"]
                for p in (ccx, ff):
                    row += [f"{p.variant} {ms(p.seconds)}", f"{p.seconds / mine.seconds:.1f}", f"{p.error:.1e}"] if p else ["-"] * 3
                rows.append(row)
    return Table(SAME_MESH_TITLE, SAME_MESH_NOTE, SAME_MESH_OPTIONS, SAME_MESH_HEAD, rows)


SAME_ERROR_TITLE = "The same error"
SAME_ERROR_NOTE = (
    "For each problem and each limit of the error, the table has the fastest run of each program whose error is within the limit. "
    "Times are wall times of whole processes, and a ratio is the time of the other program divided by that of sagefe. "
    "If no run reaches the limit, the cell has the smallest error of the program and the time of that run in milliseconds.\n"
    "\n"
    "Meshes have these names:\n"
    "\n"
    "- `7` is the uniform mesh with n = 7.\n"
    "- `1, 4 layers` is a mesh with n = 1 that sagefe grades towards singular corners. It has 4 layers of elements, each 0.15 times as thick as the one before (`--grade auto:4:0.15`).\n"
    "- `4 x 4, power 3` is a graded mesh of the other programs with 4 x 4 cells. Its lines are at the fractions 1 - (1 - s)^3 of the width and of the height, with s = 0, 1/4, 1/2, 3/4, 1. "
    "There are such meshes with the powers 3, 4 and 5.\n"
    "\n"
    "FreeFEM has graded meshes for the pinned specimens and Cook's membrane, CalculiX for the pinned specimens only. In all meshes of footings the elements get smaller towards the edge of the footing. "
    "`lame_nu4999999` has no singular corner, so its meshes are uniform."
)
SAME_ERROR_OPTIONS = "`sagefe run --element ... [--formulation ...] [--grade auto:LAYERS:0.15] --threads N`."
SAME_ERROR_HEAD = ["problem", "error at most", "sagefe ms", "element and mesh of sagefe", "CalculiX ms (element, mesh)", "ratio", "FreeFEM ms (element, mesh)", "ratio"]


def equal_error(points):
    rows = []
    for scene in scenes.scenes():
        own = [p for p in points if p.scene == scene.name]
        for target in (3e-2, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
            best = {}
            for p in own:
                if p.error <= target and (p.program not in best or p.seconds < best[p.program].seconds):
                    best[p.program] = p
            if "sagefe" not in best:
                continue
            mine = best["sagefe"]
            row = [scene.name, f"{target:g}", ms(mine.seconds), f"{mine.variant}, {mine.mesh}"]
            for program in ("CalculiX", "FreeFEM"):
                tried = [p for p in own if p.program == program]
                if program in best:
                    p = best[program]
                    row += [f"{ms(p.seconds)} ({p.variant}, {p.mesh})", f"{p.seconds / mine.seconds:.1f}"]
                elif tried:
                    closest = min(tried, key=lambda p: p.error)
                    row += [f"not reached; {closest.error:.0e} in {ms(closest.seconds)}", "-"]
                else:
                    row += ["-", "-"]
            rows.append(row)
    return Table(SAME_ERROR_TITLE, SAME_ERROR_NOTE, SAME_ERROR_OPTIONS, SAME_ERROR_HEAD, rows)


def wrong(points):
    """Scenes that no element of the program comes near: a broken deck or script, not a slow machine."""
    found = []
    for scene in scenes.scenes():
        errors = [p.error for p in points if p.scene == scene.name and p.program == "sagefe"]
        bound = 0.15 if scene.data["family"] == "footing" else 2e-3  # what the coarsest meshes reach
        if not errors or not min(errors) <= bound:
            found.append(f"{scene.name}: the best is {min(errors, default=float('nan')):.1e} off, expected {bound:g}")
    return found


# ------------------------------------------------------------------------------------------------- graded against graded


def dolfinx_graded_jobs(scene):
    options = ["--nu", str(scene.data["nu"]), "--slenderness", str(scene.data["slenderness"])]
    jobs = []
    for degree, cells in ((2, (6, 8, 12, 16, 24, 32)), (4, (3, 4, 6, 8, 12)), (6, (3, 4, 6))):
        for n in cells:
            job = peers.dolfinx_job("linear", n, 3, "--rows", str(n), "--degree", str(degree), "--power", str(3 + (degree > 2) + (degree > 4)), *options)
            jobs.append(Job((scene.name, "dolfinx", f"Q{degree} graded", f"{n} x {n}"), job.command, job.find))
    return jobs


def graded_points(bench, scene):
    """Those of sagefe, CalculiX and FreeFEM are of the part `precision`, if it has been measured in this call."""
    points = [p for p in bench.points if p.scene == scene.name and "graded" in p.variant]
    points = points or fresh_graded_points(bench, scene)
    if peers.DOLFINX:
        for labels, record in bench.turns(dolfinx_graded_jobs(scene)).items():
            inside = Dolfinx(record)
            points.append(Point(*labels, inside.ratio, abs(inside.ratio / scene.reference - 1), inside.wall, inside.cpu, record.mb, len(record.walls)))
    return points


def fresh_graded_points(bench, scene):
    own = [job for k in range(4) for job in graded_jobs(bench, scene, k)]
    own.append(three_layers(bench, scene))
    return points_of(scene, bench.turns(own + graded_peer_jobs(bench, scene)))


GRADED_TITLE = "The same error, graded meshes of all programs"
GRADED_NOTE = (
    "This table includes dolfinx. It has the pinned specimens on graded meshes. For each limit of the error it shows the fastest run of each program, with the best element and number of cells or layers. "
    "The mesh lines of dolfinx are at the fractions 1 - (1 - s)^p, with p = 3 for Q2, 4 for Q4 and 5 for Q6; those of CalculiX and FreeFEM have p = 3, 4 and 5.\n"
    "\n"
    "The column *error of* names the value whose relative error is limited. It is the ratio, or the *effect* of the rough ends, which is ratio - 1. The effect is only .018 to .19, so a limit on its relative error is stricter.\n"
    "\n"
    "Times are processor times in milliseconds, of whole processes of sagefe, CalculiX and FreeFEM. The time of dolfinx is that from the mesh to the answer, without the start of Python, imports and compilation; "
    "the last column compares it with the whole process of sagefe."
)
GRADED_OPTIONS = "`sagefe run --element quad25|quad49 --grade auto:LAYERS:0.15 --threads N`."
GRADED_HEAD = [
    "problem", "error of", "error at most", "sagefe ms", "element and mesh of sagefe", "CalculiX ms (element, mesh)", "FreeFEM ms (element, mesh)", "dolfinx ms, mesh to answer", "faster of CalculiX and FreeFEM over sagefe", "dolfinx over sagefe"]


def graded(bench):
    """Processor times: both programs on one thread, and less noise."""
    rows = []
    for scene in scenes.scenes()[:1] if bench.args.quick else scenes.scenes()[:4]:
        points = graded_points(bench, scene)
        for measure, scale in (("ratio", 1.0), ("effect", scene.reference / (scene.reference - 1))):
            for target in (1e-3, 1e-4, 1e-5):
                rows.append(graded_row(scene.name, measure, target, [p for p in points if p.error * scale <= target]))
    return {"graded": Table(GRADED_TITLE, GRADED_NOTE, GRADED_OPTIONS, GRADED_HEAD, rows)}


def graded_row(name, measure, target, within):
    best = {}
    for p in sorted(within, key=lambda p: p.processor):
        best.setdefault(p.program, p)
    cell = lambda p: f"{ms(p.processor)} ({p.variant.replace(' graded', '')}, {p.mesh.replace(' power', ' p =') if p.program != 'dolfinx' else p.mesh})" if p else "not reached"
    mine = best.get("sagefe")
    others = [best.get(program) for program in ("CalculiX", "FreeFEM", "dolfinx")]
    whole = min((p.processor for p in others[:2] if p), default=None)
    over = lambda seconds: f"{seconds / mine.processor:.1f}" if mine and seconds else "-"
    ratios = [over(whole), over(others[2].processor if others[2] else None)]
    return [name, measure, f"{target:g}", ms(mine.processor) if mine else "not reached", f"{mine.variant}, {mine.mesh}" if mine else "-", *map(cell, others), *ratios]


# ------------------------------------------------------------------------------------------------- solvers


SOLVERS_TITLE = "Solvers"
SOLVERS_NOTE = (
    "The table has the wall time of the whole process in milliseconds for each [solver](theory/solvers.md). The problem is `pinned_ld2_nu495` on n x 2n quad8 reduced."
)
SOLVERS_OPTIONS = "`sagefe run --element quad8 --formulation 1 --solver NAME --threads N`."


def solvers_head(names):
    return ["n", *(f"{name} ms" for name in names)]


def solvers(bench):
    """Every solver on the same scene, quad8 reduced."""
    scene = scenes.scenes()[3]
    text = subprocess.run([bench.sagefe, "list", "solvers"], capture_output=True, text=True, check=True).stdout
    names = re.findall(r"^\s*\d+\s+(\w+) \(", text, re.M)
    rows = []
    for n in scene.sizes[: bench.args.sizes]:
        options = ["--element", "quad8", "--formulation", "1", "--solver"]
        jobs = [sage_job(bench, scene, name, str(n), scenes.deck(scene, n), [*options, name]) for name in names]
        found = {labels[2]: r for labels, r in bench.turns(jobs).items()}
        rows.append([str(n), *(ms(found[name].wall) if name in found else "-" for name in names)])
    return {"solvers": Table(SOLVERS_TITLE, SOLVERS_NOTE, SOLVERS_OPTIONS, solvers_head(names), rows)}
