"""How time grows with the mesh: the linear specimen, the specimen on its interface, a Mohr-Coulomb footing."""
import json
import math
import os

import scenes
import specimen
from measure import Job, Table, exponents, fitted_exponent
from precision import sage_job as scene_job
from same_mesh import sage_job, unknowns
from shipped import chapter_deck

# Columns of the tables, and the phases of --profile that they hold.
PHASES = {
    "read, model": ("reading the deck", "building the model"),
    "numbering": ("numbering",),
    "assembly": ("assembly",),
    "condensation": ("condensation",),
    "factorisation": ("factorisation",),
    "solution": ("solution",),
    "output": ("output", "opening and closing files"),
}
TOO_LONG = 40.0  # seconds: no larger mesh is begun
COLUMNS = (
    "- The exponent is e in time = constant x unknowns^e. The column *exponent* has the value for the wall time, computed from a row and the row above it. "
    "The last row has the value for each column, by least squares over the larger half of the problems.\n"
    "- *wall s, all threads* is the wall time in seconds on all processors of the machine.\n"
    "- The columns from *read, model* to *output* are the times of the phases, from one further run with `--profile`. They are not medians, so their sum may exceed the wall time of the row.\n"
    "- *factor GF/s* is the speed of the factorisation in that run, and *% of DGEMM* the same as a percentage of the speed of matrix products on this machine.\n"
    "- *MB* is the largest memory of the process."
)
SCALING_TITLE = "Run time against size: linear specimen"
SCALING_NOTE = (
    "The problem is `pinned_ld2_nu25` on n x 2n quad4 full, in one increment, with all output."
)
INTERFACE_TITLE = "Run time against size: elastic specimen on an interface"
INTERFACE_NOTE = (
    "The deck is `friction_285_nu0495` with `--refine k`. It is an elastic specimen of n x 2n quad4 with n = 14 2^k under a rigid platen on a hyperbolic interface, in 40 increments, with all output. "
    "The last column is the wall time divided by that of the linear specimen of the table above on the same mesh. For this column both were measured in alternating runs, so it does not follow from the two tables."
)
INTERFACE_BESIDE = "over linear specimen"
FOOTING_TITLE = "Run time against size: Mohr-Coulomb footing"


def footing_note(collapse_load, differences):
    """differences: {n: relative error}"""
    words = ", ".join(f"{error:.1%} for n = {n}" for n, error in differences.items())
    return (
        "The problem is a rough rigid strip footing on weightless Mohr-Coulomb ground with phi = psi = 20 degrees and c = 1. There are n quad4 b-bar under its half width. The run has 12 increments and writes all output. "
        f"The exact collapse load is {collapse_load:.5g} c. The computed one differs from it by {words}."
    )


def flat(phase, into):
    """Own seconds, operations by name of the phase."""
    seconds, operations = into.get(phase["phase"], (0.0, 0.0))
    below = phase.get("phases", [])
    own_operations = phase.get("operations", 0.0) - sum(child.get("operations", 0.0) for child in below)
    into[phase["phase"]] = (seconds + phase["own_seconds"], operations + own_operations)
    for child in below:
        flat(child, into)
    return into


def profile(bench, job):
    """The tree of one more run with --profile, by name."""
    stem = "deck_of_profile"
    command = [*job.command, "--profile"]
    before = set((bench.folder / "out").glob("*.profile.json"))
    for file in before:
        file.unlink()
    bench.turns([Job((stem,), command, lambda text: 0.0)], 0, strict=True)
    file = next((bench.folder / "out").glob("*.profile.json"))
    return flat(json.loads(file.read_text())["run"], {})


def measured(bench, sizes, make, beside=None):
    """[(size, unknowns, Record, phases, Record on all threads or None, Record beside or None)]; make: size -> Job on
    the threads of the bench; beside: size -> Job of another scene that takes turns with it."""
    found = []
    for size in sizes:
        job = make(size)
        jobs = {"own": job}
        if (os.cpu_count() or 1) > bench.args.threads:
            at = job.command.index("--threads")
            jobs["all"] = Job((*job.labels, "all threads"), job.command[:at] + job.command[at + 2 :], job.find)
        if beside:
            jobs["beside"] = beside(size)
        # A run of one thread, and one of all, have the same bits: either may leave the files.
        records = bench.turns(list(jobs.values()), strict=True)
        of = {name: records[j.labels] for name, j in jobs.items()}
        found.append((size, unknowns(of["own"].text), of["own"], profile(bench, job), of.get("all"), of.get("beside")))
        if of["own"].wall > TOO_LONG:
            break
    return found


