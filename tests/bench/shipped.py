"""Shipped decks as users run them: what is asked for, and what the program leaves out."""
import re
import subprocess

from measure import Job, Table, ms

from specimen import ROOT

GOALS = {
    "pinned_ld2_nu025": "",
    "pinned_ld2_nu0495_graded": "50 ms at an error of 1e-4",
    "pinned_ld2_nu0495_accurate": "500 ms at an error of 1e-6",
    "friction_285_nu0495": "30 ms",
    "dp_285": "100 ms",
}


def chapter_deck(name):
    return str(ROOT / "legacy_inputs/chapter7" / name / "deck.dat")


def run_job(bench, labels, deck, *options):
    return Job(labels, [bench.sagefe, "run", "-o", "out", deck, *options], lambda text: text)


def goals(bench):
    decks = list(GOALS)[:1] if bench.args.quick else GOALS
    jobs = [run_job(bench, (name,), chapter_deck(name)) for name in decks]
    records = bench.turns(jobs, 2 * bench.args.runs + 1, strict=True)
    rows = []
    for name in decks:
        r = records[(name,)]
        rows.append([name, f"{ms(r.wall)} ({ms(min(r.walls))}-{ms(max(r.walls))})", ms(r.cpu), GOALS[name]])
    note = "Runs as users make them, with all that a run writes; `sagefe` takes as many threads as it wants."
    return {"goals": Table("What is asked for", note, "none.", ["deck", "wall ms, median (min-max)", "processor ms", "asked, wall"], rows)}


def skip_row(deck, name, record, full):
    work = re.search(r"work\s+(.*)", record.text).group(1)
    left = re.search(r"left out\s+(.*)", record.text)
    counts = re.sub(r" [\d.e+-]+ s(?=,|$)", "", work)
    return [deck, name or "(nothing off)", ms(record.wall), f"{record.wall / full:.2f}", counts, left.group(1) if left else "-"]


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
    note = "The results are the same, as `test_analysis` proves. Ratio: time over that with nothing switched off."
    return {"skips": Table("What is left out", note, "`--without NAME`.", ["deck", "switched off", "wall ms", "ratio", "work", "left out"], rows)}
