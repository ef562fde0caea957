"""Ratios of new tables beside those of kept ones: which moved by more than 15 %."""
import dataclasses
import re

MOVED = 0.15
# Leading columns that name a row, where it is not the first alone.
NAMED_BY = {"equal_mesh": 3, "equal_error": 2, "graded": 3, "skips": 2, "assembly": 2, "collapse": 6, "ratio": 6, "history": 6, "safety": 6, "moment": 6}
# Columns that divide two times.
RATIO = re.compile(r"\bover\b|^ratio$")


@dataclasses.dataclass
class Moved:
    table: str
    row: str
    column: str
    before: float
    now: float

    def __str__(self):
        return f"{self.table}, {self.row}: {self.column}: {self.before:g} -> {self.now:g} ({self.now / self.before - 1:+.0%})"


def ratios(key, table):
    """{(row, column): value} of the cells that divide two times."""
    head, found = table["head"], {}
    for line in table["rows"]:
        row = ", ".join(line[: NAMED_BY.get(key, 1)])
        for at, column in enumerate(head):
            if not RATIO.search(column) or line[0] == "exponent":
                continue
            # Columns of one name: with the column before, whose time is divided.
            name = column if head.count(column) == 1 else f"{column} of {head[at - 1]}"
            try:
                value = float(line[at])
            except ValueError:  # a dash: not measured
                continue
            if (row, name) in found:
                raise ValueError(f"two rows {row} in table {key}")
            found[row, name] = value
    return found


def compare(before, now):
    """Number of ratios in both, and those that moved."""
    count, moved = 0, []
    for key in now:
        if key not in before:
            continue
        old, new = ratios(key, before[key]), ratios(key, now[key])
        for (row, column), value in new.items():
            if (row, column) not in old:
                continue
            count += 1
            base = old[row, column]
            if base <= 0 or not abs(value / base - 1) <= MOVED:
                moved.append(Moved(key, row, column, base, value))
    return count, moved


def self_test():
    """Raises where the comparison misses a ratio that moved, or names another."""
    table = lambda *rows: dict(head=["problem", "element", "n", "A ms", "ratio", "B ms", "ratio", "B over A"], rows=[list(r) for r in rows])
    first = ("p", "e", "7", "1", "2.0", "5", "4.0", "1.00")
    before = {"equal_mesh": table(first, ("p", "e", "14", "1", "3.0", "5", "-", "1.00"))}
    assert compare(before, before) == (5, [])
    assert compare(before, {}) == (0, []) and compare({}, before) == (0, [])
    now = {"equal_mesh": table(("p", "e", "7", "9", "2.3", "9", "3.3", "0.86"), ("p", "e", "14", "1", "3.5", "5", "8.0", "1.14"))}
    count, moved = compare(before, now)
    assert count == 5 and [(m.row, m.column, m.before, m.now) for m in moved] == [("p, e, 7", "ratio of B ms", 4.0, 3.3), ("p, e, 14", "ratio of A ms", 3.0, 3.5)], moved
    assert str(moved[0]) == "equal_mesh, p, e, 7: ratio of B ms: 4 -> 3.3 (-18%)", str(moved[0])
    try:
        ratios("equal_mesh", table(first, first))
    except ValueError:
        return
    raise AssertionError("two rows of one name are not found")
