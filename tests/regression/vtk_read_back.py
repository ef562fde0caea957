#!/usr/bin/env python3
"""Has VTK (Debian's python3-vtk9) and meshio (python3-meshio) read what `sagefe run --vtu` and `sagefe bounds` write, and compares with the CSV files.

Usage: vtk_read_back.py SAGEFE SOURCE_FOLDER       exit code 77: a package is missing
"""
import functools
import math
import pathlib
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print(f"skipped: {missing} (apt-get install python3-vtk9 python3-meshio)")
    sys.exit(77)

from csv_tables import expect, last_step, means, near, number, rows

SPECIMEN, SLENDER = 1.4 * 1.4, 1.4 * 2.8  # areas of the chapter's meshes, in^2
FRICTION = ("chapter7/friction_285_nu0495/deck.dat", SLENDER)
PINNED = ("chapter7/pinned_ld1_nu025/deck.dat", SPECIMEN)
CASES = [  # deck and its area, options, types of solids and of interfaces
    (*FRICTION, [], {9}, {3}),
    (*FRICTION, ["--element", "quad8"], {23}, {21}),
    (*PINNED, ["--element", "quad9"], {28}, set()),
    (*PINNED, ["--element", "quad25"], {70}, set()),
    ("smith_griffiths/p51_1.dat", None, ["--layout", "sg_p51"], {5}, set()),
    ("chapter7/dp_285/deck.dat", SLENDER, [], {9}, {3}),
]
BEAMS = ("cande_level3/candejar_input_test1.cid", ["--partial"])
BOUNDS, SLOPE = "slopes/one_to_one_line/deck.dat", 96.0  # and its area, m^2
MESHIO = {3: "line", 21: "line3", 5: "triangle", 22: "triangle6", 9: "quad", 23: "quad8", 28: "quad9"}


class State:
    """A VTU file as VTK reads it."""

    def __init__(self, file):
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        expect(reader.GetErrorCode() == 0, f"{file}: VTK can't read it")
        self.grid = reader.GetOutput()
        self.times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        self.points = self.arrays(self.grid.GetPointData())
        self.cells = self.arrays(self.grid.GetCellData())
        self.field = self.arrays(self.grid.GetFieldData())
        self.at = vtk_to_numpy(self.grid.GetPoints().GetData())
        self.types = [self.grid.GetCellType(i) for i in range(self.grid.GetNumberOfCells())]

    @staticmethod
    def arrays(data):
        return {data.GetArray(i).GetName(): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}

    def nodes_of(self, cell):
        ids = self.grid.GetCell(cell).GetPointIds()
        return [ids.GetId(i) for i in range(ids.GetNumberOfIds())]

    def unit(self, name):
        array = self.grid.GetPointData().GetArray(name) or self.grid.GetCellData().GetArray(name)
        information = array.GetInformation()
        return information.Get(vtk.vtkDataArray.UNITS_LABEL()) if information.Has(vtk.vtkDataArray.UNITS_LABEL()) else ""


def check_cells(state, area, solids, lines):
    expect(set(state.types) == solids | lines, f"cell types {set(state.types)}")
    total = length = 0.0
    for cell, kind in enumerate(state.types):
        nodes = state.nodes_of(cell)
        xy = state.at[nodes][:, :2]
        corners = {3: 2, 21: 2, 5: 3, 22: 3, 69: 3}.get(kind, 4)
        sides = [(i, (i + 1) % corners) for i in range(corners)][: 1 if corners == 2 else corners]
        if kind in (21, 22, 23, 28):
            for k, (a, b) in enumerate(sides):
                off = numpy.abs(xy[corners + k] - (xy[a] + xy[b]) / 2).max()
                expect(off <= 1e-12, f"cell {cell}: node {corners + k} is {off:g} from the middle of its side")
        if corners == 2:
            length += numpy.hypot(*(xy[1] - xy[0]))
            continue
        one = sum(xy[a][0] * xy[b][1] - xy[b][0] * xy[a][1] for a, b in sides) / 2
        expect(one > 0.0, f"cell {cell}: area {one:g}")
        total += one
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(state.grid)
    sizes.Update()
    of_vtk = State.arrays(sizes.GetOutput().GetCellData())
    if area is None:  # the rectangle around the mesh
        size = state.at.max(axis=0) - state.at.min(axis=0)
        area = size[0] * size[1]
    near([total, of_vtk["Area"].sum()], [area, area], "sum of the areas of the cells")
    if lines:
        near([length, of_vtk["Length"].sum()], [1.4, 1.4], "sum of the lengths of the interfaces")


