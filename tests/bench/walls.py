"""A mesh of 20 000 elements with three walls in elastic soil, and without them: what walls cost an iteration.

    python3 tests/bench/walls.py build/release/sagefe [RUNS]

Pairs of runs, one after the other, and the median of their ratios; with valgrind installed and --instructions the
ratio of instructions as well.  Walls share their nodes with the soil.  Second pair: a law that is asked in every
iteration, though it does not yield."""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

COLUMNS, ROWS, WALLS, TOE = 200, 100, (50, 100, 150), 40


def fives(*values):
    return "".join(f"{v:5d}" for v in values)


def ten(value):
    for digits in range(9, 0, -1):
        text = f"{value:.{digits}g}".replace("e", "E")
        if "." not in text and "E" not in text:
            text += "."
        if len(text) <= 10:
            return f"{text:>10}"
    raise ValueError(value)


def deck(walls, increments, law):
    """law: cards of the soil's law."""
    node = lambda i, j: 1 + j * (COLUMNS + 1) + i
    nodes = [fives(node(i, j), 0, 0) + ten(0.5 * i) + ten(0.5 * j) for j in range(ROWS + 1) for i in range(COLUMNS + 1)]
    elements = [
        fives(1 + j * COLUMNS + i, 1, node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))
        for j in range(ROWS)
        for i in range(COLUMNS)
    ]
    materials = [law, fives(2, 36, 3) + ten(0.0) + " wall\n" + ten(1e6) + ten(1e5) + ten(4e5)]
    groups = [fives(1, 1, 1, 1)]
    if walls:
        groups.append(fives(2, 35, 0, 2))
        for w, column in enumerate(WALLS):
            for j in range(TOE, ROWS):
                elements.append(fives(30001 + 200 * w + j, 2, node(column, j), node(column, j + 1)))
    fixities = [fives(node(i, 0), 0, 0, 1, 1) for i in range(COLUMNS + 1)]
    fixities += [fives(node(i, j), 0, 0, 1, 0) for i in (0, COLUMNS) for j in range(1, ROWS + 1)]
    loads = [fives(node(i, ROWS), 0, 0) + ten(20.0) + ten(-10.0) for i in range(51, 100)]
    head = "verification\nm       kN      kPa     " + ten(101.325) + ten(9.81) + "\n"
    head += fives(1, 0, len(nodes), 0, 2, len(groups), len(elements), len(fixities), 0, 1, 0)
    stage = ["stage", fives(increments, 0, 0, 0, 0, len(loads), 0, 0, 0, 0) + ten(0.0) + ten(0.0) + ten(0.0)]
    return "\n".join([head, *nodes, *materials, *groups, *elements, *fixities, *stage, *loads, "END\n"])


ELASTIC = fives(1, 1, 2) + ten(18.0) + " soil\n" + ten(2e4) + ten(0.3)
# No strength is reached: every iteration asks laws and factorises, as in plastic soil.
UNYIELDING = fives(1, 4, 5) + ten(18.0) + " soil\n" + ten(2e4) + ten(0.3) + ten(1e5) + ten(30.0) + ten(30.0)


def seconds_and_iterations(program, path, folder):
    answer = json.loads(
        subprocess.run(
            [program, "run", path, "--json", "--output", folder, "--threads", "1"], capture_output=True, check=True
        ).stdout
    )
    run = answer["result"]["decks"][0]
    work = run["work"]
    iterations = sum(stage["iterations"] for stage in run["stages"])
    return run["seconds"], iterations, work


def instructions(program, path, folder):
    out = pathlib.Path(folder) / "callgrind.out"
    subprocess.run(
        ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program, "run", path, "--quiet", "--output", folder,
         "--threads", "1", "--tables", "none", "--kernels", "avx2"],
        capture_output=True,
        check=True,
    )
    for line in out.read_text().splitlines():
        if line.startswith("summary:"):
            return int(line.split()[1])
    return 0


def main():
    program = sys.argv[1]
    numbers = [a for a in sys.argv[2:] if not a.startswith("--")]
    runs = int(numbers[0]) if numbers else 9
    with tempfile.TemporaryDirectory() as folder:
        for name, law in (("elastic", ELASTIC), ("Mohr-Coulomb that does not yield", UNYIELDING)):
            paths = []
            for walls in (False, True):
                path = pathlib.Path(folder) / f"{name.split()[0]}_{'walls' if walls else 'plain'}.dat"
                path.write_text(deck(walls, 3, law))
                paths.append(str(path))
            ratios, kept = [], None
            for _ in range(runs):
                plain = seconds_and_iterations(program, paths[0], folder)
                with_walls = seconds_and_iterations(program, paths[1], folder)
                ratios.append(with_walls[0] / with_walls[1] / (plain[0] / plain[1]))
                kept = plain, with_walls
            print(f"{name}: {kept[0][1]} and {kept[1][1]} iterations, time per iteration with walls / without: "
                  f"{statistics.median(ratios):.3f} (median of {runs} pairs, {min(ratios):.3f} to {max(ratios):.3f})")
            if "--instructions" in sys.argv:
                a, b = (instructions(program, path, folder) for path in paths)
                print(f"{name}: instructions {a} and {b}, ratio {b / a:.4f}, each iteration "
                      f"{b / kept[1][1] / (a / kept[0][1]):.4f}")


if __name__ == "__main__":
    main()
