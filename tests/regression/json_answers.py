"""Answers of sagefe --json: every command's document against docs/schema/sagefe.schema.json, and its numbers against
those of the files that the same run wrote.  usage: json_answers.py SAGEFE SOURCE_FOLDER [PLUGIN].  Exit code 77: no
jsonschema.  COARSER in the environment: without the same command in plain words, for a program that sanitizers slow
down."""
import csv
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

SAGEFE, SOURCE = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
CASES = SOURCE / "legacy_inputs/chapter7"
DECK = str(CASES / "pinned_ld2_nu0333/deck.dat")
OTHER = str(CASES / "pinned_ld2_nu025/deck.dat")
COARSER = "COARSER" in os.environ
failures = []


def expect(condition, *words):
    if not condition:
        failures.append(" ".join(str(word) for word in words))
        print("FAILED:", failures[-1])


def strict(schema):
    """Members that the schema doesn't name are errors of the test, though not of the schema."""
    if isinstance(schema, list):
        return [strict(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    tight = {key: strict(value) for key, value in schema.items()}
    if tight.get("type") == "object" and "properties" in tight and "required" in tight:
        tight.setdefault("additionalProperties", False)
    return tight


SCHEMA = json.loads((SOURCE / "docs/schema/sagefe.schema.json").read_text())
Draft202012Validator.check_schema(SCHEMA)
STRICT = Draft202012Validator(strict(SCHEMA))


asked = set()  # commands that gave an answer


def answer(folder, *arguments, code=0, between=lambda: None):
    """The document of a command; its exit code is that of the command without --json, and every error on standard
    error is one of its messages."""
    plain_code = code
    if not COARSER:
        plain_code = subprocess.run([SAGEFE, *arguments], cwd=folder, capture_output=True).returncode
        between()
    run = subprocess.run([SAGEFE, *arguments, "--json"], cwd=folder, capture_output=True)
    asked.add(arguments[0])
    name = " ".join(arguments)
    expect(run.returncode == plain_code == code, name, "exit code", run.returncode, plain_code)
    expect(b"\033" not in run.stdout + run.stderr, name, "control characters")
    document = json.loads(run.stdout)
    for error in STRICT.iter_errors(document):
        expect(False, name, error.json_path, error.message[:300])
    expect(document["exit_code"] == code, name, "says", document["exit_code"])
    expect(document["command"] == arguments[0], name, "says", document["command"])
    shown = re.findall(r"\[(S[0-9]{3})\]", run.stderr.decode())
    kept = [one["code"] for one in document["messages"]]
    expect(set(shown) <= set(kept), name, "messages with the codes", shown, "in the document", kept)
    expect(code == 0 or "error" in [one["severity"] for one in document["messages"]] or arguments[0] in ("verify", "conform", "drive"),
           name, "fails without a message")
    for missing in document["not_finite"]:
        value = document
        for part in missing["at"].split("/")[1:]:
            value = value[int(part) if isinstance(value, list) else part.replace("~1", "/").replace("~0", "~")]
        expect(value is None, name, missing)
    return document


def same_as_csv(folder, report, file):
    """Values of a report, at the digits that its file has."""
    rows = [row for row in csv.reader(line for line in open(folder / file) if not line.startswith("#"))][1:]
    expect(len(rows) == len(report["rows"]) > 0, file, "rows", len(rows), len(report["rows"]))
    for cells, row in zip(rows, report["rows"]):
        expect([int(cells[0]), int(cells[1])] == [row["stage"], row["increment"]], file, cells[:2])
        for cell, value in zip(cells[2:], row["values"]):
            same = value is None if cell == "" else math.isclose(float(cell), value, rel_tol=6e-10, abs_tol=1e-300)
            expect(same, file, cell, value)


def check_run(folder):
    document = answer(folder, "run", DECK, "-o", "out")
    deck = document["result"]["decks"][0]
    expect(deck["status"] == "completed" and document["status"] == "ok", "status", deck["status"])
    same_as_csv(folder, deck["reports"][0], "out/pinned_ld2_nu0333.report1.csv")
    expect(abs(deck["reports"][0]["rows"][-1]["values"][-1] - 1.03440) < 5e-6, "ratio of the chapter")
    listing = (folder / "out/pinned_ld2_nu0333.lst").read_text()
    for number in (deck["model"]["elements"], deck["equations"]):
        expect(f" {number} " in listing, "the listing has no", number)
    for file in deck["files"]:
        expect((folder / file).exists(), file)
    for case in ("seepage/sheet_pile", "hyperbolic/strip_footing"):
        other = answer(folder, "run", str(SOURCE / "legacy_inputs" / case / "deck.dat"), "-o", "out")["result"]["decks"][0]
        for number, report in enumerate(other["reports"], 1):
            same_as_csv(folder, report, f"out/{case.split('/')[1]}.report{number}.csv")
    beside = answer(folder, "run", DECK, OTHER, "-j", "2", "-o", "out")["result"]["decks"]
    expect([one["deck"] for one in beside] == [DECK, OTHER], "order of decks")
    expect(beside[0]["reports"] == deck["reports"], "in a process of its own the same numbers")
    climbed = answer(folder, "run", DECK, "--converge", "1e-4", "-o", "out")["result"]["decks"][0]
    expect(climbed["convergence"]["reached"], "convergence")


def check_failures(folder):
    text = pathlib.Path(DECK).read_text().splitlines()
    (folder / "cut.dat").write_text("\n".join(text[:12]) + "\n")
    refused = answer(folder, "check", "cut.dat", code=2)
    message = next(one for one in refused["messages"] if one["severity"] == "error")
    expect(message["where"] == "cut.dat" and message["line"] == 12, message)
    expect(refused["result"]["decks"][0]["ready"] is False, "a deck that was refused")
    answer(folder, "run", "cut.dat", "none.dat", "-o", "out", code=2)
    weak = answer(folder, "run", "weak.dat", "-o", "out", code=3)
    deck = weak["result"]["decks"][0]
    expect(weak["status"] == "not_converged" and deck["status"] == "singular", deck["status"])
    expect(abs(deck["failed_at"]["load_factor"] - 2 / 3) < 1e-3, "load factor", deck["failed_at"])
    expect(any(deck["reason"] == one["message"] for one in weak["messages"]), "the reason is a message")
    expect(answer(folder, "run", "--nonsense", code=1)["messages"], "a message about the command line")
    answer(folder, "nonsense", code=1)
    answer(folder, "run", code=1)
    answer(folder, "run", DECK, "--plugin", "none.so", code=1)
    answer(folder, "run", DECK, "--umat", "none.so", code=1)
    answer(folder, "run", DECK, "--quiet", "--verbose", code=1)
    answer(folder, "run", DECK, "--picture", "nonsense", "-o", "out", code=1)
    answer(folder, "plot", "none.h5", "--picture", "conf", code=2)
    answer(folder, "run", "weak.dat", DECK, "-j", "2", "-o", "out", code=3)
    answer(folder, "run", DECK, "-o", "cut.dat", code=4)
    with open("/dev/full", "w") as full:
        run = subprocess.run([SAGEFE, "list", "solvers", "--json"], stdout=full, stderr=subprocess.PIPE)
    expect(run.returncode == 4, "standard output that can't be written", run.returncode)


def check_others(folder):
    for what in ("elements", "materials", "solvers", "fields", "decks"):
        expect(len(answer(folder, "list", what)["result"][what]) >= 3, what)
    cards = answer(folder, "echo", DECK)["result"]["cards"]
    line = pathlib.Path(DECK).read_text().splitlines()
    for card in cards:
        for field in card["fields"]:
            if isinstance(field["value"], (int, float)) and field["last_column"] <= len(line[field["line"] - 1]):
                text = line[field["line"] - 1][field["first_column"] - 1:field["last_column"]].strip()
                expect(float(text.upper().replace("D", "E")) == field["value"], "echo", card["card"], text, field)
    answer(folder, "echo", DECK, "--names")
    answer(folder, "convert", DECK, "copy.dat")
    answer(folder, "layout", "guess", DECK)
    answer(folder, "layout", "guess", DECK, "-o", "guessed.toml")
    answer(folder, "layout", "check", "sage1", DECK)
    book = answer(folder, "verify", "--only", "nosuchcase", code=1)["messages"][0]["message"]
    expect("no case matches" in book, book)
    # A case that takes minutes needs its whole name.
    book = answer(folder, "verify", "--only", "strip_fine", code=1)["messages"][0]["message"]
    expect("no case matches" in book, book)
    cases = answer(folder, "verify", "--only", "lame.two_rings")["result"]
    expect(cases["row_count"] == sum(len(one["rows"]) for one in cases["cases"]) > 0, "rows of cases")
    answer(folder, "verify", "--list")
    answer(folder, "stress", "--only", "units")
    answer(folder, "stress", "--list")
    answer(folder, "figures", "--list")
    answer(folder, "figures", "--only", "7.1", "-o", "figures")
    tables = answer(folder, "tables", "--pinned", "-o", "out")["result"]["entries"]
    expect(all(abs(one["computed"] - one["chapter"]) < 6e-5 for one in tables), "Table 7.3")
    answer(folder, "run", DECK, "-o", "out")
    for file in answer(folder, "plot", "out/pinned_ld2_nu0333.report1.csv")["result"]["files"]:
        expect((folder / file).exists(), file)
    slope = SOURCE / "legacy_inputs/slopes/taylor_60/deck.dat"
    safety = answer(folder, "safety", str(slope), "--tolerance", ".05", "-o", "out")["result"]
    expect(safety["complete"] and safety["lower"] < safety["upper"] <= safety["lower"] + 0.05, "bracket", safety["lower"])
    expect(all((folder / file).exists() for file in safety["files"]), "files of a safety factor")
    answer(folder, "safety", DECK, "-o", "out", code=2)
    gentle = SOURCE / "legacy_inputs/slopes/griffiths_lane/deck.dat"  # its foot is on the left
    kh = answer(folder, "safety", str(gentle), "--critical-kh", "left", "--tolerance", ".1", "-o", "out")["result"]
    expect(kh["complete"] and 0 <= kh["lower"] < kh["upper"] <= kh["lower"] + 0.101, "critical k_h", kh)
    bounds = answer(folder, "bounds", str(slope), "--elements", "300", "-o", "out")["result"]
    expect(bounds["lower"]["value"] <= bounds["upper"]["value"] <= 1.1 * bounds["lower"]["value"], "bounds", bounds)
    pushed = SOURCE / "legacy_inputs/smith_griffiths/p63.dat"  # a footing that is moved
    refused = answer(folder, "bounds", str(pushed), "--layout", "sg_p63", "--of", "strength", "-o", "out", code=2)["messages"]
    expect([one["code"] for one in refused if one["severity"] == "error"] == ["S616"], "factor of a movement", refused)
    if not COARSER:
        check_safety_beside_bounds(folder)
    answer(folder, "run", DECK, "-o", "out", "--result")
    page = answer(folder, "report", "out/pinned_ld2_nu0333.h5")["result"]
    expect([file for file in page["files"] if file.endswith(".html") and (folder / file).exists()], "page of a run", page)
    (folder / "study.toml").write_text(f'deck = "{SOURCE / "legacy_inputs/chapter7/pinned_ld2_nu0333/deck.dat"}"\ncollect = ["report1.ratio"]\n'
                                       '[grid]\nmaterial.1.nu = [0.2, 0.3]\n[failure]\nwhen = "report1.ratio > 1.02"\n')
    swept = answer(folder, "sweep", "study.toml", "-o", "out")["result"]
    expect((swept["cases"], swept["kept"], swept["failures"]) == (2, 0 if COARSER else 2, 0), "cases of a sweep", swept)
    expect(all((folder / file).exists() for file in swept["files"]), "files of a sweep")
    driven = answer(folder, "drive", "--law", "linear_elastic", "--set", "E=1000", "--set", "nu=.25", "--test", "oedometer",
                    "--to", ".01", "--steps", "4", "--csv", "c.csv")["result"]
    curve = driven["curves"][0]
    place = [column["name"] for column in curve["columns"]].index("stress_yy")
    expect(len(curve["rows"]) == len(curve["status"]) == 5 and curve["failure"] is None, "rows of a driven law")
    expect(abs(curve["rows"][-1][place] - 12.0) < 1e-9 and driven["files"] == ["c.csv"], "oedometer", curve["rows"][-1])
    for option in ("--plugin", "--umat"):  # a library that can't be loaded: the document says so
        refused = answer(folder, "run", DECK, option, "none.so", code=1)["messages"]
        expect("none.so" in refused[0]["message"] and refused[0]["code"][:2] == "S8", option, refused)
    both = answer(folder, "compare", DECK, "--both", "-o", "out")["result"]
    expect(both["comparison"]["answers"] and both["a"]["reports"], "comparison")


def check_safety_beside_bounds(folder):
    # psi = 0: two rows of finite elements.  Bounds of another program on p64: 1.5786 and 1.6034.
    book = str(SOURCE / "legacy_inputs/smith_griffiths/p64.dat")
    bounds = answer(folder, "bounds", book, "--layout", "sg_p64", "--safety", "--elements", "0", "--tolerance", ".04", "-o", "out")
    bounds = bounds["result"]
    expect(1.55 < bounds["lower"]["value"] < 1.5865 and 1.5786 < bounds["upper"]["value"] < 1.6034 * 1.01, "p64", bounds)
    associated, own = bounds["finite_elements"]
    expect(associated["associated"] and not own["associated"], "rows", associated, own)
    expect(associated["upper"] > bounds["lower"]["value"] and associated["lower"] < 1.025 * bounds["upper"]["value"], associated)
    expect(own["lower"] <= associated["upper"] and not own["incomplete"], own)
    rows = [row for row in csv.reader(open(folder / "out/p64.bounds.safety.csv"))]
    expect([row[0] for row in rows[1:]] == ["bounds, psi = phi"] + [one["answer"] for one in (associated, own)], rows)
    answer(folder, "bounds", book, "--layout", "sg_p64", "--safety", "--of", "load", code=1)


def check_points_without_answer(folder, law):
    """Blank cells with their reason, and a law of a deck that has no stages."""
    (folder / "beyond.csv").write_text("stress_xx, stress_yy, stress_zz, steps\n100, 500, 100, 10\n")
    beyond = answer(folder, *law, "--path", "beyond.csv", "--pressure", "100", code=3)
    expect([one["code"] for one in beyond["messages"]] == ["S607"], "a stress beyond the strength", beyond["messages"])
    expect("largest stress" in beyond["result"]["curves"][0]["failure"], "its reason", beyond["result"]["curves"][0]["failure"])
    cards = (SOURCE / "legacy_inputs/triaxial/dilating_near_incompressible/deck.dat").read_text().splitlines()
    report = next(i for i, card in enumerate(cards) if card.endswith("100.") and card.startswith("    1    1    3"))
    cards[report] = cards[report][:-4] + "-90."
    (folder / "torn.dat").write_text("\n".join(cards) + "\n")
    torn = answer(folder, "run", "torn.dat", "-o", "out")
    report = torn["result"]["decks"][0]["reports"][0]
    expect("S530" in [one["code"] for one in torn["messages"]] and "[S530]" in report["messages"][0], "blank", torn["messages"])
    expect(all(row["values"][3] is None and row["values"][6] is None for row in report["rows"]), "cells", report["rows"][-1])
    for file in ("torn.report1.csv", "torn.lst"):
        expect("[S530]" in (folder / "out" / file).read_text(), "S530 in", file)
    stage = cards.index("Compression to 5 %")
    control = cards[2][:45] + "    0    0" + cards[2][55:]
    (folder / "bare.dat").write_text("\n".join(cards[:2] + [control] + cards[3:stage] + ["END"]) + "\n")
    bare = answer(folder, "drive", "--deck", "bare.dat", "--test", "triaxial_compression", "--pressure", "100", "--to", ".05")
    curve = bare["result"]["curves"][0]
    place = [column["name"] for column in curve["columns"]].index("axial_deviator")
    expect(abs(curve["rows"][-1][place] - 531.12698) < 1e-4, "law of a deck without stages", curve["rows"][-1])


def check_small_commands(folder, plugin):
    clean = lambda name: lambda: shutil.rmtree(folder / name)
    every = answer(folder, "explain")["result"]["codes"]
    lines = subprocess.run([SAGEFE, "explain"], capture_output=True, text=True).stdout.splitlines()
    expect([f"{one['code']}  {one['title']}" for one in every] == lines[:-1], "explain lists")
    one = answer(folder, "explain", "S501")["result"]["codes"]
    expect(one == [entry for entry in every if entry["code"] == "S501"] and one, "explain S501", one)
    expect(answer(folder, "explain", "--search", "interface")["result"]["codes"], "explain --search")
    answer(folder, "explain", "S999", code=1)
    for shell in ("bash", "zsh", "fish"):
        script = subprocess.run([SAGEFE, "completion", shell], capture_output=True, text=True).stdout
        expect(answer(folder, "completion", shell)["result"] == {"shell": shell, "script": script}, "completion", shell)
    for kind in ("law", "element", "umat"):
        files = answer(folder, "new", kind, "mine", between=clean("mine"))["result"]["files"]
        expect(sorted(files) == sorted(str(file.relative_to(folder)) for file in (folder / "mine").iterdir()), "new", files)
        answer(folder, "new", kind, "mine", code=1)
        shutil.rmtree(folder / "mine")
    answer(folder, "new", "law", "No Name", code=1)
    expect(answer(folder, "new", "deck", "slope", between=(folder / "slope.dat").unlink)["result"]["files"] == ["slope.dat"], "new deck")
    answer(folder, "new", "deck", "slope", code=1)
    moved = (folder / "slope.dat").read_text().replace("\n    1   31    1    1    1", "\n     1   31    1    1    1")
    (folder / "moved.dat").write_text(moved)
    aligned = answer(folder, "align", "moved.dat", between=(folder / "moved_aligned.dat").unlink)["result"]
    expect([one["card"] for one in aligned["moves"]] == ["fixity card"], "align", aligned)
    expect(aligned["files"] == ["moved_aligned.dat"], "align", aligned)
    expect((folder / "moved_aligned.dat").read_text() == (folder / "slope.dat").read_text(), "align", "text")
    tests = answer(folder, "drive", "--list")["result"]["tests"]
    expect(len(tests) > 5, "drive --list", tests)
    law = ["drive", "--law", "mohr_coulomb", "--set", "E=2e4", "--set", "nu=.3", "--set", "c=5", "--set", "phi=30"]
    curve = answer(folder, *law, "--test", "triaxial_compression", "--pressure", "100", "--to", ".05", "--csv", "mc.csv")["result"]
    table = [row for row in csv.reader(line for line in open(folder / "mc.csv") if not line.startswith("#"))]
    columns = curve["curves"][0]["columns"]
    names = [f"{one['name']}[{one['unit']}]" if one["unit"] else one["name"] for one in columns]
    expect(curve["files"] == ["mc.csv"] and len(curve["curves"][0]["rows"]) == len(table) - 1 > 10, "rows of drive")
    for at, name in enumerate(names):
        title = next((i for i, cell in enumerate(table[0]) if cell.split("[")[0] == name.split("[")[0]), None)
        expect(title is not None, name, table[0])
        for row, values in zip(table[1:], curve["curves"][0]["rows"]):
            value = values[at]
            expect(math.isclose(float(row[title]), value, rel_tol=6e-10, abs_tol=1e-12), name, row[title], value)
    answer(folder, *law, "--test", "nonsense", "--to", ".05", code=1)
    check_points_without_answer(folder, law)
    answer(folder, "drive", code=1)
    answer(folder, "conform", "none.so", code=1)
    answer(folder, "conform", code=1)
    if plugin:
        lines = answer(folder, "conform", plugin)["result"]["lines"]
        expect(lines[-1] == "verdict: conforms", "conform", lines[-3:])
        brought = answer(folder, "list", "plugins", "--plugin", plugin)["result"]["plugins"]
        expect([one["file"] for one in brought] == [plugin], "list plugins", brought)


def make_weak_deck(folder):
    """A Mohr-Coulomb element (c = 10, phi = 0) under 30 where its limit is 20."""
    card = lambda integers, reals=(): "".join(f"{i:>5}" for i in integers) + "".join(f"{r:>10}" for r in reals)
    lines = ["A column loaded beyond its strength", "m       kN      kPa",
             card([1, 0, 4, 0, 1, 1, 1, 2, 0, 1, 0]), card([1, "", ""], ["0.", "0."]), card([2, "", ""], ["1.", "0."]),
             card([3, "", ""], ["0.", "1."]), card([4, "", ""], ["1.", "1."]), card([1, 4, 4], [""]) + "clay",
             card([], ["10000.", ".3", "10.", "0."]), card([1, 1, "", 1]), card([1, 1, 1, 2, 4, 3]),
             card([1, 2, 1, 0, 1]), card([1, 3, 2, 1, 0]), "Pressure on the top",
             card([10, 0, 0, 0, 0, 0, 1, 0, 0, 0]), card([1, 3, "", ""], ["30.", "30."]), "END"]
    (folder / "weak.dat").write_text("\n".join(lines) + "\n")


with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    make_weak_deck(place)
    check_run(place)
    check_failures(place)
    check_others(place)
    check_small_commands(place, str(pathlib.Path(sys.argv[3]).resolve()) if "".join(sys.argv[3:]) else "")
    help_text = subprocess.run([SAGEFE, "--help"], capture_output=True, text=True).stdout.split("Subcommands:")[1]
    commands = set(re.findall(r"^  (\w+) {2,}\S", help_text, re.MULTILINE))
    expect(commands <= asked, "commands without an answer here:", commands - asked)
sys.exit(1 if failures else 0)
