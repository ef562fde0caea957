"""Scenes with known answers for the work-precision benchmark, as decks of any fineness.

A scene is a block of columns x rows of quadrilaterals with a report whose last value is compared with the
reference.  Decks have ten-column integers (a layout made from sage1 by rule), because five columns end at 99999.
"""
import dataclasses
import math
import pathlib
import re

from measure import markdown

ROOT = pathlib.Path(__file__).resolve().parents[2]


def wide_layout():
    """sage1 with ten columns for every integer and twenty for every real number."""
    text = (ROOT / "legacy_inputs/layouts/sage1.toml").read_text()
    wider = lambda m: m.group(0).replace("I5", "I10").replace("F10.0", "F20.0")
    text = re.sub(r'format = "[^"]*"', wider, text)
    return text.replace('name = "sage1"', 'name = "wide"', 1).replace("record_length = 80", "record_length = 240")


def real(x):
    """With the point that a FORMAT wants."""
    text = f"{x:.14g}"
    return text if any(c in text for c in ".e") else text + "."


class Columns:
    """Widths of integers and real numbers; a number that does not fit is an OverflowError."""

    def __init__(self, integer, real):
        self.integer, self.real = integer, real

    def line(self, *fields):
        texts = [(str(f), self.integer) if isinstance(f, int) else (real(f), self.real) for f in fields]
        if any(len(text) > width for text, width in texts):
            raise OverflowError(f"{fields} in columns of {self.integer} and {self.real}")
        return "".join(f"{text:>{width}}" for text, width in texts)


