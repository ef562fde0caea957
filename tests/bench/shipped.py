"""Shipped decks as users run them: the goals for their time, and the effect of each optimisation."""
import csv
import re
import subprocess

import scenes
from measure import Job, Table, markdown, ms

from specimen import ROOT

# Of each deck the goal, and the scene with the reference of its ratio where the goal has an error.
GOALS = {
    "pinned_ld2_nu025": ("none", None),
    "pinned_ld2_nu0495_graded": ("50 ms at an error of 1e-4", "pinned_ld2_nu495"),
    "pinned_ld2_nu0495_accurate": ("500 ms at an error of 1e-6", "pinned_ld2_nu495"),
    "friction_285_nu0495": ("30 ms", None),
    "dp_285": ("100 ms", None),
}
WHAT_DECKS_ARE = (
    "Some tables use decks of [`legacy_inputs/chapter7`](../legacy_inputs/chapter7/README.md). Each is a quarter of a triaxial specimen whose length is twice its diameter. *to 10 %* is the axial strain at the end:"
)


def decks():
    rows = [
        ["`pinned_ld2_nu025`", "the specimen of the problem `pinned_ld2_nu25` with 14 x 28 quad4 full, to 10 % in 10 increments"],
        ["`pinned_ld2_nu0495_graded`", "the specimen of the problem `pinned_ld2_nu495` with 10 graded quadrilaterals of degree 4, to 10 % in 10 increments"],
        ["`pinned_ld2_nu0495_accurate`", "the same with 14 graded quadrilaterals of degree 8"],
        ["`friction_285_nu0495`", "elastic specimen with nu = .495 under a rigid platen on a hyperbolic interface (friction angle 28.5 degrees), 14 x 28 quad4 full and 14 interface elements, to 10 % in 40 increments"],
        ["`dp_285`", "Drucker-Prager specimen on the same interface, 14 x 28 quad4 full, to 15 % in 60 increments"],
    ]
    return markdown(["deck", "content"], rows)


def chapter_deck(name):
    return str(ROOT / "legacy_inputs/chapter7" / name / "deck.dat")


def run_job(bench, labels, deck, *options):
    return Job(labels, [bench.sagefe, "run", "-o", "out", deck, *options], lambda text: text)


GOALS_TITLE = "Performance goals"
GOALS_NOTE = (
    "The table has runs of decks as users start them, with all output that a run writes by default. sagefe chooses the number of threads. The goals are upper limits of the wall time. "
    "If a goal refers to an error, it is the error of the ratio at the end of the run."
)
GOALS_OPTIONS = "`sagefe run DECK`."
GOALS_HEAD = ["deck", "wall ms, median (min-max)", "processor ms", "error of the ratio", "goal", "reached"]


def error_of(bench, name, scene):
    """Of the ratio in the last row of the report of a deck that has been run."""
    if scene is None:
        return ""
    file = next((bench.folder / "out").glob(f"{name}.report1.csv"))
    with open(file) as report:
        rows = list(csv.DictReader(row for row in report if not row.startswith("#")))
    reference = next(one.reference for one in scenes.scenes() if one.name == scene)
    return f"{abs(float(rows[-1]['ratio[-]']) / reference - 1):.1e}"


def reached(goal, wall, error):
    """yes, no, or empty without a goal; of `50 ms at an error of 1e-4` both parts count."""
    limit = re.match(r"(\d+) ms(?: at an error of (\S+))?", goal)
    if not limit:
        return ""
    return "yes" if 1e3 * wall <= float(limit.group(1)) and (not limit.group(2) or float(error) <= float(limit.group(2))) else "no"


def goals(bench):
    names = list(GOALS)[:2] if bench.args.quick else GOALS
    runs = 2 * bench.args.runs + 1
    jobs = [run_job(bench, (name,), chapter_deck(name)) for name in names]
    records = bench.turns(jobs, runs, strict=True)
    rows = []
    for name in names:
        r, (goal, scene) = records[(name,)], GOALS[name]
        rows.append([name, f"{ms(r.wall)} ({ms(min(r.walls))}-{ms(max(r.walls))})", ms(r.cpu), error_of(bench, name, scene), goal])
        rows[-1].append(reached(goal, r.wall, rows[-1][3]))
    return {"goals": Table(GOALS_TITLE, GOALS_NOTE, GOALS_OPTIONS, GOALS_HEAD, rows, runs)}


def skip_row(deck, name, record, full):
    work = re.search(r"work\s+(.*)", record.text).group(1)
    left = re.search(r"left out\s+(.*)", record.text)
    counts = re.sub(r" [\d.e+-]+ s(?=,|$)", "", work)
    return [deck, name or NOTHING_OFF, ms(record.wall), f"{record.wall / full:.2f}", counts, left.group(1) if left else "-"]


NOTHING_OFF = "(none)"
SKIPS_TITLE = "Effect of each optimisation"
SKIPS_NOTE = (
    "The option `--without NAME` switches one optimisation off, and `--without all` switches off all of them. "
    "[The analysis](theory/analysis.md#skips) describes each name, and how closely results with and without the optimisation agree. The ratio is the wall time divided by that of the run with all optimisations.\n"
    "\n"
    "The last two columns repeat lines that `sagefe run -v` prints:\n"
    "\n"
    "- An *assembly* computes stiffness and internal forces, a *force pass* only the forces.\n"
    "- *Equations condensed* are eliminated once per stage.\n"
    "- *Steps by the border of a condensed region* are increments that solve only for the retained dofs of the region.\n"
    "- *Elements by K u* compute internal forces from the stiffness matrix, without an evaluation of the law.\n"
    "- *Solves with kept factors* use the factors of an earlier matrix, and *increments repeated* use the solution of the previous increment."
)
SKIPS_OPTIONS = "`sagefe run DECK -v --without NAME`."
SKIPS_HEAD = ["deck", "switched off", "wall ms", "ratio", "work", "omitted work"]

def skips(bench):
    text = subprocess.run([bench.sagefe, "run", "--help"], capture_output=True, text=True, check=True).stdout
    names = re.search(r"one of: (all, factors[\w, ]+\w)", " ".join(text.split())).group(1).split(", ")
    names[-1] = names[-1].split()[0]
    names.sort(key=lambda name: name == "all")
    rows = []
    decks = ("friction_285_nu0495", "dp_285", "pinned_ld2_nu025")
    for deck in decks[-1:] if bench.args.quick else decks:
        jobs = [run_job(bench, (deck, name), chapter_deck(deck), "-v", *(["--without", name] if name else [])) for name in ["", *names]]
        records = bench.turns(jobs, strict=True)
        full = records[(deck, "")].wall
        rows += [skip_row(deck, name, records[(deck, name)], full) for name in ["", *names]]
    return {"skips": Table(SKIPS_TITLE, SKIPS_NOTE, SKIPS_OPTIONS, SKIPS_HEAD, rows)}