def check_nodes(state, out, stem):
    by_number = {int(row["node"]): row for row in last_step(rows(out / f"{stem}.nodes.csv"))}
    of = [by_number[int(n)] for n in state.points["node"].ravel()]
    for name, columns in (("displacement", ("ux", "uy")), ("external_force", ("load_x", "load_y")), ("reaction", ("reaction_x", "reaction_y"))):
        wanted = [[number(row[c] or "0") for c in columns] + [0.0] for row in of]  # blank: nothing is held
        near(state.points[name], wanted, name)
    near(state.at, [[number(row["x"]), number(row["y"]), 0.0] for row in of], "place")


def check_points(state, out, stem, lines):
    elements = state.cells["element"].ravel()
    line = numpy.array([kind in lines for kind in state.types])
    scale = numpy.abs(state.points["stress"][numpy.isfinite(state.points["stress"])]).max()
    of = means(last_step(rows(out / f"{stem}.points.csv")), ("stress_xx", "stress_yy", "stress_zz"))
    wanted = [math.nan if l else of[e].mean() for e, l in zip(elements, line)]
    near(state.cells["mean_stress"].ravel(), wanted, "mean_stress", scale)
    level = means(last_step(rows(out / f"{stem}.points.csv")), ("stress_level",))
    near(state.cells["stress_level"].ravel()[~line], [level[e][0] for e in elements[~line]], "stress_level", 1.0)
    if not lines:
        return
    columns = ("shear", "normal", "relative_shear", "relative_normal")
    of = means(last_step(rows(out / f"{stem}.interfaces.csv")), columns)
    for k, column in enumerate(columns):
        wanted = [of[e][k] if l else math.nan for e, l in zip(elements, line)]
        near(state.cells[f"interface_{column}"].ravel(), wanted, column, scale if k < 2 else 0.0)


def check_meshio(state, file):
    mesh = meshio.read(file)
    kinds = {block.type for block in mesh.cells}
    expect(kinds == {MESHIO.get(kind, meshio._vtk_common.vtk_to_meshio_type.get(kind)) for kind in state.types}, f"meshio finds {kinds}")
    near(mesh.points, state.at, "points of meshio")
    for name, values in state.points.items():
        near(numpy.reshape(mesh.point_data[name], values.shape), values, f"{name} of meshio")
    for name, values in state.cells.items():
        found = numpy.concatenate(mesh.cell_data[name])
        near(numpy.reshape(found, values.shape), values, f"{name} of meshio")


def check_times(folder, out, stem):
    """Of a specimen that is pushed in: the strain of its report; what stands in the PVD and in each file."""
    import xml.etree.ElementTree as xml

    strains = {(r["stage"], r["increment"]): number(r["axial_strain"]) for r in rows(out / f"{stem}.report1.csv")}
    factors = {(r["stage"], r["increment"]): number(r["load_factor"]) for r in rows(out / f"{stem}.increments.csv")}
    sets = xml.parse(out / f"{stem}.pvd").getroot().findall(".//DataSet")
    expect(len(sets) > 0, "the PVD lists nothing")
    before = -math.inf
    for one in sets:
        time = float(one.get("timestep"))
        expect(time > before, f"time {time} after {before}")
        before = time
        state = State(out / one.get("file"))
        at = str(state.field["stage"][0]), str(state.field["increment"][0])
        near(state.field["load_factor"], [factors[at]], "load factor")
        near(state.field["TimeValue"], [time], "time of the file", 1.0)
        expect(state.times and abs(state.times[0] - time) < 1e-8, f"VTK's time {state.times}")
        if at in strains:
            near([time], [strains[at]], "time against strain", 1.0)
        else:
            expect(time <= 0.0, f"time {time} before the report's stage")


