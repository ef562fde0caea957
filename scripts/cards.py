"""Cards of sage1 decks, and runs of such decks: what the checks in this folder share."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SAGEFE = os.environ.get("SAGEFE", str(ROOT / "build/release/sage/app/sagefe"))


def integers(*values, width=5):
    """Right-aligned; "" is a blank field.  width: 5 of sage1, 10 of sage1_wide."""
    return "".join(f"{value:>{width}}" for value in values)


def real(value, width=10, digits=15):
    """With a decimal point, and as many of the digits as the columns hold.  width: 10 of sage1, 20 of sage1_wide."""
    for count in range(digits, 0, -1):
        mantissa, _, power = f"{value + 0.0:.{count}g}".partition("e")
        text = mantissa + ("" if "." in mantissa else ".") + (f"E{int(power)}" if power else "")
        if len(text) <= width:
            return text.rjust(width)
    raise ValueError(value)


def reals(*values, width=10, digits=15):
    return "".join(real(value, width, digits) for value in values)


def control(lines):
    """(index, counts) of the control card of a sage1 deck in plane strain."""
    at = next(i for i, line in enumerate(lines) if i > 1 and line.startswith(integers(1, 0) + " "))
    return at, [int(lines[at][i:i + 5]) for i in range(0, len(lines[at]), 5)]


def answer(command, text, *options):
    """The result of `sagefe COMMAND --json` on a deck, and what the command printed as errors.  Exit codes 0 and 3 have one."""
    with tempfile.TemporaryDirectory() as folder:
        deck = pathlib.Path(folder) / "deck.dat"
        deck.write_text(text)
        done = subprocess.run([SAGEFE, command, str(deck), "-o", folder, "--json", *options], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        sys.exit(done.stderr)
    return json.loads(done.stdout)["result"], done.stderr
