#!/usr/bin/env python3
"""Reads what `sagefe run --msh` and `--msh-text` write, has meshio (Debian's python3-meshio) read the text and, where it is installed,
Gmsh (python3-gmsh) both, and compares with the CSV files.

Usage: msh_read_back.py SAGEFE SOURCE_FOLDER       exit code 77: a package is missing
"""
import math
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy
except ImportError as missing:
    print(f"skipped: {missing} (apt-get install python3-meshio)")
    sys.exit(77)
try:
    import gmsh
except ImportError:
    gmsh = None  # meshio and the reader below do

from csv_tables import expect, last_step, means, near, number, rows

FRICTION = "chapter7/friction_285_nu0495/deck.dat"
# Deck, options, Gmsh's types of solids and of lines, names of physical groups
NAMES = {"specimen", "interface_bottom=end interface", "interface_top=end interface", "fix_x", "fix_y"}
CASES = [
    (FRICTION, [], {3, 1}, NAMES),
    (FRICTION, ["--element", "quad8"], {16, 8}, NAMES),
    ("structures/raft/deck.dat", [], {16, 8}, {"raft"}),
    ("structures/pile/deck.dat", [], {3, 1}, set()),
    ("structures/braced_shaft/deck.dat", [], {3, 1, 15}, {"ring at 1 m", "ring at 6 m"}),
    ("smith_griffiths/p51_1.dat", ["--layout", "sg_p51"], {2, 1}, set()),
]


class Parsed:
    """What the file says, section by section, as Views has it: the views of the last step."""

    def __init__(self, file):
        self.places, self.names, self.views, self.lines = {}, set(), {}, {}
        self.types = set()
        lines = iter(file.read_text().splitlines())
        for line in lines:
            section = []
            for text in lines:
                if text.startswith("$End"):
                    break
                section.append(text)
            read = getattr(self, "read_" + line.lstrip("$"), None)
            if read:
                read(section)
            elif line in ("$NodeData", "$ElementData", "$ElementNodeData"):
                self.view(line[1:], section)

    def read_PhysicalNames(self, section):
        self.names = {line.split(" ", 2)[2].strip('"') for line in section[1:]}

    def read_Nodes(self, section):
        count = int(section[1].split()[3])
        for tag, place in zip(section[2 : 2 + count], section[2 + count :]):
            self.places[int(tag)] = numpy.array(place.split(), float)

    def read_Elements(self, section):
        at = 1
        while at < len(section):
            dimension, _, kind, count = (int(word) for word in section[at].split())
            self.types.add(kind)
            for row in section[at + 1 : at + 1 + count] if dimension < 2 else []:
                tag, *nodes = (int(word) for word in row.split())
                self.lines[tag] = (kind, nodes)
            at += count + 1

    def view(self, kind, section):
        name, time, rows_of = section[1].strip('"'), float(section[3]), section[8:]
        expect(len(rows_of) == int(section[7]), f"{name}: not as many rows as it says")
        first = 2 if kind == "ElementNodeData" else 1
        split = (row.split() for row in rows_of)
        self.views[name] = (kind, {int(row[0]): numpy.array(row[first:], float) for row in split}, time)


