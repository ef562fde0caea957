"""The pinned specimen of n x 2n quad4 in sagefe and its peers, from small to large: linear, and with the Drucker-Prager law."""
import csv
import re
import statistics

import peers
import scenes
import specimen
from measure import Job, Table, both, exponents

AGREE = {"linear": 1e-7, "plastic": 1e-6}  # answers of the same mesh and law; the second ends where its iteration does


def unknowns(text):
    return int(re.search(r"(\d+) equations", text).group(1))


def sage_job(bench, stem, variant, n, text, *options):
    (bench.folder / "specimen.toml").write_text(specimen.wide_layout())
    (bench.folder / f"{stem}.dat").write_text(text)

    def find(_):
        with open(bench.folder / "out" / f"{stem}.report1.csv") as table:
            rows = list(csv.DictReader(line for line in table if not line.startswith("#")))
        return float(rows[-1]["ratio[-]"])

    command = [bench.sagefe, "run", "--layout", "specimen.toml", "-o", "out", f"{stem}.dat", *bench.threads(), *options]
    return Job((stem, "sagefe", variant, str(n)), command, find)


class Dolfinx:
    """Seconds within its process, from the mesh to the answer: of the runs that took their turn."""

    def __init__(self, record):
        self.ratio, self.iterations = record.value["ratio"], record.value["iterations"]
        self.wall, self.cpu = (statistics.median(t for value in record.values for t in value[key]) for key in ("wall", "processor"))


def check(bench, key, n, ratio, own):
    if not abs(ratio / own - 1) <= AGREE[key]:
        bench.wrong.append(f"{key}, n = {n}: dolfinx {ratio:.10g}, sagefe {own:.10g}")


def linear_jobs(bench, n, pinned, slow):
    jobs = [sage_job(bench, f"linear_{n}", name, n, specimen.elastic(n), *more) for name, more in (("listing", []), ("no listing", ["--no-listing"]))]
    if peers.CCX and "CalculiX" not in slow:
        jobs.append(peers.ccx_job(pinned, n, "CAX4", False, bench.folder))
    if peers.FREEFEM and "FreeFEM" not in slow:
        jobs.append(peers.freefem_job(pinned, n, "P1", bench.folder))
    if peers.DOLFINX:
        jobs.append(peers.dolfinx_job("linear", n, 5 if n < 112 else 2))
        jobs.append(peers.dolfinx_job("linear", n, 1, "--once"))
    return jobs


def linear_row(n, dofs, own, bare, whole, inside, exponent):
    row = [str(n), str(dofs), both(own.wall, own.cpu), both(bare.wall, bare.cpu)]
    row += [both(whole[name].wall, whole[name].cpu) if name in whole else "-" for name in ("CalculiX", "FreeFEM", "dolfinx")]
    row.append(both(inside.wall, inside.cpu) if inside else "-")
    name, best = min(whole.items(), key=lambda item: item[1].cpu, default=("-", None))
    row += [name, *((f"{best.cpu / own.cpu:.1f}", f"{min(r.wall for r in whole.values()) / own.wall:.1f}") if best else ("-", "-"))]
    row += [f"{inside.cpu / own.cpu:.1f}", f"{inside.cpu / bare.cpu:.1f}"] if inside else ["-", "-"]
    return [*row, exponent]


LINEAR_TITLE = "The same mesh, linear problem, small to large"
LINEAR_NOTE = (
    "The problem is `pinned_ld2_nu25` on n x 2n quad4 full. A cell has the wall time / the processor time in milliseconds. The runs write all output, except that those of the column *no listing* have the option `--no-listing`.\n"
    "\n"
    "dolfinx has the same elements and integration points, and its ratio agrees with that of sagefe to 1e-7; otherwise the benchmark fails. It solves with MUMPS in its symmetric mode, with METIS. "
    "Its forms are compiled before the measurement. Most of the time of its process is the start of Python and imports. The column *mesh to answer* therefore has only the time after the imports. "
    "The two columns *dolfinx, mesh to answer, over sagefe* and *the same over sagefe, no listing* divide this time by that of whole processes of sagefe, which include start, input and output.\n"
    "\n"
    "The *exponent* is e in processor time = constant x unknowns^e, computed from a row and the row above it."
)
LINEAR_OPTIONS = "`sagefe run --threads N`."
LINEAR_HEAD = [
    "n", "unknowns", "sagefe", "sagefe, no listing", "CalculiX CAX4", "FreeFEM P1", "dolfinx Q1", "dolfinx, mesh to answer", "fastest other whole process", "its processor time over sagefe", "its wall time over sagefe",
    "dolfinx, mesh to answer, over sagefe (processor)", "the same over sagefe, no listing", "exponent of sagefe",
]


