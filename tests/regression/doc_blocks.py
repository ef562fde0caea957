#!/usr/bin/env python3
"""What pages show as commands does what they say.

    doc_blocks.py SAGEFE SOURCE             README.md and the tutorials
    doc_blocks.py SAGEFE SOURCE --manual    the manual, whose decks are those of MANUAL below
    doc_blocks.py SAGEFE SOURCE PAGE ...
        --python FOLDER   where the package sagefe of Python is; pages that need it are left out without
        --prefix FOLDER   where sagefe is installed; pages that build against it are left out without, and no others are run
        --quick           without commands that take many seconds under sanitizers

A block whose first line is ```KIND NAME is written to the file NAME, in tutorials and in WITH_FILES.  Every line of a code block that begins with a command is run, in the order of the page
and in a folder of its own beside the tree's decks; it must end with exit code 0.  Lines below a command that begins
with "$ " must be printed, in their order, numbers to 0.5 %; "..." stands for any lines, and at the end of a line for
its rest.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SAGEFE = pathlib.Path(sys.argv[1]).resolve()
SOURCE = pathlib.Path(sys.argv[2]).resolve()
WORDS = sys.argv[3:]


def take(option):
    """What follows an option, which is removed; None without it."""
    if option not in WORDS:
        return None
    at = WORDS.index(option)
    value = pathlib.Path(WORDS[at + 1]).resolve()
    del WORDS[at:at + 2]
    return value


PYTHON, PREFIX = take("--python"), take("--prefix")
PAGES = [pathlib.Path(name).resolve() for name in WORDS if not name.startswith("--")]
COMMANDS = ("sagefe", "sed", "scripts/", "cmake", "ctest", "cp", "cd", "man", "export", "python3")
# Commands that build or install: tests of their own run them (tests/install), or scripts/check_package.
ELSEWHERE = ("scripts/", "ctest", "man ", "export ") if PREFIX else ("scripts/", "cmake", "ctest", "man ", "export ")
WITH_FILES = {"structures"}  # pages of the manual whose named blocks are written too
NEED_PYTHON, NEED_PREFIX = {"python_sweep"}, {"own_law"}
DEAR = ("sagefe bounds slope",) if "--quick" in WORDS else ()
# Of a page of the manual: what it takes for granted, and words of its commands that stand for something.
CHAPTER = "legacy_inputs/chapter7"
# Two squares of soil with named sides, as a mesher writes them.
LAYER = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
5
1 1 "bottom"
1 2 "left"
1 3 "right"
1 4 "road"
2 5 "soil"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
7
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 2 2 1 4
4 1 2 3 3 3 6
5 1 2 4 4 5 6
6 3 2 5 1 1 2 5 4
7 3 2 5 1 2 3 6 5
$EndElements"""
MANUAL = {
    "accuracy": ([], {}),
    "compare": ([f"cp {CHAPTER}/pinned_ld2_nu0333/deck.dat A.dat", f"cp {CHAPTER}/pinned_ld2_nu0495/deck.dat B.dat"], {"DECK": "A.dat"}),
    "convert": (["sagefe new deck embankment -o IN", f"printf '%s\\n' '{LAYER}' > layer.msh"], {"OUT": "OUT.inp"}),
    "drive": (["sagefe new deck triaxial -o deck.dat"]
              + [f"sagefe drive --law mohr_coulomb --set E=2e4 --set nu=.3 --set c=10 --set phi=30 --test triaxial_compression --pressure {p} "
                 f"--to .05 --csv all.csv && printf 'strain_yy,axial_deviator\\n.002,40\\n.01,{2 * p + 34}\\n.03,{2 * p + 34}\\n' > cd{p}.csv"
                 for p in (50, 200)], {}),
    "figures": ([], {}),
    "json": (["sagefe new deck triaxial -o deck.dat"], {}),
    "layout_guess": (["cp legacy_inputs/stap/plate.dat old.dat"], {}),
    "plots": ([f"sagefe run {CHAPTER}/dp_285/deck.dat -o out -q", "sagefe new deck footing", "sagefe run footing.dat -o out -q", "mkdir triaxial",
               f"cp {CHAPTER}/dp_285/deck.dat triaxial/", f"cp {CHAPTER}/friction_285_nu0333/deck.dat a.dat",
               f"cp {CHAPTER}/friction_285_nu025/deck.dat b.dat", "sagefe run a.dat b.dat -o out -q --result --states 1:5 --states strain=.05,.1"], {}),
    "report": ([f"cp {CHAPTER}/friction_285_nu025/deck.dat deck.dat", "cp deck.dat full.dat", "cp deck.dat b_bar.dat",
                "sagefe run full.dat b_bar.dat -o out -q --result"], {}),
    "safety": (["sagefe new deck slope", "sagefe new deck excavation -o wall.dat"], {}),
    "stress": (["mkdir docs"], {}),
    "structures": ([], {}),
    "verify": (["mkdir docs"], {}),
}
# Commands of the manual that are not run here, and why.
NOT_HERE = {
    "sagefe stress ": "all rows: tests/stress; the page: scripts/pictures",
    "sagefe verify ": "all cases: tests/verification; the page: scripts/pictures",
    "sagefe safety slope.dat --converge": "minutes; tests/regression/safety_test.cpp converges a smaller deck",
    "sagefe drive --law clough_duncan ...": "an outline",
    "sagefe drive --law modified_cam_clay": "curves of the reader; tests/unit/drive fits several tests together",
    "sagefe check old.dat --layout ./old.toml": "the draft has to be finished by hand first; tests/unit/layout_draft",
}
HERE = ("--list", "--only lame", "--only poisson")  # of those all the same
failed = 0


