"""What sagefe shows on a terminal: a pseudo terminal is its standard error and output.
usage: terminal.py SAGEFE SOURCE_FOLDER"""
import fcntl
import os
import pathlib
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios

SAGEFE, SOURCE = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
CASES = SOURCE / "legacy_inputs/chapter7"
DECK = str(CASES / "pinned_ld2_nu0333/deck.dat")
PHASE = "assembly|factorisation|solution|recovery|numbering"
PLAIN = {"TERM": "xterm", "NO_COLOR": "", "LC_ALL": "C"}
failures = []


def expect(condition, *words):
    if not condition:
        failures.append(" ".join(str(word) for word in words))
        print("FAILED:", failures[-1][:2000])


def on_terminal(folder, *arguments, columns=100, environment=PLAIN, send=None):
    """All that was written, and how the process ended.  send: a signal, once a line of progress stands."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(folder)
        os.environ.update(environment)
        fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        os.execv(SAGEFE, [SAGEFE, *arguments])
    data = b""
    while True:
        try:
            piece = os.read(terminal, 65536)
        except OSError:  # the other end is closed
            break
        if not piece:
            break
        data += piece
        if send is not None and b"\033[K" in data and re.search(rb"[0-9]:[0-9][0-9]", data):
            os.kill(pid, send)
            send = None
    return data.decode(), os.waitpid(pid, 0)[1]


def lines_of_progress(text):
    return re.findall("\r\033\\[K([^\r\n]+)(?=\r\033\\[K)", text)


def left_on_screen(text, columns=100):
    """The last line after carriage returns and clears, of what a person sees."""
    last = text.replace("\r\n", "\n").split("\n")[-1]
    return re.sub(r"\033\[[0-9;]*m", "", re.split("\r\033\\[K|\r", last)[-1])


def check_progress(folder):
    # Which phases the few lines of a run of a second meet is chance: what has to be among them is asked of a longer run.
    text, status = on_terminal(folder, "run", DECK, "--refine", str(5), "-o", "out")
    shown = lines_of_progress(text)
    expect(status == 0 and len(shown) >= 3, "a long run shows its progress", status, shown)
    expect(any(re.search(PHASE, line) for line in shown), "a phase", shown)
    expect(any(re.search("increment [0-9]+ of 10", line) for line in shown), "increments", shown)
    expect(any("% " in line or "%," in line for line in shown), "share done", shown)
    expect(left_on_screen(text) == "", "nothing is left", left_on_screen(text))
    large = ["run", DECK, "--refine", str(4), "-o", "out"]
    narrow, status = on_terminal(folder, *large, columns=24)
    shown = lines_of_progress(narrow)
    expect(shown and max(len(line) for line in shown) < 24, "lines do not wrap", shown)
    for environment in ({"TERM": "dumb"}, {"TERM": ""}):
        dumb, status = on_terminal(folder, *large, environment={**PLAIN, **environment})
        expect(status == 0 and "\033" not in dumb, "a dumb terminal gets no control characters", environment)
    quiet, status = on_terminal(folder, *large, "--quiet")
    expect(status == 0 and lines_of_progress(quiet) == [], "--quiet", quiet)
    expect("status" not in quiet, "--quiet prints no results")


def check_nonlinear(folder):
    text, status = on_terminal(folder, "run", str(CASES / "dp_285/deck.dat"), "--refine", str(3), "-o", "out",
                                columns=200)
    shown = lines_of_progress(text)
    expect(any(re.search(r"iteration [0-9]+, residual [0-9.]+e", line) for line in shown), "iterations", shown)
    expect(any("left" in line for line in shown) or len(shown) < 12, "time left", shown)


def check_ends(folder):
    for command in (["run", DECK, "--refine", str(5), "-o", "out"], ["verify"]):
        for number in (signal.SIGTERM, signal.SIGINT):
            text, status = on_terminal(folder, *command, send=number)
            if command[0] == "run":  # half a second after its start, where up to 400 000 elements are still being prepared
                first = lines_of_progress(text)[:1]
                expect(first and "increment" not in first[0], "before increments", first)
            expect(left_on_screen(text) == "", command[0], number, "left", left_on_screen(text))
            if command[0] == "run":
                expect(os.WIFEXITED(status) and os.WEXITSTATUS(status) == 5, "interrupted", status)
            else:
                expect(os.WIFSIGNALED(status) and os.WTERMSIG(status) == number, "ended by", status)
    text, status = on_terminal(folder, "run", "none.dat", "-o", "out")
    expect(os.WEXITSTATUS(status) == 2 and left_on_screen(text) == "", "after an error", text)


def check_many(folder):
    text, _ = on_terminal(folder, "run", *[str(CASES / name / "deck.dat") for name in ("dp_285", "dp_08")], "-j", "2",
                          "--refine", "1", "-o", "out")
    for shown in lines_of_progress(text):
        expect(shown.startswith("run "), "several decks", shown)
    text, status = on_terminal(folder, "verify", "--only", "collapse")
    for shown in lines_of_progress(text):
        expect(shown.startswith("verify "), shown)


def check_colours_and_sketch(folder):
    (folder / "bad.dat").write_text("A deck that ends too soon\n")
    text, _ = on_terminal(folder, "check", "bad.dat")
    expect("\033[1;31merror:\033[0m" in text, "colour", text)
    text, _ = on_terminal(folder, "check", "bad.dat", environment={**PLAIN, "NO_COLOR": "1"})
    expect("error:" in text and "\033[1" not in text, "NO_COLOR", text)
    text, _ = on_terminal(folder, "run", DECK, "-o", "out")
    expect("deviator [psi] against axial strain" in text and text.isascii(), "sketch in ASCII", text)
    expect(all(len(line) < 100 for line in text.replace("\r", "").split("\n") if "|" in line), "its width")
    text, _ = on_terminal(folder, "run", DECK, "-o", "out", environment={**PLAIN, "LC_ALL": "C.UTF-8"})
    expect("\u2502" in text and "\u28ff" not in text, "sketch in Unicode", text)
    text, _ = on_terminal(folder, "run", DECK, "-o", "out", columns=50)
    expect("against axial strain" not in text, "no room for a sketch", text)


def check_pipes(folder):
    """Piped output has no control characters, whatever the options; files are those of a run on a terminal."""
    for options in ([], ["--verbose"], ["--quiet"]):
        run = subprocess.run([SAGEFE, "run", DECK, "-o", "piped", *options], cwd=folder, capture_output=True,
                             env={**os.environ, "TERM": "xterm"})
        both = (run.stdout + run.stderr).decode()
        expect(run.returncode == 0 and not re.search("[\033\r\b]", both), "control characters", options)
        expect("against axial strain" not in both, "a sketch in a pipe")
        expect((run.stdout == b"") == (options == ["--quiet"]), "--quiet")
        expect(("solver: skyline" in both) == (options == ["--verbose"]), "--verbose", both)
    on_terminal(folder, "run", DECK, "-o", "shown")
    for name in ("pinned_ld2_nu0333.lst", "pinned_ld2_nu0333.increments.csv", "pinned_ld2_nu0333.report1.csv"):
        expect((folder / "piped" / name).read_bytes() == (folder / "shown" / name).read_bytes(), name)


with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    for check in (check_pipes, check_colours_and_sketch, check_progress, check_nonlinear, check_ends, check_many):
        check(place)
sys.exit(1 if failures else 0)