def linear(bench):
    pinned = scenes.scenes()[2]
    sizes, found, slow = [n for n in (14, 28, 56, 112, 224, 448) if n <= bench.args.largest], [], set()
    for n in sizes:
        records = {labels[1:3]: r for labels, r in bench.turns(linear_jobs(bench, n, pinned, slow)).items()}
        own = records[("sagefe", "listing")]
        if not abs(own.value / pinned.reference - 1) < 2e-3:
            bench.wrong.append(f"linear, n = {n}: sagefe {own.value}")
        whole = {program: records[key] for key in records for program in key[:1] if program != "sagefe" and key != ("dolfinx", "")}
        slow |= {name for name, r in whole.items() if name != "dolfinx" and r.wall > 6}  # the next takes five times that
        inside = Dolfinx(records[("dolfinx", "")]) if ("dolfinx", "") in records else None
        if inside:
            check(bench, "linear", n, inside.ratio, own.value)
        found.append((n, unknowns(own.text), own, records[("sagefe", "no listing")], whole, inside))
    growth = exponents([(dofs, own.cpu) for _, dofs, own, *_ in found])
    rows = [linear_row(*line, exponent) for line, exponent in zip(found, growth)]
    return {"linear": Table(LINEAR_TITLE, LINEAR_NOTE, LINEAR_OPTIONS, LINEAR_HEAD, rows)}


def plastic_jobs(bench, n):
    jobs = [sage_job(bench, f"plastic_{n}", "listing", n, specimen.plastic(n))]
    if peers.DOLFINX:
        for solver in ("mumps", "petsc") if n <= 28 else ("mumps",):
            jobs.append(peers.dolfinx_job("plastic", n, 1, "--solver", solver, "--steps", str(specimen.STEPS)))
    return jobs


PLASTIC_TITLE = "The same mesh, Drucker-Prager"
PLASTIC_NOTE = (
    "The specimen is that of the table above, with the Drucker-Prager law of `dp_285` (phi = 36.87 degrees, c = 0, flow without volume change, nu = .495). "
    "The cell pressure is 50 psi, and the axial strain increases to 15 % in 60 increments. The ratio is the measured deviator stress at 15 %, divided by the correct one. A cell has the wall time / the processor time in milliseconds.\n"
    "\n"
    "The program for dolfinx has the same law, return and consistent tangent, in kernels compiled for this processor. Its ratio agrees with that of sagefe to 1e-6; otherwise the benchmark fails. "
    "Its time is that from the mesh to the answer, with MUMPS or PETSc's own LU, whichever is faster. The time of sagefe is that of the whole process with all output. "
    "In both programs the iteration starts from the displacement increment of the previous increment. dolfinx factorises in every iteration; some iterations of sagefe use the factors of an earlier one.\n"
    "\n"
    "For the column *processor time per iteration*, the processor time of each program is divided by its number of iterations. The exponent is defined as in the table above."
)
PLASTIC_OPTIONS = "`sagefe run --threads N`."
PLASTIC_HEAD = [
    "n", "unknowns", "ratio at 15 %", "sagefe", "iterations of sagefe", "dolfinx", "iterations of dolfinx", "difference of the ratios", "dolfinx over sagefe, processor time", "dolfinx over sagefe, wall time",
    "dolfinx over sagefe, processor time per iteration", "exponent of sagefe",
]


def plastic(bench):
    rows, found = [], []
    for n in [n for n in (14, 28, 56, 112) if n <= max(14, bench.args.largest // 2)]:
        records = bench.turns(plastic_jobs(bench, n), 0 if n > 56 else None)
        own = next(r for labels, r in records.items() if labels[1] == "sagefe")
        rivals = {labels[2].split()[1]: Dolfinx(r) for labels, r in records.items() if labels[1] == "dolfinx"}
        for rival in rivals.values():
            check(bench, "plastic", n, rival.ratio, own.value)
        found.append((n, unknowns(own.text), own, rivals))
    for (n, dofs, own, rivals), growth in zip(found, exponents([(dofs, own.cpu) for _, dofs, own, _ in found])):
        iterations = int(re.search(r"(\d+) iterations", own.text).group(1))
        row = [str(n), str(dofs), f"{own.value:.7f}", both(own.wall, own.cpu), str(iterations)]
        if rivals:
            name, best = min(rivals.items(), key=lambda item: item[1].cpu)
            row += [f"{both(best.wall, best.cpu)} ({name})", str(best.iterations), f"{abs(best.ratio - own.value):.0e}"]
            row += [f"{best.cpu / own.cpu:.1f}", f"{best.wall / own.wall:.1f}", f"{best.cpu / best.iterations / (own.cpu / iterations):.1f}"]
        else:
            row += ["-"] * 6
        rows.append([*row, growth])
    runs = f"Each time is the median of {bench.args.runs} runs, for n = 112 that of a single run."
    return {"plastic": Table(PLASTIC_TITLE, PLASTIC_NOTE, PLASTIC_OPTIONS, PLASTIC_HEAD, rows, runs)}
