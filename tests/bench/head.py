"""The first screen of docs/benchmarks.md: where its numbers come from, ten sentences and three charts.

All numbers in the sentences are cells of the tables of the page.  A sentence whose table was not measured is left out.
"""
import re

LIMIT = 0.02  # relative error that the advice on nonlinear answers refers to


def rows(kept, key):
    """[{column: text}] of a table; of columns of one name the first.  [] where there is no such table."""
    if key not in kept:
        return []
    head = kept[key]["head"]
    first = {column: head.index(column) for column in head}
    return [{column: line[at] for column, at in first.items()} for line in kept[key]["rows"]]


def number(cell):
    """The first number of a cell, or None."""
    found = re.match(r"\s*([-+]?[\d.]+(?:e[-+]?\d+)?)", cell)
    return float(found.group(1)) if found and found.group(1) != "." else None


def between(cells):
    """`low to high` of the numbers in the cells, or one number; None where there is none."""
    values = [v for v in map(number, cells) if v is not None]
    if not values:
        return None
    low, high = f"{min(values):g}", f"{max(values):g}"
    return low if low == high else f"{low} to {high}"


def duration(milliseconds):
    return f"{milliseconds:.3g} ms" if milliseconds < 1000 else f"{1e-3 * milliseconds:.2g} s"


# ------------------------------------------------------------------------------------------------- sentences


def linear(kept):
    table = rows(kept, "linear")
    ratio = between(row["its wall time over sagefe"] for row in table)
    if not ratio:
        return None
    return (
        f"Linear specimens with {table[0]['unknowns']} to {table[-1]['unknowns']} unknowns take {duration(number(table[0]['sagefe']))} to {duration(number(table[-1]['sagefe']))}, and the fastest other program takes {ratio} times as long."
    )


def dolfinx(kept):
    ratio = between(row["dolfinx, mesh to answer, over sagefe (processor)"] for row in rows(kept, "linear"))
    return ratio and f"From the mesh to the answer alone, dolfinx with MUMPS needs {ratio} times the processor time of a whole run of sagefe."


def plastic(kept):
    table = rows(kept, "plastic")
    ratio = between(row["dolfinx over sagefe, processor time"] for row in table)
    return ratio and f"For the Drucker-Prager specimen with {table[0]['unknowns']} to {table[-1]['unknowns']} unknowns, dolfinx needs {ratio} times the processor time of sagefe."


def general(kept):
    table = rows(kept, "general")
    if not table:
        return None
    last = table[-1]
    words = f"Without equal elements, {last['unknowns']} unknowns take {last['sagefe s']} s of processor time and {last['MB']} MB"
    if number(last["CG over sagefe"]) is None:
        return words + "."
    return words + f"; dolfinx needs {last['MUMPS over sagefe']} times this time with MUMPS, and {last['CG over sagefe']} times with CG and multigrid."


def equal_error(kept):
    table = kept["equal_error"]["rows"] if "equal_error" in kept else []
    at = [line for line in table if line[0].startswith("pinned") and line[1] == "0.0001"]
    parts = [f"{program} needs {ratio} times" for program, column in (("CalculiX", 5), ("FreeFEM", 7)) if (ratio := between(line[column] for line in at))]
    return f"At an error of 1e-4 of the pinned specimens, {' and '.join(parts)} the wall time of sagefe." if parts else None


def interface(kept):
    table = [row for row in rows(kept, "interface") if number(row["unknowns"]) is not None]
    if not table:
        return None
    last = table[-1]
    return f"40 increments on an interface with {last['unknowns']} unknowns take {last['over linear specimen']} times the time of one linear solution on the same mesh."


def first_within(table, limit=LIMIT):
    """Of the rows that vary the mesh: the fastest whose error and those of all finer meshes of its element are within the limit."""
    safe = []
    by_element = {}
    for row in table:
        if row["varied"] == "mesh":
            by_element.setdefault(row["element"], []).append(row)
    for lines in by_element.values():  # from coarse to fine
        good = []
        for row in reversed(lines):
            if number(row["error"]) > limit:
                break
            good.append(row)
        safe += good
    return min(safe, key=lambda row: number(row["processor ms"]), default=None)


