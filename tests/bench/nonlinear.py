"""Accuracy for time of nonlinear answers: collapse load, strength of a specimen, history on an interface; over element, mesh,
increments and tolerance.  docs/manual/accuracy.md draws its advice from these tables.
"""
import csv
import dataclasses
import json
import re

import scenes
from measure import Job, Table, ms
from precision import sage_job
from shipped import chapter_deck
from specimen import ROOT

OWN = 0.0  # the program's own tolerance


@dataclasses.dataclass
class Case:
    scene: str
    element: str
    mesh: str
    increments: int
    tolerance: float
    varied: str  # the part of the study: mesh, increments or tolerance
    job: Job


@dataclasses.dataclass
class Row:
    case: Case
    value: float
    error: float
    record: object


HEAD = ["varied", "problem", "element", "mesh", "increments", "tolerance", "value", "error", "wall ms", "processor ms", "iterations", "best"]
COLUMNS = (
    "The column *varied* states what differs in the row: `mesh` for element and mesh, or only the grading, the number of increments, or the tolerance of the iteration. The default tolerance is 1e-8. "
    "An asterisk in the column *best* means that no other row of the same problem has both a shorter processor time and a smaller error."
)


def compute(bench, cases, reference):
    """reference: Case -> exact value.  A run that ends early is a note."""
    cases = cases[:: max(1, len(cases) // 3)] if bench.args.quick else cases
    records = bench.turns([case.job for case in cases])
    rows = []
    for case in cases:
        if case.job.labels not in records:
            continue
        record = records[case.job.labels]
        exact = reference(case)
        values = record.value if isinstance(record.value, dict) else {"": record.value}
        exacts = exact if isinstance(exact, dict) else {"": exact}
        error = max(abs(values[at] / exacts[at] - 1) for at in exacts)
        rows.append(Row(case, list(values.values())[-1], error, record))
    return rows


def best_of(rows):
    """Rows of the same scene than which none is both faster and nearer."""
    found = set()
    for row in rows:
        rivals = [r for r in rows if r.case.scene == row.case.scene and r is not row]
        if not any(r.error <= row.error and r.record.cpu <= row.record.cpu for r in rivals):
            found.add(id(row))
    return found


def iterations_of(text):
    """Of a summary, or the sum over the stages or trials of a JSON document."""
    in_json = re.findall(r'"iterations": (\d+)', text)
    return str(sum(map(int, in_json))) if in_json else re.search(r"(\d+) iterations", text).group(1)


def result_of(text):
    """Of the JSON document in the output of a run, whose notes may stand before and behind it."""
    start = re.search(r"^\{", text, re.M)
    if not start:
        raise ValueError("no JSON document")
    return json.JSONDecoder().raw_decode(text[start.start() :])[0]["result"]


def table(bench, key, title, note, options, rows):
    best = best_of(rows)
    lines = []
    for row in rows:
        c = row.case
        iterations = iterations_of(row.record.text)
        tolerance = f"{c.tolerance:g}" if c.tolerance else "default"
        cells = [c.varied, c.scene, c.element, c.mesh, str(c.increments), tolerance, f"{row.value:.6g}", f"{row.error:.1e}"]
        lines.append([*cells, ms(row.record.wall), ms(row.record.cpu), iterations, "*" if id(row) in best else ""])
    return {key: Table(title, f"{note}\n\n{COLUMNS}", options, HEAD, lines)}


# ------------------------------------------------------------------------------------------------- collapse load

FOOTING = [
    ("quad4 full", "quad", ["--formulation", "1"], (4, 8, 16, 32)),
    ("quad4 b-bar", "quad", ["--formulation", "2"], (4, 8, 16, 32)),
    ("quad8 reduced", "quad", ["--element", "quad8", "--formulation", "1"], (4, 8, 12, 16)),
    ("quad8 full", "quad", ["--element", "quad8", "--formulation", "2"], (4, 8, 12, 16)),
    ("quad9", "quad", ["--element", "quad9"], (4, 8, 12, 16)),
    ("tri6", "tri6", [], (4, 8, 12, 16)),
    ("tri15", "tri15", [], (2, 4, 6, 8)),
]


def footing_case(bench, name, varied, rough, element, n, increments=12, tolerance=OWN, power=2.2):
    _, kind, options, _ = next(row for row in FOOTING if row[0] == element)
    scene = dataclasses.replace(scenes.footing(1, rough, 2 + 3.141592653589793, power=power), increments=increments, tolerance=tolerance)
    mesh = f"{n}, {'graded' if power > 1 else 'uniform'}"
    job = sage_job(bench, scene, element, f"{mesh}, {increments}, {tolerance:g}", scenes.deck(scene, n, kind), options)
    return Case(name, element, mesh, increments, tolerance, varied, job)


COLLAPSE_TITLE = "Error against run time: collapse load of a strip footing"
COLLAPSE_NOTE = (
    "The problem is a rigid strip footing of half width 1 on clay (Tresca, c = 1, E = 298, nu = .49).\n"
    "\n"
    "- *value* is the mean pressure at a settlement of .15, and *error* its relative difference from the exact collapse load, 2 + pi (Prandtl).\n"
    "- *mesh* is the number n of elements, or pairs of triangles, under the half width. In a `graded` mesh they get smaller towards the edge of the footing: "
    "the vertical lines are at the fractions 1 - (1 - s)^2.2 of the half width, with s = 0, 1/n, ..., 1. In a `uniform` mesh they are equally wide."
)
COLLAPSE_OPTIONS = "`sagefe run --element ... --formulation ... --threads N`."


def collapse(bench):
    cases = []
    for name, rough in (("smooth strip", False), ("rough strip", True)):
        for element, _, _, sizes in FOOTING:
            cases += [footing_case(bench, name, "mesh", rough, element, n) for n in sizes]
        cases += [footing_case(bench, name, "grading", rough, element, 8, power=1) for element in ("quad4 b-bar", "quad8 reduced")]
    for element, n in (("quad4 b-bar", 8), ("quad8 reduced", 8)):
        cases += [footing_case(bench, "smooth strip", "increments", False, element, n, k) for k in (3, 6, 24, 48)]
        cases += [footing_case(bench, "smooth strip", "tolerance", False, element, n, 12, t) for t in (1e-2, 1e-3, 1e-4, 1e-6)]
    rows = compute(bench, cases, lambda case: 2 + 3.141592653589793)
    return table(bench, "collapse", COLLAPSE_TITLE, COLLAPSE_NOTE, COLLAPSE_OPTIONS, rows)


# ------------------------------------------------------------------------------------------------- factor of safety

SLOPE = [
    ("quad4 full", ["--formulation", "1"]),
    ("quad4 b-bar", ["--formulation", "2"]),
    ("quad4 enhanced", ["--formulation", "5"]),
    ("quad8 reduced", ["--element", "quad8", "--formulation", "1"]),
    ("quad8 full", ["--element", "quad8", "--formulation", "2"]),
    ("quad9", ["--element", "quad9"]),
]
SPIRAL = 1.36482236  # legacy_inputs/slopes/README.md
FAR, FAR_ON_COARSE_MESHES = 0.015, 0.05  # what the best of the meshes must reach; the second with --quick
SAFETY_TITLE = "Error against run time: factor of safety of a slope"
SAFETY_NOTE = (
    "Value: middle of the bracket of `sagefe safety --tolerance .002` for the slope of [`one_to_one`](../legacy_inputs/slopes/README.md): 1:1, 8 m high, c = 10 kPa, phi = psi = 30 degrees. Error: relative to the factor 1.36482 of the best log-spiral, which is an upper bound on the exact one. The bracket is .15 % wide, so smaller errors mean nothing. "
    "Mesh: elements along the base x elements along the height."
)


def slope_deck(columns, rows):
    line = scenes.Columns(5, 10).line
    across = columns + 1
    top, last = across * rows + 1, across * (rows + 1)
    corners = ((1, 0.0, 0.0), (across, 16.0, 0.0), (top, 0.0, 8.0), (last, 8.0, 8.0))
    return "\n".join(
        [
            f"Slope 1:1 of {columns} x {rows} elements",
            "m       kN      kPa        101.325      9.81",
            line(1, 0, 4, 1, 1, 1, 1, 2, 0, 1, 0, 0, 0),
            *(line(node, 0, 0, x, y) for node, x, y in corners),
            line(1, columns, 1, rows, across, 0.0, 0.0),
            line(1, 4, 5, 18.0) + "soil",
            line(1e5, 0.3, 10.0, 30.0, 30.0),
            line(1, 1, 0, 1) + "slope",
            line(1, 1, 1, 2, across + 2, across + 1, 0, 0, 0, 0, columns, rows, 1, across),
            line(1, across, 1, 1, 1),
            line(across + 1, top, across, 1, 0),
            "weight",
            line(1, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0.0, -1.0),
            "END",
            "",
        ]
    )


def must_come_near(bench, key, rows):
    far = FAR_ON_COARSE_MESHES if bench.args.quick else FAR
    if not min((row.error for row in rows), default=1.0) <= far:
        bench.wrong.append(f"{key}: no mesh is within {far:.1%}")


def slope_case(bench, element, options, columns):
    rows = columns * 4 // 5
    stem = re.sub(r"\W+", "_", f"slope_{element}_{columns}")
    (bench.folder / f"{stem}.dat").write_text(slope_deck(columns, rows))

    def find(text):
        found = result_of(text)
        return 0.5 * (found["lower"] + found["upper"])

    command = [bench.sagefe, "safety", f"{stem}.dat", "--tolerance", ".002", "--json", "-q", "-o", f"out_{stem}", *bench.threads(), *options]
    return Case("1:1 slope", element, f"{columns} x {rows}", 1, OWN, "mesh", Job(("1:1 slope", element, columns), command, find))


def safety(bench):
    elements, sizes = (SLOPE[3:4], (5, 10)) if bench.args.quick else (SLOPE, (5, 10, 20, 30))
    rows = compute(bench, [slope_case(bench, element, options, n) for element, options in elements for n in sizes], lambda case: SPIRAL)
    must_come_near(bench, "safety", rows)
    return table(bench, "safety", SAFETY_TITLE, SAFETY_NOTE, "`sagefe safety --element ... --formulation ... --tolerance .002 --threads N`.", rows)


# ------------------------------------------------------------------------------------------------- wall moment

WALL = [
    ("quad4 full", '"quad4", formulation = "full"', (2.0, 1.0, 0.5, 0.25)),
    ("quad4 b-bar", '"quad4", formulation = "b-bar"', (2.0, 1.0, 0.5, 0.25)),
    ("quad8 reduced", '"quad8", formulation = "reduced"', (2.0, 1.0, 0.5)),
    ("quad8 full", '"quad8", formulation = "full"', (2.0, 1.0, 0.5)),
    ("quad9", '"quad9"', (2.0, 1.0, 0.5)),
    ("tri6", '"tri6"', (2.0, 1.0, 0.5)),
]
# The finest meshes, with elements of .25 m (quad8 reduced, tri6) and .125 m (quad4 b-bar), give 43.53, 43.65 and 43.53.
MOMENT = 43.6
MOMENT_TITLE = "Error against run time: bending moment of a wall"
MOMENT_NOTE = (
    "Value: largest bending moment in kN m per metre of the wall of [`braced_cut`](../legacy_inputs/models/braced_cut.sage.toml), an excavation 6 m deep with two struts in Mohr-Coulomb soil, over all stages. Error: relative to 43.6, the converged value, which is known to .3 %. Its three finest meshes give 43.53, 43.53 and 43.65. "
    "Mesh: size of the elements in m."
)


def moment_case(bench, element, words, size):
    stem = re.sub(r"\W+", "_", f"cut_{element}_{size}")
    text = (ROOT / "legacy_inputs/models/braced_cut.sage.toml").read_text()
    text, count = re.subn(r"^mesh = .*$", f"mesh = {{element = {words}, size = {size}}}", text, flags=re.M)
    if count != 1:
        raise ValueError("braced_cut.sage.toml has no line of its mesh")
    (bench.folder / f"{stem}.sage.toml").write_text(text)

    def find(output):
        stages = result_of(output)["decks"][0]["structures"]["stages"]
        ends = [row[end]["value"] for row in stages if row["quantity"] == "bending_moment" for end in ("least", "largest")]
        return max(map(abs, ends))

    command = [bench.sagefe, "run", f"{stem}.sage.toml", "--json", "-q", "-o", "out", *bench.threads()]
    return Case("braced cut", element, f"{size:g} m", 9, OWN, "mesh", Job(("braced cut", element, size), command, find))


def moment(bench):
    cases = [moment_case(bench, element, words, size) for element, words, sizes in WALL for size in sizes]
    rows = compute(bench, cases, lambda case: MOMENT)
    must_come_near(bench, "moment", rows)
    return table(bench, "moment", MOMENT_TITLE, MOMENT_NOTE, "`sagefe run --threads N`.", rows)


# ------------------------------------------------------------------------------------------------- specimens of the chapter

SPECIMEN = [
    ("quad4 full", ["--formulation", "1"]),
    ("quad4 b-bar", ["--formulation", "2"]),
    ("quad8 reduced", ["--element", "quad8", "--formulation", "1"]),
    ("quad8 full", ["--element", "quad8", "--formulation", "2"]),
    ("quad9", ["--element", "quad9", "--formulation", "1"]),
]
MESHES = {
    "4 x 4": ["--coarsen", "--refine", "2"],
    "8 x 8": ["--coarsen", "--refine", "3"],
    "16 x 16": ["--coarsen", "--refine", "4"],
    "14 x 28": [],
    "28 x 56": ["--refine", "1"],
}


def with_steps(deck, increments, tolerance):
    """The chapter's deck with other numbers on its only stage card: ten integers, two parts of gravity, the tolerance."""
    lines = deck.split("\n")
    at = next(k for k, line in enumerate(lines) if line.startswith("* incr")) + 1
    integers = lines[at].ljust(50)[5:50]
    lines[at] = f"{increments:5d}{integers}{0.0:10.1f}{0.0:10.1f}{tolerance:10.1e}" if tolerance else f"{increments:5d}{integers}"
    return "\n".join(lines)


def specimen_case(bench, name, strains, varied, element, mesh, increments, tolerance=OWN):
    options = [*next(o for e, o in SPECIMEN if e == element), *MESHES[mesh]]
    stem = re.sub(r"\W+", "_", f"{name}_{element}_{mesh}_{increments}_{tolerance:g}")
    with open(chapter_deck(name)) as deck:
        (bench.folder / f"{stem}.dat").write_text(with_steps(deck.read(), increments, tolerance))

    def find(_):
        with open(bench.folder / "out" / f"{stem}.report1.csv") as report:
            rows = list(csv.DictReader(row for row in report if not row.startswith("#")))
        ratios = {round(float(row["axial_strain[-]"]), 6): float(row["ratio[-]"]) for row in rows}
        return {strain: ratios[strain] for strain in strains}

    command = [bench.sagefe, "run", "-o", "out", f"{stem}.dat", *bench.threads(), *options]
    return Case(name, element, mesh, increments, tolerance, varied, Job((name, element, mesh, increments, tolerance), command, find))


def specimen_cases(bench, name, strains, increments, others):
    cases = []
    for element, _ in SPECIMEN:
        cases += [specimen_case(bench, name, strains, "mesh", element, mesh, increments) for mesh in MESHES]
    for element in ("quad4 b-bar", "quad8 reduced"):
        cases += [specimen_case(bench, name, strains, "increments", element, "14 x 28", k) for k in others]
        cases += [specimen_case(bench, name, strains, "tolerance", element, "14 x 28", increments, t) for t in (1e-2, 1e-3, 1e-4, 1e-6)]
    return cases


# Converged values of this program; how is said in docs/theory/accuracy.md, "Histories".
RATIO = {0.025: 1.010135, 0.05: 0.99500, 0.1: 1.03678, 0.15: 1.05399}
HISTORY = {0.025: 1.010135, 0.05: 1.016906, 0.075: 1.022150, 0.1: 1.026410}
SPECIMEN_OPTIONS = "`sagefe run --element ... --formulation ... [--coarsen] --refine k --threads N`."


def specimen_note(deck, strains, values, known, source=""):
    """strains: in percent, the last one that of the value.  values: with all their digits.  known: their error."""
    return (
        f"The deck is `{deck}` with other elements, meshes, increments and tolerances.\n\n"
        f"- *value* is the ratio of the measured to the correct deviator stress at an axial strain of {strains[-1]} %.{source}\n"
        f"- *error* is the largest of the four relative errors of this ratio at {', '.join(strains[:-1])} and {strains[-1]} %. The converged ratios at these strains are {', '.join(values)}, known to {known} ([accuracy](theory/accuracy.md)).\n"
        "- *mesh* is the number of elements along the radius x along half the height."
    )


RATIO_TITLE = "Error against run time: Drucker-Prager specimen to 15 %"
RATIO_NOTE = specimen_note(
    "dp_285", ("2.5", "5", "10", "15"), [f"{v:.5f}" for v in RATIO.values()], "5e-5",
    " The source chapter of these decks has the value 1.167, which is that of the row quad4 full, 14 x 28.",
)
HISTORY_TITLE = "Error against run time: elastic specimen on an interface"
HISTORY_NOTE = specimen_note("friction_285_nu0495", ("2.5", "5", "7.5", "10"), [f"{v:.6f}" for v in HISTORY.values()], "3e-6")


def ratio(bench):
    cases = specimen_cases(bench, "dp_285", RATIO, 60, (12, 24, 120, 240))
    rows = compute(bench, cases, lambda case: RATIO)
    return table(bench, "ratio", RATIO_TITLE, RATIO_NOTE, SPECIMEN_OPTIONS, rows)


def history(bench):
    cases = specimen_cases(bench, "friction_285_nu0495", HISTORY, 40, (4, 8, 12, 20, 80, 160))
    rows = compute(bench, cases, lambda case: HISTORY)
    return table(bench, "history", HISTORY_TITLE, HISTORY_NOTE, SPECIMEN_OPTIONS, rows)
