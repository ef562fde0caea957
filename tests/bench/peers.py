"""The benchmark's scenes in CalculiX (ccx), FreeFEM (FreeFem++-nw) and dolfinx, one job a file, as small as each allows."""
import dataclasses
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys

from measure import Job
import scenes

CCX = shutil.which("ccx")
FREEFEM = shutil.which("FreeFem++-nw") or shutil.which("FreeFem++")


def python_with(module):
    """An interpreter that has the module: this one, or Debian's."""
    for python in (sys.executable, "/usr/bin/python3"):
        if shutil.which(python) and subprocess.run([python, "-c", f"import {module}"], capture_output=True).returncode == 0:
            return python
    return None


DOLFINX = python_with("dolfinx")


def versions():
    found = {}
    if DOLFINX:
        text = "import dolfinx, petsc4py.PETSc as p; print(dolfinx.__version__, 'with PETSc', '.'.join(map(str, p.Sys.getVersion())))"
        found["dolfinx"] = subprocess.run([DOLFINX, "-c", text], capture_output=True, text=True).stdout.strip()
    if CCX:
        text = subprocess.run([CCX, "-v"], capture_output=True, text=True).stdout
        found["CalculiX"] = re.search(r"Version\s+(\S+)", text).group(1)
    if FREEFEM:
        text = subprocess.run([FREEFEM, "-v", "0"], capture_output=True, text=True)
        match = re.search(r"version\s*:?\s*([\d.]+)", text.stdout + text.stderr)
        found["FreeFEM"] = match.group(1) if match else "?"
    return found


# --------------------------------------------------------------------------------------------------- CalculiX


def ccx_elements(scene):
    """Names, and whether they have middle nodes."""
    prefix = "CAX" if scene.geometry == 2 else "CPE"
    return [(prefix + "4", False), (prefix + "8", True), (prefix + "8R", True)]


def ccx_can(scene):
    """No Tresca law; the strip's collapse load is that of von Mises with the same strength in shear."""
    return scene.data["family"] != "footing" or scene.geometry == 1


def ccx_deck(scene, n, element, quadratic):
    b = scene.block(n, quadratic)
    family = scene.data["family"]
    inner = lambda node: quadratic and (node - 1) % b.across % 2 == 1 and (node - 1) // b.across % 2 == 1
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{k}, {x:.15g}, {y:.15g}, 0." for k, (x, y) in enumerate(b.coordinates(), 1) if not inner(k)]
    lines.append(f"*ELEMENT, TYPE={element}, ELSET=EALL")
    number = 0
    for j in range(b.rows):
        for i in range(b.columns):
            number += 1
            if quadratic:
                n_ = lambda a, c: b.node(2 * i + a, 2 * j + c)
                nodes = [n_(0, 0), n_(2, 0), n_(2, 2), n_(0, 2), n_(1, 0), n_(2, 1), n_(1, 2), n_(0, 1)]
            else:
                nodes = [b.node(i, j), b.node(i + 1, j), b.node(i + 1, j + 1), b.node(i, j + 1)]
            lines.append(", ".join(str(v) for v in [number, *nodes]))
    young, nu = scene.law[1][:2]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{young!r}, {nu!r}"]
    if family == "footing":
        lines += ["*PLASTIC", f"{math.sqrt(3) * scene.law[1][2]!r}, 0."]
    lines += ["*SOLID SECTION, ELSET=EALL, MATERIAL=M"] + (["1."] if scene.geometry == 1 else [])
    held = [(node, x, y) for nodes, x, y in scene.fixities(b) for node in nodes]
    moved = [(node, *rest) for nodes, *rest in scene.moved(b) for node in nodes]
    lines.append("*BOUNDARY")
    for node, x, y in held:
        lines += [f"{node}, {k}, {k}, 0." for k, code in ((1, x), (2, y)) if code]
    watched = scene.report(b)[1]
    lines.append("*NSET, NSET=WATCHED")
    lines += [f"{node}," for node in watched]
    # As many increments as the other programs take, or more where it cuts them.
    nonlinear = family == "footing"
    lines += ["*STEP, INC=1000", "*STATIC"]
    lines += [f"{1 / scene.increments!r}, 1., 1e-5, {1 / scene.increments!r}"] if nonlinear else []
    if moved:
        lines.append("*BOUNDARY")
        for node, x, y, dx, dy in moved:
            lines += [f"{node}, {k}, {k}, {v!r}" for k, code, v in ((1, x, dx), (2, y, dy)) if code]
    if family == "lame":
        lines += ["*DLOAD"] + [f"{element_}, P{edge}, {p!r}" for element_, edge, p, _ in scene.pressed(b)]
    if family == "cook":
        force = {}
        shares = (1 / 6, 4 / 6, 1 / 6) if quadratic else (0.5, 0.5)
        for j in range(b.rows):
            for k, share in enumerate(shares):
                node = b.node(b.across - 1, (len(shares) - 1) * j + k)
                force[node] = force.get(node, 0.0) + share / b.rows
        lines += ["*CLOAD"] + [f"{node}, 2, {value!r}" for node, value in force.items()]
    wanted = "RF" if family in ("pinned", "footing") else "U"
    totals = ", TOTALS=ONLY" if wanted == "RF" else ""
    lines += [f"*NODE PRINT, NSET=WATCHED{totals}", wanted, "*END STEP", ""]
    return "\n".join(lines)