def seconds(phases, column):
    return sum(phases.get(name, (0.0, 0.0))[0] for name in PHASES[column])


def table(bench, title, note, options, size_name, found, beside=None):
    columns = [c for c in PHASES if any(seconds(p, c) > 0 for _, _, _, p, _, _ in found)]
    growth = exponents([(dofs, r.wall) for _, dofs, r, _, _, _ in found])
    rows = []
    for (size, dofs, r, phases, every, other), exponent in zip(found, growth):
        row = [str(size), str(dofs), f"{r.wall:.4g}", exponent, f"{r.cpu:.4g}", f"{every.wall:.4g}" if every else "-"]
        row += [f"{seconds(phases, c):.3g}" for c in columns]
        took, operations = phases.get("factorisation", (0.0, 0.0))
        speed = 1e-9 * operations / took if took > 0 else 0.0
        row += [f"{speed:.1f}" if speed else "-", f"{100 * speed / bench.dgemm:.0f}" if speed and bench.dgemm else "-", f"{r.mb:.0f}"]
        rows.append(row + ([f"{r.wall / other.wall:.1f}"] if beside else []))
    if len(found) > 1:
        fit = found[len(found) // 2 :] if len(found) > 3 else found
        by = lambda value: fitted_exponent([(f[1], value(f)) for f in fit])
        last = ["exponent", "", by(lambda f: f[2].wall), "", by(lambda f: f[2].cpu), by(lambda f: f[4].wall) if found[0][4] else "-"]
        last += [by(lambda f, c=c: seconds(f[3], c)) for c in columns] + ["-", "-", by(lambda f: f[2].mb)]
        rows.append(last + ["-"] * (beside is not None))
    head = [size_name, "unknowns", "wall s", "exponent", "processor s", "wall s, all threads", *(f"{c} s" for c in columns), "factor GF/s", "% of DGEMM", "MB"]
    return Table(title, f"{note}\n\n{COLUMNS}", options, head + ([beside] if beside else []), rows)


def scaling(bench):
    sizes = [n for n in (14, 28, 56, 112, 224, 448, 700) if n <= bench.args.largest]
    found = measured(bench, sizes, lambda n: sage_job(bench, f"scaling_{n}", "", n, specimen.elastic(n)))
    return {"scaling": table(bench, SCALING_TITLE, SCALING_NOTE, "`sagefe run --threads N`.", "n", found)}


def interface(bench):
    def job(k):
        command = [bench.sagefe, "run", "-o", "out", chapter_deck("friction_285_nu0495"), "--threads", str(bench.args.threads), "--refine", str(k)]
        return Job(("interface", k), command, lambda text: 0.0)

    beside = lambda k: sage_job(bench, f"beside_{k}", "", 14 * 2**k, specimen.elastic(14 * 2**k))
    refinements = [k for k in range(6) if 14 * 2**k <= bench.args.largest // 2]
    found = measured(bench, refinements, job, beside)
    return {"interface": table(bench, INTERFACE_TITLE, INTERFACE_NOTE, "`sagefe run --refine k --threads N`.", "k", found, INTERFACE_BESIDE)}


def mohr_coulomb_footing():
    """Weightless ground with c = 1, phi = psi = 20, rough: (N_q - 1) cot phi (Prandtl)."""
    phi = math.radians(20.0)
    n_q = math.exp(math.pi * math.tan(phi)) * math.tan(math.pi / 4 + phi / 2) ** 2
    return scenes.footing(1, True, (n_q - 1) / math.tan(phi), law=(4, (1000.0, 0.3, 1.0, 20.0, 20.0)))


def footing(bench):
    scene = mohr_coulomb_footing()
    sizes = [n for n in (4, 8, 16, 32) if n <= max(4, bench.args.largest // 14)]
    found = measured(bench, sizes, lambda n: scene_job(bench, scene, "quad4 b-bar", str(n), scenes.deck(scene, n), ["--formulation", "2"]))
    far = [abs(f[2].value / scene.reference - 1) for f in found]
    if not far[-1] < 0.6:
        bench.wrong.append(f"footing: {far[-1]:.0%} from {scene.reference:.6g}")
    note = footing_note(scene.reference, {f[0]: e for f, e in zip(found, far)})
    return {"footing": table(bench, FOOTING_TITLE, note, "`sagefe run --formulation 2 --threads N`.", "n", found)}
