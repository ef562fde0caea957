"""The program without skips: it holds nothing of sage/analysis/skips, runs as the whole program with its skips switched off, to the
last byte, and gives the whole program's answers.

    plain_program.py SAGEFE SAGEFE_PLAIN SOURCE_FOLDER
"""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

SAGEFE, PLAIN, SOURCE = sys.argv[1:4]
# One deck for each kind of work that a skip leaves out.  Tolerance: against the whole program, of a column's largest number;
# what Newton's tolerance of 1e-8 leaves, times the steps.
DECKS = {
    "chapter7/pinned_ld1_nu0333": 1e-9,
    "chapter7/friction_285_nu0333": 1e-6,
    "hyperbolic/triaxial": 1e-6,
    "seepage/dam": 1e-9,
    "slopes/one_to_one": 1e-6,
    "structures/anchored_sheet_pile": 1e-6,
}


def check(holds, text):
    if not holds:
        sys.exit(f"plain_program.py: {text}")


def symbols(program):
    return subprocess.run(["nm", "-C", program], check=True, capture_output=True, text=True).stdout


def check_symbols():
    classes = set()
    for header in pathlib.Path(SOURCE, "sage/analysis/skips").glob("*.hpp"):
        classes |= set(re.findall(r"^class (\w+)[^;]*\{", header.read_text(), re.M))
    check(len(classes) >= 3, "no classes in sage/analysis/skips")
    whole, plain = symbols(SAGEFE), symbols(PLAIN)
    for program, wanted in ((whole, True), (plain, False)):
        check(("FrontalWithRepeats" in program) == wanted, "the solver with repeats is in the wrong program")
    found = [c for c in classes if f"sage::{c}::" in plain or f"for sage::{c}\n" in plain]
    check(not found, f"the plain program holds {', '.join(found)}")
    held = [c for c in classes if f"sage::{c}::" in whole or f"for sage::{c}\n" in whole]
    check(2 * len(held) >= len(classes), f"the whole program seems to hold {held} alone: is the search at fault?")


def results(program, deck, folder, *options):
    """Of the run: bytes of all CSV files, by name."""
    subprocess.run([program, "run", f"{SOURCE}/legacy_inputs/{deck}/deck.dat", "-o", folder, "--nodes", "--points", "--digits",
                    "17", *options], check=True, capture_output=True)
    files = {f.name: f.read_bytes() for f in sorted(pathlib.Path(folder).glob("*.csv"))}
    check(files, f"{deck}: no CSV files")
    return files


def columns(text):
    """Numbers of a table, by place of the column; cells that are none are left out."""
    table = {}
    for row in csv.reader(text.decode().splitlines()):
        for place, cell in enumerate(row):
            try:
                number = float(cell)
            except ValueError:
                continue
            table.setdefault(place, []).append(number)
    return table


def check_near(deck, name, a, b, tolerance):
    a, b = columns(a), columns(b)
    check(a.keys() == b.keys(), f"{deck}: {name} has other columns")
    largest = max((abs(x) for column in b.values() for x in column), default=0.0)
    for place in a:
        check(len(a[place]) == len(b[place]), f"{deck}: {name} has other rows")
        size = max(abs(x) for x in b[place])
        off = max(abs(x - y) for x, y in zip(a[place], b[place]))
        rounding = 1e-12 * largest  # a column may be zero but for it
        check(off <= tolerance * size + rounding, f"{deck}: {name}, column {place + 1} is off by {off:.3g} of {size:.3g}")


def main():
    check_symbols()
    with tempfile.TemporaryDirectory() as scratch:
        for i, (deck, tolerance) in enumerate(DECKS.items()):
            plain = results(PLAIN, deck, f"{scratch}/{i}p")
            off = results(SAGEFE, deck, f"{scratch}/{i}o", "--without", "all")
            for name, text in plain.items():
                check(text == off.get(name), f"{deck}: {name} is not that of the whole program with its skips switched off")
            whole = results(SAGEFE, deck, f"{scratch}/{i}w")
            for name, text in plain.items():
                if "increments" not in name:
                    check_near(deck, name, text, whole[name], tolerance)


main()