def ccx_value(scene, text):
    """From the .dat file: the last line with three numbers behind it."""
    rows = [row.split() for row in text.splitlines() if re.match(r"\s*(\d+\s+)?[-+]?\d+\.\d*E", row)]
    last = [float(v) for v in rows[-1][-3:]]
    if scene.data["family"] == "pinned":
        # Rings are wedges of two degrees: forces are those of 1/180 of the circle.
        area = math.pi * scenes.RADIUS**2
        return 180 * abs(last[1]) / area / (scenes.YOUNG * scenes.STRAIN)
    if scene.data["family"] == "footing":
        return abs(last[1])
    return last[0] if scene.data["family"] == "lame" else last[1]


def ccx_job(scene, n, element, quadratic, folder):
    name = f"{scene.name}_{element}_{n}"
    (folder / f"{name}.inp").write_text(ccx_deck(scene, n, element, quadratic))

    def find(text):
        if "Job finished" not in text:
            raise ValueError("did not finish")
        return ccx_value(scene, (folder / f"{name}.dat").read_text())

    return Job((scene.name, "CalculiX", element, str(n)), [CCX, name], find)


def ccx_graded_job(scene, n, power, folder):
    """CAX8R, n x n cells that get finer towards the corner of the end."""
    height = scene.data["height"]
    finer = lambda s: 1 - (1 - s) ** power
    place = lambda s, t: (scenes.RADIUS * finer(s), height * finer(t))
    graded = dataclasses.replace(scene, name=f"{scene.name}_power_{power}", block=lambda m, quadratic: scenes.Block(m, m, place, quadratic))
    job = ccx_job(graded, n, "CAX8R", True, folder)
    return Job((scene.name, "CalculiX", "CAX8R graded", f"{n} x {n}, power {power}"), job.command, job.find)


# --------------------------------------------------------------------------------------------------- FreeFEM

AXISYMMETRIC = """
func r = x;
macro eps(u, v) [dx(u), dy(v), u/r, (dy(u)+dx(v))] //
"""
PLANE = """
func r = 1./(2*pi);
macro eps(u, v) [dx(u), dy(v), (0.*u), (dy(u)+dx(v))] //
"""
COMMON = """
fespace Vh(Th, [{space}, {space}]);
Vh [u, v], [uu, vv];
real E = {young}, nu = {nu}, la = E*nu/((1+nu)*(1-2*nu)), mu = E/(2*(1+nu));
macro sig(u, v) [(la+2*mu)*eps(u,v)[0]+la*(eps(u,v)[1]+eps(u,v)[2]), (la+2*mu)*eps(u,v)[1]+la*(eps(u,v)[0]+eps(u,v)[2]),
  (la+2*mu)*eps(u,v)[2]+la*(eps(u,v)[0]+eps(u,v)[1]), mu*eps(u,v)[3]] //
solve elastic([u, v], [uu, vv], solver=sparsesolver)
  = int2d(Th)(2*pi*r*(sig(u,v)'*eps(uu,vv))) {load};
"""
TAILS = {
    "pinned": "cout.precision(12); cout << \"ANSWER \" << int2d(Th)(2*pi*r*(sig(u,v)'*eps(u,v)))/{moved}/{scale} << endl;",
    "lame": 'cout.precision(12); cout << "ANSWER " << u(1.,0.25) << endl;',
    "cook": 'cout.precision(12); cout << "ANSWER " << v(48.,60.) << endl;',
}