def advice(kept, key, problem, what):
    table = [row for row in rows(kept, key) if row["problem"] == problem]
    if not table:
        return None
    best = first_within(table)
    if not best:
        return f"No measured mesh gives {what} to 2 %."
    return f"For {what}, use {best['element']}: of all elements it is the first within 2 %, in {duration(number(best['processor ms']))} (mesh {best['mesh']}, error {100 * number(best['error']):.2g} %)."


def goals(kept):
    verdicts = [row.get("reached", "") for row in rows(kept, "goals")] + [row[-1] for row in aims(kept)]
    verdicts = [verdict for verdict in verdicts if verdict in ("yes", "no")]
    return f"{verdicts.count('yes')} of {len(verdicts)} goals are reached: those of [decks](#performance-goals) and those of [kinds of work](#goals-of-each-kind-of-work)." if verdicts else None


# Kind of work, table, a cell that names the rows (its column and a pattern), column of the value, limit, whether it is the least allowed, unit.
AIMS = [
    ("Mohr-Coulomb, one point", "assembly", ("case", "Mohr-Coulomb"), "us per point", 0.3, False, "us"),
    ("assembly on two threads over one", "assembly", ("case", "Drucker-Prager|Mohr-Coulomb|UMAT.*|seepage.*|walls.*"), "one thread over two", 1.7, True, ""),
    ("linear, no equal elements, two threads", "general", ("n", "448"), "wall s, all threads", 2.5, False, "s"),
    ("linear, no equal elements, memory", "general", ("n", "448"), "MB", 900, False, "MB"),
    ("linear, equal rectangles, fastest other program over sagefe", "linear", ("n", "14|224|448"), "its wall time over sagefe", 5, True, ""),
    ("Drucker-Prager, dolfinx over sagefe", "plastic", ("n", r"\d+"), "dolfinx over sagefe, processor time", 5, True, ""),
    ("40 increments on an interface over one linear solution", "interface", ("k", "4|5"), "over linear specimen", 2.5, False, ""),
    ("free surface, 402 000 heads", "work", ("work", r"free surface, 40\d{4} heads"), "wall s", 12, False, "s"),
    ("iteration with walls over one without", "work", ("work", "walls: soil with walls"), "ratio", 1.1, False, ""),
    ("`--msh` over `--vtu`", "work", ("work", "viewer file: --msh"), "ratio", 1, False, ""),
]


def aims(kept):
    """Rows of the table of goals: kind of work, measured, goal, whether it is reached by all rows that it names."""
    found = []
    for name, key, (column, pattern), measured, limit, least, unit in AIMS:
        values = [row[measured] for row in rows(kept, key) if re.fullmatch(pattern, row[column]) and number(row[measured]) is not None]
        if not values:
            continue
        all_reach = all(number(value) >= limit if least else number(value) <= limit for value in values)
        found.append([name, f"{between(values)} {unit}".strip(), f"{'at least' if least else 'at most'} {limit:g} {unit}".strip(), "yes" if all_reach else "no"])
    return found


def sentences(kept):
    found = [linear(kept), dolfinx(kept), plastic(kept), general(kept), equal_error(kept), interface(kept)]
    found.append(advice(kept, "collapse", "smooth strip", "a collapse load"))
    found.append(advice(kept, "safety", "1:1 slope", "a factor of safety"))
    found.append(advice(kept, "moment", "braced cut", "a wall moment"))
    found.append(goals(kept))
    return [words for words in found if words]


# ------------------------------------------------------------------------------------------------- source and charts


def sources(kept):
    """Lines on the runs that the tables come from: date, commit, machine, speed of matrix products."""
    runs = {}
    for key, table in kept.items():
        runs.setdefault((table.get("date", "unknown"), table.get("commit", "unknown")), []).append(key)
    lines = []
    if len(runs) == 1:
        (date, commit), = runs
        lines += [f"- Date: {date}", f"- Commit: {commit}"]
    else:
        lines.append(f"- The tables come from {len(runs)} runs, so compare only numbers of the same run:")
        lines += [f"  - {date}, commit {commit}: {', '.join(sorted(keys))}" for (date, commit), keys in sorted(runs.items())]
    lines += [f"- Machine: {name}" for name in sorted({table["machine"] for table in kept.values()})]
    speeds = [table["dgemm"] for table in kept.values() if table["dgemm"]]
    if speeds:
        low, high = f"{min(speeds):.0f}", f"{max(speeds):.0f}"
        lines.append(f"- Matrix products (DGEMM, 1500 x 1500): {low if low == high else f'{low} to {high}'} GF/s")
    return lines