@dataclasses.dataclass
class Block:
    """Corner nodes of columns x rows cells, from the left and from below; with middle nodes every second counts."""

    columns: int
    rows: int
    place: object  # (s, t) in [0, 1]^2 -> (x, y)
    quadratic: bool = False

    @property
    def across(self):
        return (2 if self.quadratic else 1) * self.columns + 1

    @property
    def up(self):
        return (2 if self.quadratic else 1) * self.rows + 1

    def node(self, i, j):
        return j * self.across + i + 1

    def coordinates(self):
        """Middle nodes lie half way: sides are straight."""
        step = 2 if self.quadratic else 1
        for j in range(self.up):
            for i in range(self.across):
                corners = [
                    self.place(a / self.columns, b / self.rows)
                    for a in {i // step, -(-i // step)}
                    for b in {j // step, -(-j // step)}
                ]
                yield tuple(sum(c[k] for c in corners) / len(corners) for k in (0, 1))

    def bottom(self):
        return [self.node(i, 0) for i in range(self.across)]

    def top(self):
        return [self.node(i, self.up - 1) for i in range(self.across)]

    def left(self):
        return [self.node(0, j) for j in range(self.up)]

    def right(self):
        return [self.node(self.across - 1, j) for j in range(self.up)]

    def elements(self):
        """Quadrilaterals of four nodes, or triangles of six: lists of nodes, counter-clockwise."""
        if not self.quadratic:
            for j in range(self.rows):
                for i in range(self.columns):
                    yield [self.node(i, j), self.node(i + 1, j), self.node(i + 1, j + 1), self.node(i, j + 1)]
            return
        for j in range(0, 2 * self.rows, 2):
            for i in range(0, 2 * self.columns, 2):
                n = lambda a, b: self.node(i + a, j + b)
                yield [n(0, 0), n(2, 0), n(2, 2), n(1, 0), n(2, 1), n(1, 1)]
                yield [n(0, 0), n(2, 2), n(0, 2), n(1, 1), n(1, 2), n(0, 1)]

    def corner_triangles(self):
        """The same triangles by their corners, of a block without middle nodes."""
        for a, b, c, d in self.elements():
            yield [a, b, c]
            yield [a, c, d]

    def element(self, i, j):
        """Number of a quadrilateral."""
        return j * self.columns + i + 1


@dataclasses.dataclass
class Scene:
    name: str
    title: str
    geometry: int  # 1 plane strain, 2 axisymmetric
    law: tuple  # code, parameters
    block: object  # (n, quadratic) -> Block
    fixities: object  # block -> [(nodes, x, y)]
    moved: object  # block -> [(nodes, x code, y code, x, y)]
    pressed: object  # block -> [(element, edge, pressure, shear)]; edge of the quadrilateral
    report: object  # block -> (kind, nodes, height)
    column: object  # of the report that holds the answer
    answer: object  # value of the column -> the quantity
    reference: float
    increments: int = 1
    tolerance: float = 0.0  # of the iteration; 0 = the program's own
    sizes: tuple = (4, 8, 16, 32)
    data: dict = dataclasses.field(default_factory=dict)  # for the peers


def deck(scene, n, kind="quad"):
    """Text of the deck and the layout it is in: the built-in one where its columns hold all digits, else the wide one.

    kind: quad (replaced by --element), tri6, or tri15 (whose other nodes the program makes).
    """
    try:
        return write_deck(scene, n, kind, Columns(5, 10)), "sage1"
    except OverflowError:
        return write_deck(scene, n, kind, Columns(10, 20)), "wide.toml"


def write_deck(scene, n, kind, columns):
    line = columns.line
    tri = kind != "quad"
    b = scene.block(n, kind == "tri6")
    elements = list(b.corner_triangles() if kind == "tri15" else b.elements())
    fixed = [(node, x, y) for nodes, x, y in scene.fixities(b) for node in nodes]
    moved = [(node, *rest) for nodes, *rest in scene.moved(b) for node in nodes]
    pressed = scene.pressed(b)
    report_kind, nodes, height = scene.report(b)
    step = nodes[1] - nodes[0] if len(nodes) > 1 else 1
    code, parameters = scene.law
    lines = [
        f"{scene.title}, n = {n}",
        "m       kN      kPa     " + line(100.0, 10.0),
        line(scene.geometry, 0, b.across * b.up, 0, 1, 1, len(elements), len(fixed), 0, 1, 1, 0, 0),
    ]
    lines += [line(k, 0, 0, x, y) for k, (x, y) in enumerate(b.coordinates(), 1)]
    lines += [line(1, code, len(parameters), 0.0) + scene.name[:20]]
    lines += [line(*parameters[k : k + 8]) for k in range(0, len(parameters), 8)]
    lines += [line(1, {"quad": 1, "tri6": 4, "tri15": 6}[kind], 1, 1) + scene.name[:20]]
    lines += [line(k, 1, *e) for k, e in enumerate(elements, 1)]
    lines += [line(*f[:1], 0, 0, *f[1:]) for f in fixed]
    lines += ["Loading", line(scene.increments, 0, 0, 0, len(moved), 0, len(pressed), 0, 0, 0) + (line(0.0, 0.0, scene.tolerance) if scene.tolerance else "")]
    lines += [line(m[0], 0, 0, *m[1:]) for m in moved]
    for element, edge, pressure, shear in pressed:
        if tri:  # edges 1, 2 belong to the lower triangle, 3, 4 to the upper one
            element, edge = (2 * element - 1, edge) if edge < 3 else (2 * element, edge - 1)
        lines.append(line(element, edge, 0, 0, pressure, pressure, shear, shear))
    lines += [line(report_kind, 1, nodes[0], nodes[-1], step, 1, height, 0.0, 0.0), "END", ""]
    return "\n".join(lines)


def rectangle(width, height):
    return lambda s, t: (width * s, height * t)


# ------------------------------------------------------------------------------------------------- the scenes

RADIUS, STRAIN, YOUNG = 1.4, 0.01, 3000.0


def pinned(slenderness, nu, reference):
    """Quarter of an elastic cylinder between rough ends; the ratio of measured to free stiffness."""
    height = RADIUS * slenderness
    return Scene(
        name=f"pinned_ld{slenderness}_nu{str(nu)[2:]}",
        title=f"Pinned cylinder, L/D = {slenderness}, nu = {nu}",
        geometry=2,
        law=(1, (YOUNG, nu)),
        block=lambda n, quadratic: Block(n, slenderness * n, rectangle(RADIUS, height), quadratic),
        fixities=lambda b: [(b.bottom(), 0, 1), (b.left(), 1, 0)],
        moved=lambda b: [(b.top(), 1, 1, 0.0, -STRAIN * height)],
        pressed=lambda b: [],
        report=lambda b: (1, b.top(), height),
        column="ratio",
        answer=lambda value: value,
        reference=reference,
        sizes=(7, 14, 28, 56, 112),
        data=dict(family="pinned", height=height, nu=nu, slenderness=slenderness, grade="auto"),
    )


def lame(nu):
    """Thick ring, a = 1, b = 2, u_z = 0, pressure 1 inside, E = 1: displacement of the inner face."""
    return Scene(
        name="lame_nu" + str(nu)[2:],
        title=f"Thick cylinder (Lame), nu = {nu}",
        geometry=2,
        law=(1, (1.0, nu)),
        block=lambda n, quadratic: Block(n, max(1, n // 2), lambda s, t: (1.0 + s, 0.5 * t), quadratic),
        fixities=lambda b: [(b.bottom(), 0, 1), (b.top(), 0, 1)],
        moved=lambda b: [],
        pressed=lambda b: [(b.element(0, j), 4, 1.0, 0.0) for j in range(b.rows)],
        report=lambda b: (2, [b.node(0, b.up // 2)], 0.0),
        column="ux",
        answer=lambda value: value,
        reference=(1 + nu) / 3 * ((1 - 2 * nu) + 4),
        sizes=(4, 8, 16, 32, 64),
        data=dict(family="lame", nu=nu),
    )


def cook():
    """Cook's membrane in plane strain, E = 1, nu = 1/3, shear force 1: rise of the top corner."""
    place = lambda s, t: (48 * s, 44 * s * (1 - t) + (44 + 16 * s) * t)
    return Scene(
        name="cook",
        title="Cook's membrane, plane strain, nu = 1/3",
        geometry=1,
        law=(1, (1.0, 1.0 / 3.0)),
        block=lambda n, quadratic: Block(n, n, place, quadratic),
        fixities=lambda b: [(b.left(), 1, 1)],
        moved=lambda b: [],
        pressed=lambda b: [(b.element(b.columns - 1, j), 2, 0.0, 1.0 / 16) for j in range(b.rows)],
        report=lambda b: (2, [b.node(b.across - 1, b.up - 1)], 0.0),
        column="uy",
        answer=abs,
        reference=22.61049,
        sizes=(8, 16, 32, 64, 128),
        data=dict(family="cook", grade="auto"),
    )


def footing(geometry, rough, reference, law=(4, (298.0, 0.49, 1.0, 0.0, 0.0)), power=2.2):
    """Rigid footing of half width or radius 1 on Tresca clay with c = 1: mean pressure at a settlement of .15.

    power: of the place, as which the cells get finer towards the edge of the footing; 1 = uniform.
    """
    width, depth = (4.0, 3.0) if geometry == 1 else (2.5, 2.0)

    def block(n, quadratic):
        out = n + n // 6 if geometry == 1 else n
        down = n + n // 4

        def place(s, t):
            p = s * (n + out)
            x = 1 - (1 - p / n) ** power if p <= n else 1 + width * ((p - n) / out) ** power
            return x, -depth * (1 - t) ** power

        return Block(n + out, down, place, quadratic)

    def base(b):
        x = [x for x, _ in b.coordinates()][: b.across]
        return [node for node, at in zip(b.top(), x) if at <= 1 + 1e-9]

    return Scene(
        name=("strip" if geometry == 1 else "circle") + ("_rough" if rough else "_smooth"),
        title=("Strip" if geometry == 1 else "Circular") + " footing on clay, " + ("rough" if rough else "smooth"),
        geometry=geometry,
        law=law,
        block=block,
        fixities=lambda b: [(b.bottom(), 1, 1), (b.left(), 1, 0), (b.right(), 1, 0)],
        moved=lambda b: [(base(b), 1 if rough else 0, 1, 0.0, -0.15)],
        pressed=lambda b: [],
        report=lambda b: (2, base(b), 0.0),
        column="fy",
        answer=lambda value: abs(value) / (1.0 if geometry == 1 else math.pi),
        reference=reference,
        increments=12,
        sizes=(4, 8, 12, 16),
        data=dict(family="footing", rough=rough),
    )


WHAT_IS_COMPARED = (
    "Each problem has one result. Its error is the relative error |value / reference - 1|. The number n gives the size of the elements. "
    "The *ratio* of a pinned specimen is the mean stress on its rough ends, divided by that of a specimen with smooth ends."
)


def problems():
    """Table of the problems: what they are, their meshes, and the result whose error is given."""
    reference = {scene.name: scene.reference for scene in scenes()}
    pinned_names = [name for name in reference if name.startswith("pinned")]
    lame_name = next(name for name in reference if name.startswith("lame"))
    rows = [
        (", ".join(f"`{name}`" for name in pinned_names), "quarter of an elastic cylinder between rough rigid ends, shortened by 1 %: length over diameter 1 or 2, nu = .25 or .495. The stress is singular at the rim of the end",
         "n elements along the radius, n or 2n along half the height", "ratio: " + ", ".join(f"{reference[name]:.9f}" for name in pinned_names) + " (converged, [accuracy](theory/accuracy.md))"),
        (f"`{lame_name}`", "thick elastic ring with radii 1 and 2, E = 1, no axial strain, pressure 1 inside", "n elements along the radius", f"displacement of the inner face: {reference[lame_name]:.7g} (Lame)"),
        ("`cook`", "Cook's membrane in plane strain, E = 1, nu = 1/3, shear force 1. The stress is singular at corners of the clamped side", "n x n elements", f"vertical displacement of the upper free corner: {reference['cook']:.7g} (converged)"),
        ("`strip_smooth`, `strip_rough`", "rigid strip footing on clay, Tresca with c = 1, half width 1, smooth or rough base", "n elements under the half width, smaller towards the edge of the footing", "mean pressure at a settlement of .15: 2 + pi (Prandtl)"),
        ("`circle_smooth`, `circle_rough`", "rigid circular footing on the same clay, radius 1", "n elements under the radius, smaller towards the edge", f"mean pressure at a settlement of .15: {reference['circle_smooth']:g} and {reference['circle_rough']:g} (Cox, Eason & Hopkins 1961; Eason & Shield 1960)"),
    ]
    return markdown(["problem", "model", "mesh n", "result and its reference"], [list(row) for row in rows])


def scenes():
    return [
        pinned(1, 0.25, 1.036223249),
        pinned(1, 0.495, 1.190558066),
        pinned(2, 0.25, 1.017628765),
        pinned(2, 0.495, 1.086253987),
        lame(0.4999999),
        cook(),
        footing(1, False, 2 + math.pi),
        footing(1, True, 2 + math.pi),
        footing(2, False, 5.689),
        footing(2, True, 6.048),
    ]