def freefem_can(scene):
    return scene.data["family"] in TAILS  # no law of plasticity is built in


def towards_end(variable, power):
    """Of [0, 1] onto itself, finer towards 1."""
    return f"(1-(1-{variable})^{power})"


def towards_both_ends(variable, power):
    return f"({variable}<0.5 ? 0.5*(2*{variable})^{power} : 1-0.5*(2-2*{variable})^{power})"


def freefem_script(scene, columns, rows, space, power=1):
    """power: 1 a uniform mesh; more, one that gets finer towards the singular corners as that power of the place."""
    family = scene.data["family"]
    young, nu = scene.law[1]
    head = AXISYMMETRIC if scene.geometry == 2 else PLANE
    if family == "pinned":
        height = scene.data["height"]
        x, y = towards_end("x", power), towards_end("y", power)
        load = f"+ on(1, v=0) + on(4, u=0) + on(3, u=0, v=-{scenes.STRAIN * height!r})"
        place = f"[{scenes.RADIUS!r}*{x}, {height!r}*{y}]"
    elif family == "lame":
        place = "[1+x, 0.5*y]"
        load = "- int1d(Th, 4)(2*pi*r*uu) + on(1, 3, v=0)"
    else:
        x, y = towards_both_ends("x", power), towards_both_ends("y", power)
        place = f"[48*{x}, 44*{x}*(1-{y})+(44+16*{x})*{y}]"
        load = "- int1d(Th, 2)(vv/16) + on(4, u=0, v=0)"
    tail = TAILS[family]
    if family == "pinned":
        scale = math.pi * scenes.RADIUS**2 * scenes.YOUNG * scenes.STRAIN
        tail = tail.replace("{moved}", repr(scenes.STRAIN * height)).replace("{scale}", repr(scale))
    mesh = f"mesh Th = square({columns}, {rows}, {place});"
    text = COMMON.format(space=space, young=repr(young), nu=repr(nu), load=load)
    return mesh + head + text + tail + "\n"


def freefem_answer(text):
    found = re.search(r"ANSWER\s+(\S+)", text)
    if not found:
        raise ValueError("no answer")
    return float(found.group(1))


def freefem_job(scene, n, space, folder):
    path = folder / f"{scene.name}_{space}_{n}.edp"
    b = scene.block(n, False)
    path.write_text(freefem_script(scene, b.columns, b.rows, space))
    return Job((scene.name, "FreeFEM", space, str(n)), [FREEFEM, "-v", "0", "-nw", str(path)], freefem_answer)


def freefem_graded_job(scene, n, space, power, folder):
    """n x n cells, each cut into two triangles: the corner's are as slender as the specimen."""
    path = folder / f"{scene.name}_{space}_{n}_{power}.edp"
    path.write_text(freefem_script(scene, n, n, space, power))
    labels = (scene.name, "FreeFEM", f"{space} graded", f"{n} x {n}, power {power}")
    return Job(labels, [FREEFEM, "-v", "0", "-nw", str(path)], freefem_answer)


# --------------------------------------------------------------------------------------------------- dolfinx


def dolfinx_job(scene, n, repeats, *options):
    """The answer is what dolfinx_peer.py prints, a dict."""
    script = pathlib.Path(__file__).with_name("dolfinx_peer.py")

    def find(text):
        lines = [line for line in text.splitlines() if line.startswith("{")]
        if not lines:
            raise ValueError("no answer")
        return json.loads(lines[-1])

    command = [DOLFINX, str(script), scene, str(n), "--repeats", str(repeats), *options]
    return Job((scene, "dolfinx", " ".join(options), str(n)), command, find)
