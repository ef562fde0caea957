"""Whole processes by the clock and by the processor, what a machine can do at most, and tables of results."""
import dataclasses
import math
import os
import pathlib
import platform
import random
import re
import statistics
import subprocess
import threading
import time

TIME_LIMIT = 300  # seconds of one job
LONG = 3.0  # seconds: longer jobs are run three times less often


@dataclasses.dataclass
class Job:
    """A command, and what finds the answer in its output (ValueError if it isn't there)."""

    labels: tuple
    command: list
    find: object


@dataclasses.dataclass
class Record:
    value: object  # of the warm-up
    values: list  # of the timed runs
    walls: list  # seconds, one of each run
    processor: list  # seconds of user and system, of all threads
    mb: float  # largest memory of the process
    first: float  # wall seconds of the warm-up
    text: str  # output of the warm-up

    @property
    def wall(self):
        return statistics.median(self.walls)

    @property
    def cpu(self):
        return statistics.median(self.processor)


def environment(threads):
    """Libraries of every program on as many threads as sagefe has."""
    return {**os.environ, **{name: str(threads) for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")}}


def once(command, folder, threads=1, limit=TIME_LIMIT):
    """Wall seconds, processor seconds, MB and output of one process; ValueError where it fails."""
    start = time.perf_counter()
    with open(folder / "stdout", "w+b") as out:
        process = subprocess.Popen(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT, env=environment(threads))
        alarm = threading.Timer(limit, process.kill)
        alarm.start()
        _, status, usage = os.wait4(process.pid, 0)
        alarm.cancel()
        process.returncode = status
        wall = time.perf_counter() - start
        out.seek(0)
        text = out.read().decode(errors="replace")
    if status != 0:
        lines = [line for line in text.splitlines() if "error" in line] or text[-400:].splitlines() or [f"longer than {limit} s"]
        raise ValueError(f"exit status {os.waitstatus_to_exitcode(status)}: {lines[0][:160]}")
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0, text


def turns(jobs, folder, runs, threads=1, notes=None, limit=TIME_LIMIT):
    """Jobs take turns `runs` times, after one run each to warm up that gives the answer: {labels: Record}.  With 0 runs
    the warm-up is the one that counts.  Without notes a job that fails is a ValueError; with them it is left out and noted."""
    live, records = [], {}
    for job in jobs:
        try:
            wall, used, mb, text = once(job.command, folder, threads, limit)
            value = job.find(text)
            timed = ([value], [wall], [used]) if runs == 0 else ([], [], [])
            records[job.labels] = Record(value, *timed, mb, wall, text)
            live.append(job)
        except ValueError as problem:
            if notes is None:
                raise
            notes.append(f"{', '.join(str(label) for label in job.labels[:4])}: {problem}".splitlines()[0][:160])
    for k in range(runs):
        random.Random(k).shuffle(live)  # who comes after a large program finds its caches cold
        for job in live:
            record = records[job.labels]
            if record.first > LONG and k >= max(1, runs // 3):
                continue
            wall, used, mb, text = once(job.command, folder, threads, limit)
            record.values.append(job.find(text))
            record.walls.append(wall)
            record.processor.append(used)
            record.mb = max(record.mb, mb)
    return records


# ----------------------------------------------------------------------------------------- growth


def fitted_exponent(points):
    """Of y ~ x^e by least squares of the logarithms."""
    points = [(math.log(x), math.log(y)) for x, y in points if y > 0]
    if len(points) < 2:
        return "-"
    mx, my = (statistics.mean(p[k] for p in points) for k in (0, 1))
    return f"{sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points):.2f}"


def exponents(points):
    """[(x, y), ...] -> of every point the exponent of y ~ x^e since the one before."""
    found = ["-"]
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        found.append(f"{math.log(y1 / y0) / math.log(x1 / x0):.2f}" if y0 > 0 and y1 > 0 else "-")
    return found


# ----------------------------------------------------------------------------------------- the machine

DGEMM = """
import time, numpy
n = 1500
a, b = numpy.random.rand(n, n), numpy.random.rand(n, n)
best = 1e300
for _ in range(8):
    start = time.perf_counter()
    a @ b
    best = min(best, time.perf_counter() - start)
print(2e-9 * n**3 / best)
"""


def dgemm(threads=1):
    """GF/s of numpy's product of matrices (OpenBLAS in Debian's numpy), best of some; None where numpy is not there."""
    for python in ("/usr/bin/python3", "python3"):
        found = subprocess.run([python, "-c", DGEMM], capture_output=True, text=True, env=environment(threads))
        if found.returncode == 0:
            return float(found.stdout)
    return None


def machine():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    memory = re.search(r"MemTotal:\s+(\d+)", pathlib.Path("/proc/meminfo").read_text())
    system = platform.freedesktop_os_release().get("PRETTY_NAME", "Linux")
    return f"{os.cpu_count()} x {model.group(1) if model else platform.machine()}, {int(memory.group(1)) / 2**20:.0f} GB, {system}"


def commit():
    """Of the source tree that holds the benchmark; `unknown` outside of git."""
    git = lambda *words: subprocess.run(["git", *words], capture_output=True, text=True, cwd=pathlib.Path(__file__).parent)
    try:
        found = git("rev-parse", "--short=8", "HEAD")
        changed = git("status", "--porcelain", "--untracked-files=no", ":/sage", ":/materials", ":/elements", ":/solvers")
    except OSError:
        return "unknown"
    return found.stdout.strip() + (" with changes" if changed.stdout.strip() else "") if found.returncode == 0 else "unknown"


# ----------------------------------------------------------------------------------------- tables


@dataclasses.dataclass
class Table:
    title: str
    note: str
    options: str  # of `sagefe run`, and of the peers where they take part
    head: list
    rows: list
    runs: object = None  # how many, or in words; None: as many as the command asks for


def markdown(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|---" * len(head) + "|", *("| " + " | ".join(r) + " |" for r in rows), ""])


def ms(seconds):
    return f"{1e3 * seconds:.1f}" if seconds < 1 else f"{1e3 * seconds:.0f}"


def both(wall, cpu):
    """Wall and processor milliseconds in one cell."""
    return f"{ms(wall)} / {ms(cpu)}"
