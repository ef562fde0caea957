#!/usr/bin/env python3
"""What pages show as commands does what they say.

    doc_blocks.py SAGEFE SOURCE [PAGE ...]

README.md and the tutorials: every line of a code block that begins with a command is run, in the order of the page
and in a folder of its own beside the tree's decks; it must end with exit code 0.  Lines below a command that begins
with "$ " must be printed, in their order, numbers to 0.5 %; "..." stands for any lines, and at the end of a line for
its rest.
"""
import pathlib
import subprocess
import sys
import tempfile

SAGEFE = pathlib.Path(sys.argv[1]).resolve()
SOURCE = pathlib.Path(sys.argv[2]).resolve()
PAGES = [pathlib.Path(name).resolve() for name in sys.argv[3:]]
COMMANDS = ("sagefe", "sed", "scripts/", "cmake", "ctest", "cp", "cd", "man", "export")
# Commands that build or install: tests of their own run them (tests/install), or scripts/check_package.
ELSEWHERE = ("scripts/", "cmake", "ctest", "man ", "export ")
failed = 0


def fail(page, line, *words):
    global failed
    failed += 1
    print(f"{page.relative_to(SOURCE)}:{line}:", *words)


def blocks(text):
    """(line of the first, lines) of each fenced or indented block."""
    lines, begin, fenced, block = text.split("\n"), 0, False, []
    for number, line in enumerate(lines + [""], 1):
        if line.startswith("```"):
            if fenced:
                yield begin, block
            fenced, begin, block = not fenced, number + 1, []
        elif fenced:
            block.append(line)
        elif line.startswith("    ") and (block or not lines[number - 2].strip()):
            begin = begin if block else number
            block.append(line[4:])
        elif block:
            yield begin, block
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


def run_page(page, folder):
    """Gives how many commands were run."""
    count = 0
    for begin, block in blocks(page.read_text()):
        if not is_command(block[0]):
            continue
        for offset, line in enumerate(block):
            if not is_command(line):
                continue
            command = line[2:] if line.startswith("$ ") else line
            if command.startswith(ELSEWHERE):
                continue
            run = subprocess.run(["bash", "-c", command.replace("sagefe ", f"{SAGEFE} ", 1)], cwd=folder, capture_output=True,
                                 text=True)
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


for page in PAGES or [SOURCE / "README.md", *sorted((SOURCE / "docs/tutorial").glob("*.md"))]:
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "legacy_inputs").symlink_to(SOURCE / "legacy_inputs")
        if run_page(page, folder) == 0:
            fail(page, 1, "no command was found")
sys.exit(1 if failed else 0)
