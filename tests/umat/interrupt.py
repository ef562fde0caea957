#!/usr/bin/env python3
"""Ctrl-C and SIGTERM end every run within 10 s, whatever it hangs in.

    interrupt.py SAGEFE SOURCE ENDLESS_UMAT

Starts all runs at the same time, waits until each listens to signals, sends one signal to each and measures the time to
its end.  A run must exit with code 5 (interrupted); that also shows that it listened.
"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

LIMIT = 10.0  # s, as the manual states it
CAUGHT = 1 << (signal.SIGTERM - 1)

sagefe, source, umat = sys.argv[1:]
deck = pathlib.Path(source, "legacy_inputs/chapter7/pinned_ld2_nu025/deck.dat")
stem = deck.parent.name


def endless_deck(path):
    """One element of a user material under a pressure."""
    path.write_text(
        "a column\nm       kN      kPa\n    1    0    4    0    1    1    1    2    0    1    0\n"
        "    1                  0.        0.\n    2                  1.        0.\n"
        "    3                  0.        1.\n    4                  1.        1.\n"
        "    1  100    6\n        4.        0.        1.        0.     1000.        .3\n"
        "    1    1    2    1\n    1    1    1    2    4    3\n"
        "    1    2    1    1    1\n    2    2    1    1    1\n"
        "press\n    1    0    0    0    0    0    1\n    1    3                100.      100.\nEND\n")


def start(name, arguments, fifo=None, environment=()):
    folder = scratch / name
    (folder / "out").mkdir(parents=True)
    if fifo:
        os.mkfifo(folder / fifo)
    endless_deck(folder / "endless.dat")
    endless_deck(folder / "again.dat")
    return subprocess.Popen([sagefe, *arguments], cwd=folder, env={**os.environ, **dict(environment)},
                            stdout=subprocess.DEVNULL, stderr=open(folder / "stderr", "w"), start_new_session=True)


def listens(process):
    for line in open(f"/proc/{process.pid}/status"):
        if line.startswith("SigCgt:"):
            return int(line.split()[1], 16) & CAUGHT != 0
    return False


def wait_for(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


failed = []
with tempfile.TemporaryDirectory() as made:
    scratch = pathlib.Path(made)
    with_umat = ["endless.dat", "--umat", umat]
    runs = {
        "umat": start("umat", ["run", *with_umat]),
        "umat_ctrl_c": start("umat_ctrl_c", ["run", *with_umat]),
        "umat_jobs": start("umat_jobs", ["run", "again.dat", *with_umat, "-j", "2"]),
        "umat_compare": start("umat_compare", ["compare", "--both", *with_umat]),
        "output": start("output", ["run", str(deck)], fifo=f"out/{stem}.lst"),
        "checkpoint": start("checkpoint", ["run", str(deck), "--restart"], fifo=f"out/{stem}.restart"),
        "module": start("module", ["run", str(deck), "--solver", "umfpack"], fifo="module.so",
                        environment={"SAGE_SOLVER_MODULE": str(scratch / "module/module.so")}.items()),
    }
    for name, process in runs.items():
        if not wait_for(lambda: process.poll() is not None or listens(process)):
            failed.append(f"{name}: does not listen to signals")
    time.sleep(0.5)  # the workers of -j and what is opened behind that
    began = time.monotonic()
    for name, process in runs.items():
        process.send_signal(signal.SIGINT if name == "umat_ctrl_c" else signal.SIGTERM)
    took = {}
    while len(took) < len(runs) and time.monotonic() < began + 3 * LIMIT:
        for name, process in runs.items():
            if name not in took and process.poll() is not None:
                took[name] = time.monotonic() - began
        time.sleep(0.02)
    for name, process in runs.items():
        if name not in took:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        seconds = took.get(name, 3 * LIMIT)
        print(f"{name}: exit code {process.returncode} after {seconds:.2f} s")
        if seconds > LIMIT or process.returncode != 5:
            failed.append(f"{name}: exit code {process.returncode} after {seconds:.2f} s, expected 5 within {LIMIT} s\n"
                          + (scratch / name / "stderr").read_text())
print("\n".join(failed))
sys.exit(1 if failed else 0)
