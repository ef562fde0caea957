"""The charts of docs/benchmarks, from the tables that were recorded there: no time is measured again.

Usage: pictures.py FOLDER [-o FOLDER]     FOLDER holds the tables (CSV); charts go beside them, or into another folder
"""
import argparse
import csv
import pathlib
import re

import chart
import growth as growth_tables
import nonlinear as nonlinear_tables
import scenes

# Tables of error against run time, and those of run time against size, by the name of their CSV file.
NONLINEAR = {"collapse": nonlinear_tables.COLLAPSE_TITLE, "safety": nonlinear_tables.SAFETY_TITLE, "moment": nonlinear_tables.MOMENT_TITLE, "ratio": nonlinear_tables.RATIO_TITLE, "history": nonlinear_tables.HISTORY_TITLE}
GROWTH = {"scaling": growth_tables.SCALING_TITLE, "interface": growth_tables.INTERFACE_TITLE, "footing": growth_tables.FOOTING_TITLE}


def rows_of(file):
    """[{column: text}]; of columns of one name the first."""
    with open(file, newline="") as stream:
        head, *lines = csv.reader(stream)
    first = {column: head.index(column) for column in head}
    return [{column: line[at] for column, at in first.items()} for line in lines]


def precision(rows):
    for scene in scenes.scenes():
        lines = {}
        for row in rows:
            if row["scene"] == scene.name:
                lines.setdefault((row["program"], row["variant"]), []).append((float(row["seconds"]), float(row["error"])))
        series = [(v if program == "sagefe" else f"{program} {v}", sorted(line), program != "sagefe") for (program, v), line in lines.items()]
        yield scene.title, f"{scene.name}.svg", f"{scene.title}: reference {scene.reference:.7g}", "whole process, s", "relative error", series


def nonlinear(key, rows):
    by_scene = {}
    for row in rows:
        beside = row["varied"] != "mesh"
        name = f"{row['varied']}: {row['element']}, {row['mesh']}" if beside else row["element"]
        point = (1e-3 * float(row["processor ms"]), float(row["error"]))
        by_scene.setdefault(row["problem"], {}).setdefault((name, beside), []).append(point)
    for scene, lines in by_scene.items():
        title = f"{NONLINEAR[key]}: {scene}"
        file = f"nonlinear_{key}_{re.sub(r'[^a-z]+', '_', scene.lower())}.svg"
        yield title, file, title, "processor, s", "relative error", [(name, points, beside) for (name, beside), points in lines.items()]


def growth(key, rows):
    """Columns in seconds over the unknowns; the last line of the table holds exponents."""
    rows = [row for row in rows if "exponent" not in row.values()]
    dofs = "unknowns" if rows and "unknowns" in rows[0] else "dofs"
    columns = [column for column in (rows[0] if rows else {}) if column.endswith(" s")]
    series = []
    for column in columns:
        points = [(float(row[dofs]), float(row[column])) for row in rows if row[column] not in ("", "-")]
        series.append((column[:-2], points, not column.startswith("wall")))
    yield GROWTH[key], f"{key}.svg", GROWTH[key], "unknowns", "s", sorted(series, key=lambda s: s[2])


def front(points):
    """Of (seconds, error), those than which no other is both faster and more accurate."""
    found = []
    for seconds, error in sorted(points):
        if not found or error < found[-1][1]:
            found.append((seconds, error))
    return found


def overview(folder):
    """The three charts at the head of the page: time against size, error against time, and that of a nonlinear answer."""
    tables = {key: rows_of(folder / f"{key}.csv") for key in ("linear", "precision", "collapse") if (folder / f"{key}.csv").exists()}
    programs = ("sagefe", "CalculiX CAX4", "FreeFEM P1", "dolfinx Q1", "dolfinx, mesh to answer")
    series = []
    for name in programs:
        points = [(float(row["unknowns"]), 1e-3 * float(row[name].split(" / ")[0])) for row in tables.get("linear", []) if row[name] != "-"]
        series.append((name, points, name != "sagefe"))
    yield "Time against size", "overview_size.svg", "Linear specimen on the same mesh", "unknowns", "wall time, s", series
    by_program = {}
    for row in tables.get("precision", []):
        if row["scene"] == "pinned_ld2_nu495":
            by_program.setdefault(row["program"], []).append((float(row["seconds"]), float(row["error"])))
    series = [(name, front(points), name != "sagefe") for name, points in by_program.items()]
    yield "Error against time", "overview_error.svg", "Pinned specimen, nu = .495: the best meshes of each program", "wall time, s", "relative error", series
    by_element = {}
    for row in tables.get("collapse", []):
        if row["varied"] == "mesh" and row["problem"] == "smooth strip":
            by_element.setdefault(row["element"], []).append((1e-3 * float(row["wall ms"]), float(row["error"])))
    yield "Error of a collapse load against time", "overview_collapse.svg", "Collapse load of a smooth strip footing", "wall time, s", "relative error", [(name, points, False) for name, points in by_element.items()]


def charts(folder):
    """(table, title, file, heading, x label, y label, series) of every table that the folder has."""
    makers = {"precision": precision}
    makers |= {key: lambda rows, key=key: nonlinear(key, rows) for key in NONLINEAR}
    makers |= {key: lambda rows, key=key: growth(key, rows) for key in GROWTH}
    for key, make in makers.items():
        file = folder / f"{key}.csv"
        if file.exists():
            for found in make(rows_of(file)):
                yield (key, *found)
    for found in overview(folder):
        yield ("overview", *found)


def draw(folder, out):
    """{table: [(title, file)]} of the charts that it has drawn."""
    drawn = {}
    for key, title, name, heading, x_label, y_label, series in charts(folder):
        if chart.loglog(out / name, heading, x_label, y_label, series):
            drawn.setdefault(key, []).append((title, name))
    return drawn


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    args = parser.parse_args()
    out = args.output or args.folder
    out.mkdir(parents=True, exist_ok=True)
    for found in draw(args.folder, out).values():
        for _, name in found:
            print(out / name)


if __name__ == "__main__":
    main()