def results(program, source, folder, deck, options):
    """The last state of a run, its file, the folder and the stem of its files."""
    out = pathlib.Path(folder) / "out"
    path = source / "legacy_inputs" / deck
    command = [program, "run", path, "-o", out, "--vtu", "--nodes", "--points", "-q", *options]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    expect(done.returncode == 0, f"{command}: exit code {done.returncode}\n{done.stderr}")
    stem = path.parent.name if path.stem == "deck" else path.stem
    files = sorted(out.glob(f"{stem}_*.vtu"))
    return State(files[-1]), files, out, stem


def check_beams(program, source, folder):
    """The pipe of a culvert: section forces with their values, and nothing of what only soil has."""
    state, _, out, stem = results(program, source, folder, *BEAMS)
    elements, line = state.cells["element"].ravel(), numpy.array([kind == 3 for kind in state.types])
    columns = ("axial_force", "shear_force", "bending_moment")
    of = means(last_step(rows(out / f"{stem}.structures.csv")), columns)
    expect(line.sum() == len(of) > 10, f"{line.sum()} lines of {len(of)} beams")
    for k, column in enumerate(columns):
        values = state.cells[column].ravel()
        near(values, [of[e][k] if l else math.nan for e, l in zip(elements, line)], column, numpy.nanmax(numpy.abs(values)))
    for name in ("mean_stress", "principal_stress", "principal_angle", "principal_direction_1"):
        known = numpy.isfinite(state.cells[name]).reshape(len(line), -1).all(axis=1)
        expect((known == ~line).all(), f"{name} is known in {known[line].sum()} beams and {known[~line].sum()} of {(~line).sum()} solids")


def check_bounds(program, source, folder):
    """Fields of bounds, beside bounds.fields.csv; six-node triangles that fill the outline of the slope."""
    path = source / "legacy_inputs" / BOUNDS
    done = subprocess.run([program, "bounds", path, "--elements", "0", "--coarsen", "-o", folder, "-q"], capture_output=True, text=True)
    expect(done.returncode == 0, f"bounds: exit code {done.returncode}\n{done.stderr}")
    file = pathlib.Path(folder) / "one_to_one_line.bounds.vtu"
    state = State(file)
    check_cells(state, SLOPE, {22}, set())
    table = rows(pathlib.Path(folder) / "one_to_one_line.bounds.fields.csv")
    expect(len(table) == 3 * len(state.types) > 0, f"{len(table)} corners of {len(state.types)} triangles")
    for k, row in enumerate(table):
        point = 6 * (k // 3) + k % 3
        near(state.at[point][:2], [number(row["x"]), number(row["y"])], "corner")
        near(state.points["velocity"][point], [number(row["velocity_x"]), number(row["velocity_y"]), 0.0], "velocity", 1.0)
        for name in ("stress_xx", "stress_yy", "stress_xy"):
            near([state.points[name].ravel()[point]], [number(row[name])], name, 100.0)
    expect(abs(state.cells["part_of_gap"].sum() - 1.0) < 1e-9, "parts of the gap")
    expect(state.points["pore_pressure"].max() > 1.0, "no water")
    check_meshio(state, file)


def check(program, source, folder, case):
    deck, area, options, solids, lines = case
    state, files, out, stem = results(program, source, folder, deck, options)
    check_cells(state, area, solids, lines)
    check_nodes(state, out, stem)
    check_points(state, out, stem, lines)
    check_meshio(state, files[-1])
    if deck.startswith("chapter7"):
        check_times(folder, out, stem)
        units = {name: state.unit(name) for name in ("stress", "displacement", "strain", "interface_shear", "node")[: 3 if not lines else 5]}
        expected = {"stress": "psi, compression positive", "displacement": "in, positive along the axes", "strain": "compression positive", "interface_shear": "psi, compression positive", "node": ""}
        expect(all(expected[name] == text for name, text in units.items()), f"units {units}")


def main():
    program, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    failed = 0
    checks = [(f"{case[0]} {' '.join(case[2])}", functools.partial(check, case=case)) for case in CASES]
    for name, one in [*checks, (BEAMS[0], check_beams), (BOUNDS + ", bounds", check_bounds)]:
        with tempfile.TemporaryDirectory() as folder:
            try:
                one(program, source, folder)
                print(f"passed: {name}")
            except AssertionError as error:
                failed += 1
                print(f"FAILED: {name}: {error}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