def fail(page, line, *words):
    global failed
    failed += 1
    print(f"{page.relative_to(SOURCE)}:{line}:", *words)


def blocks(text):
    """(line of the first, lines, name of its file) of each fenced or indented block."""
    lines, begin, fenced, block, name = text.split("\n"), 0, False, [], ""
    for number, line in enumerate(lines + [""], 1):
        if line.startswith("```"):
            if fenced:
                yield begin, block, name
            fenced, begin, block, name = not fenced, number + 1, [], line.partition(" ")[2]
        elif fenced:
            block.append(line)
        elif line.startswith("    ") and (block or not lines[number - 2].strip()):
            begin = begin if block else number
            block.append(line[4:])
        elif block:
            yield begin, block, ""
            block = []


def is_command(line):
    return line.startswith("$ ") or line.startswith(COMMANDS)


def is_same(wanted, printed):
    """A word, or a number but for what rounding on another machine makes of a collapse load."""
    try:
        return abs(float(wanted) - float(printed)) <= 5e-3 * abs(float(wanted))
    except ValueError:
        return wanted == printed


def matches(wanted, printed):
    rest = wanted.endswith("...")
    words, found = wanted.removesuffix("...").split(), printed.split()
    if len(found) < len(words) or (len(found) > len(words) and not rest):
        return False
    return all(is_same(a, b) for a, b in zip(words, found))


def check_output(page, line, wanted, output):
    printed, at, free = output.split("\n"), 0, False
    for offset, one in enumerate(wanted):
        if one == "...":
            free = True
            continue
        found = next((i for i in range(at, len(printed)) if matches(one, printed[i])), None)
        if found is None or (not free and found != at):
            fail(page, line + offset, f"printed is not \"{one}\" but\n{output}")
            return
        at, free = found + 1, False


def shell(command, folder):
    return subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "PATH": f"{SAGEFE.parent}:{os.environ['PATH']}", "PYTHONPATH": str(PYTHON or ""),
                               "PYTHONDONTWRITEBYTECODE": "1"})


def whole_lines(block):
    """(offset, line) with what goes on behind a backslash."""
    begin, text = 0, ""
    for offset, line in enumerate(block):
        begin = begin if text else offset
        text += line
        if text.endswith("\\"):
            text = text[:-1]
            continue
        yield begin, text
        text = ""


def is_left_out(command):
    return any(command.startswith(start) or command == start.strip() for start in NOT_HERE) and not any(w in command for w in HERE)


def run_page(page, folder):
    """Gives how many commands were run."""
    count = 0
    prepare, words = MANUAL.get(page.stem, ([], {})) if page.parent.name == "manual" else ([], {})
    for command in prepare:
        run = shell(command, folder)
        if run.returncode != 0:
            fail(page, 1, f"exit code {run.returncode} of {command}\n{run.stdout}{run.stderr}")
    for begin, block, name in blocks(page.read_text()):
        if name and (page.parent.name == "tutorial" or page.stem in WITH_FILES):
            (folder / name).write_text("\n".join(block) + "\n")
        if not block or not is_command(block[0]):
            continue
        for offset, line in whole_lines(block):
            if not is_command(line):
                continue
            command = line[2:] if line.startswith("$ ") else line
            for word, meaning in words.items():
                command = re.sub(rf"\b{word}\b", meaning, command)
            # What stands behind a gap in the manual explains the command.
            command = re.split(r" {3,}(?=#|[a-z]+ (?:and|against) )", command)[0].rstrip()
            if command.startswith(ELSEWHERE + DEAR) or is_left_out(command):
                continue
            if PREFIX:
                command = command.replace("-DCMAKE_PREFIX_PATH=/usr", f"-DCMAKE_PREFIX_PATH={PREFIX}")
            if command.startswith("python3 "):
                command = sys.executable + command.removeprefix("python3")
            if command.startswith("cd "):
                folder = folder / command[3:]
                continue
            run = shell(command, folder)
            count += 1
            if run.returncode != 0:
                fail(page, begin + offset, f"exit code {run.returncode} of {command}\n{run.stdout}{run.stderr}")
            wanted = []
            for below in block[offset + 1:]:
                if is_command(below):
                    break
                wanted.append(below)
            if line.startswith("$ "):
                check_output(page, begin + offset + 1, wanted, run.stdout)
    return count


manual = [SOURCE / f"docs/manual/{name}.md" for name in MANUAL] if "--manual" in sys.argv else []
for page in manual or PAGES or [SOURCE / "README.md", *sorted((SOURCE / "docs/tutorial").glob("*.md"))]:
    if (page.stem in NEED_PYTHON and not PYTHON) or (page.stem in NEED_PREFIX) != (PREFIX is not None):
        continue
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "legacy_inputs").symlink_to(SOURCE / "legacy_inputs")
        (folder / "examples").symlink_to(SOURCE / "docs/examples")
        if run_page(page, folder) == 0:
            fail(page, 1, "no command was found")
sys.exit(1 if failed else 0)