class Binary(Parsed):
    """The same of a binary file."""

    def __init__(self, file):
        self.places, self.names, self.views, self.lines = {}, set(), {}, {}
        self.types = set()
        self.bytes, self.at = file.read_bytes(), 0
        expect(self.bytes.startswith(b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n"), "the format is not that of Gmsh")
        while self.at < len(self.bytes):
            section = self.line()[1:]
            if section in ("NodeData", "ElementData", "ElementNodeData"):
                self.view(section, None)
            elif section in ("Nodes", "Elements", "Entities"):
                getattr(self, section.lower())()
            else:
                end = self.bytes.index(f"\n$End{section}\n".encode(), self.at)
                text = self.bytes[self.at : end].decode(errors="replace").splitlines()
                self.at = end + 1
                if section == "PhysicalNames":
                    self.read_PhysicalNames(text)
            if section in ("NodeData", "ElementData", "ElementNodeData", "Nodes", "Elements", "Entities"):
                expect(self.line() == "", f"{section} has other bytes than it says")
            expect(self.line() == f"$End{section}", f"{section} does not end where it should")

    def line(self):
        end = self.bytes.index(b"\n", self.at)
        text = self.bytes[self.at : end].decode()
        self.at = end + 1
        return text

    def take(self, kind, count):
        found = numpy.frombuffer(self.bytes, kind, count, self.at)
        self.at += found.nbytes
        return found

    def entities(self):
        counts = self.take("<u8", 4)
        expect(counts[3] == 0, "there are volumes")
        for dimension, count in enumerate(counts):
            for _ in range(count):
                tag = self.take("<i4", 1)[0]
                self.take("<f8", 3 if dimension == 0 else 6)
                expect(self.take("<u8", 1)[0] == 1 and self.take("<i4", 1)[0] == tag, "an entity has another group")
                expect(dimension == 0 or self.take("<u8", 1)[0] == 0, "an entity has bounds")

    def nodes(self):
        self.take("<u8", 4)
        self.take("<i4", 3)
        count = int(self.take("<u8", 1)[0])
        tags, places = self.take("<u8", count), self.take("<f8", 3 * count)
        self.places = dict(zip(tags.tolist(), places.reshape(-1, 3)))

    def elements(self):
        for _ in range(self.take("<u8", 4)[0]):
            dimension, _, kind = self.take("<i4", 3).tolist()
            self.types.add(kind)
            nodes = {1: 2, 8: 3, 15: 1, 2: 3, 3: 4, 9: 6, 16: 8, 10: 9}[kind]
            rows = self.take("<u8", int(self.take("<u8", 1)[0]) * (1 + nodes)).reshape(-1, 1 + nodes).tolist()
            if dimension < 2:
                self.lines.update((tag, (kind, of)) for tag, *of in rows)

    def view(self, kind, _):
        texts = [self.line() for _ in range(8)]
        name, time, numbers, count = texts[1].strip('"'), float(texts[3]), int(texts[6]), int(texts[7])
        values = {}
        for _ in range(count):
            tag = self.take("<i4", 1)[0]
            nodes = int(self.take("<i4", 1)[0]) if kind == "ElementNodeData" else 1
            values[int(tag)] = self.take("<f8", nodes * numbers)
        self.views[name] = (kind, values, time)


class Views:
    """What Gmsh finds: {name: (kind, {tag: numbers}, time)} of the last step."""

    def __init__(self, file):
        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.open(str(file))
            tags, places, _ = gmsh.model.mesh.getNodes()
            self.places = dict(zip(tags.tolist(), numpy.reshape(places, (-1, 3))))
            self.types = set(gmsh.model.mesh.getElementTypes())
            self.names = {gmsh.model.getPhysicalName(*group) for group in gmsh.model.getPhysicalGroups()}
            self.views = dict(self.view(tag) for tag in gmsh.view.getTags())
        finally:
            gmsh.finalize()

    @staticmethod
    def view(tag):
        index = gmsh.view.getIndex(tag)
        name = gmsh.option.getString(f"View[{index}].Name")
        last = int(gmsh.option.getNumber(f"View[{index}].NbTimeStep")) - 1
        kind, tags, data, time, _ = gmsh.view.getModelData(tag, last)
        return name, (kind, {t: numpy.array(d) for t, d in zip(tags.tolist(), data)}, time)


def check_against_csv(found, out, stem):
    nodes = {int(row["node"]): row for row in last_step(rows(out / f"{stem}.nodes.csv"))}
    # Of what was dug away there are nodes, but no values at the end.
    expect(set(found.places) == set(nodes) or "shaft" in stem and set(found.places) > set(nodes), "other nodes than the deck's")
    near([found.places[n] for n in nodes], [[number(r["x"]), number(r["y"]), 0.0] for r in nodes.values()], "places")
    for name, columns in (("displacement", ("ux", "uy")), ("reaction", ("reaction_x", "reaction_y"))):
        view = next(v for key, v in found.views.items() if key.startswith(name))
        wanted = [[number(r[c] or "0") for c in columns] + [0.0] for r in nodes.values()]
        near([view[1][n] for n in nodes], wanted, name)
    points = last_step(rows(out / f"{stem}.points.csv"))
    mean = means(points, ("stress_xx", "stress_yy", "stress_zz"))
    kind, values, _ = next(v for key, v in found.views.items() if key.startswith("mean_stress"))
    scale = max(abs(number(r[c])) for r in points for c in ("stress_xx", "stress_yy", "stress_zz"))
    expect(kind == "ElementData", f"mean stress is {kind}")
    near([values[e][0] for e in mean], [mean[e].mean() for e in mean], "mean_stress", scale)
    expect(all(math.isnan(v[0]) for e, v in values.items() if e not in mean), "a line has a mean stress")
    check_structures(found, out, stem)
    kind, values, _ = next(v for key, v in found.views.items() if re.split("[ ,]", key)[0] == "stress")
    if kind == "NodeData":
        check_stress(values, out, stem)
    else:
        expect(kind == "ElementNodeData" and set(values) == set(mean), "stress is not at the nodes of the solids")
    tables = out / f"{stem}.interfaces.csv"
    if not tables.exists():
        return
    columns = ("shear", "normal", "relative_shear", "relative_normal")
    of = means(last_step(rows(tables)), columns)
    for k, column in enumerate(columns):
        values = next(v for key, v in found.views.items() if key.split(" ")[0] == f"interface_{column}")[1]
        near([values[e][0] for e in of], [of[e][k] for e in of], column, scale if k < 2 else 0.0)


def check_stress(values, out, stem):
    """Of nodes that have one value each, as the last VTU file has it."""
    mesh = meshio.read(sorted(out.glob(f"{stem}_*.vtu"))[-1])
    node, stress = numpy.ravel(mesh.point_data["node"]).tolist(), mesh.point_data["stress"]
    expect(len(set(node)) == len(node) and set(values) == set(node), "stress is not at the nodes")
    near([values[n] for n in node], stress[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]], "stress", numpy.nanmax(numpy.abs(stress)))


def check_structures(found, out, stem):
    """Values at both ends of bars and beams, on lines through the nodes that the CSV file names."""
    tables = out / f"{stem}.ends.csv"
    if not tables.exists():
        return
    ends = last_step(rows(tables))
    for end in ("1", "2"):
        of = {int(row["element"]): row for row in ends if row["end"] == end}
        if isinstance(found, Parsed):
            at = {element: found.lines[element][1][int(end) - 1] for element in of}
            expect(at == {element: int(row["node"]) for element, row in of.items()}, f"lines have other ends {end}")
        for column in ("axial_force", "bending_moment"):
            view = next(v for key, v in found.views.items() if key.split(" ")[0] == f"{column}_ends_{end}")
            wanted = [number(row[column]) for row in of.values()]
            near([view[1][element][0] for element in of], wanted, f"{column}_ends_{end}")
            others = [v for element, v in view[1].items() if element not in of]
            expect(numpy.isnan(others).all(), f"{column}_ends_{end} of what is no structure")


def check_meshio(found, file):
    mesh = meshio.read(file)
    expect(len(mesh.points) == len(found.places), "meshio finds other nodes")
    for name, (kind, values, _) in found.views.items():
        if kind == "NodeData":
            wanted = numpy.array([values[n] for n in sorted(values)])
            near(numpy.reshape(mesh.point_data[name], wanted.shape), wanted, f"{name} of meshio")
        elif kind == "ElementData":
            data = numpy.concatenate([numpy.ravel(d) for d in mesh.cell_data[name]])
            wanted = numpy.concatenate(list(values.values()))
            near(numpy.sort(data), numpy.sort(wanted), f"{name} of meshio")


def check(program, source, out, case):
    deck, options, types, names = case
    path = source / "legacy_inputs" / deck
    stem = path.parent.name if path.stem == "deck" else path.stem
    for option, reader in (("--msh-text", Parsed), ("--msh", Binary)):
        command = [program, "run", path, "-o", out, option, "--nodes", "--points", "--vtu", "-q", *options]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        expect(done.returncode == 0, f"{command}: exit code {done.returncode}\n{done.stderr}")
        for found in (reader(out / f"{stem}.msh"), *([Views(out / f"{stem}.msh")] if gmsh else [])):
            expect(found.types == types, f"types {found.types}")
            expect(names <= found.names, f"physical groups {found.names}")
            check_against_csv(found, out, stem)
            if reader is Parsed:
                check_meshio(found, out / f"{stem}.msh")
            if deck == FRICTION:
                strain = number(last_step(rows(out / f"{stem}.report1.csv"))[0]["axial_strain"])
                near([time for _, _, time in found.views.values()], [strain] * len(found.views), "time")


def main():
    program, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    failed = 0
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            try:
                check(program, source, pathlib.Path(folder), case)
                print(f"passed: {case[0]} {' '.join(case[1])}")
            except AssertionError as error:
                failed += 1
                print(f"FAILED: {case[0]} {' '.join(case[1])}: {error}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
