"""The quarter specimen between pinned ends, L/D = 2, of n x 2n quad4, as decks of any fineness: elastic in one increment, or
Drucker-Prager in sixty.

Decks are written with ten-column integers (a layout made from sage1 by rule), because five columns end at 99999.
"""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEPS, FRICTION = 60, 36.87  # increments and friction angle of the plastic specimen
PLASTIC_NU = 0.495


def wide_layout():
    """sage1 with ten columns for every integer."""
    text = (ROOT / "legacy_inputs/layouts/sage1.toml").read_text()
    text = re.sub(r'format = "([^"]*)"', lambda m: m.group(0).replace("I5", "I10"), text)
    return text.replace('name = "sage1"', 'name = "wide"', 1).replace("record_length = 80", "record_length = 160")


def card(*fields):
    return "".join(f"{f:10d}" if isinstance(f, int) else f"{f:>10}" for f in fields)


def cards(n, title, material, stage, stresses, ratios=()):
    """material: its cards; stage: the cards from its title on; stresses: number of initial-stress cards in front of it;
    ratios: last interval over the first, along the radius and the height."""
    across, rows = n + 1, 2 * n
    top = across * rows + 1
    return "\n".join(
        [
            f"{title}, {n} x {rows} Q4",
            "in      lbf     psi         14.696  0.036111",
            card(2, 0, 4, 1, 1, 1, 1, 2, stresses, 1, 1, 0, 0),
            card(1, 0, 0, "0.", "0."),
            card(across, 0, 0, "1.4", "0."),
            card(top, 0, 0, "0.", "2.8"),
            card(top + n, 0, 0, "1.4", "2.8"),
            card(1, n, 1, rows, across, *(str(float(ratio)) for ratio in ratios)),
            *material,
            card(1, 1, 1, 1) + "specimen",
            card(1, 1, 1, 2, across + 2, across + 1, 0, 0, 0, 0, n, rows, 1, across),
            card(1, across, 1, 0, 1),
            card(1, top, across, 1, 0),
            *stage,
            "END",
            "",
        ]
    )


def elastic(n, ratios=()):
    top = (n + 1) * 2 * n + 1
    stage = [
        "Axial compression of 1 % with the end held radially",
        card(1, 0, 0, 0, 1, 0, 0, 0, 0, 0),
        card(top, top + n, 1, 1, 1, "0.", "-0.028"),
        card(1, 1, top, top + n, 1, 1, "2.8", "", "0."),
    ]
    material = [card(1, 1, 2) + "          elastic specimen", "     3000.       .25"]
    return cards(n, "Pinned ends, L/D = 2, nu = .25", material, stage, 0, ratios)


def plastic(n, steps=STEPS):
    top = (n + 1) * 2 * n + 1
    material = [
        card(1, 3, 9) + "          Drucker-Prager",
        card("3000.", str(PLASTIC_NU), "0.", str(FRICTION), "0.", "1.", "1.", "-1."),
        card("1."),
    ]
    stage = [
        card(1, 0, "50.", "50.", "50."),
        f"Axial compression to 15 % in {steps} increments at a cell pressure of 50 psi",
        card(steps, 0, 0, 0, 1, 0, 1, 0, 0, 0),
        card(top, top + n, 1, 1, 1, "0.", "-0.42"),
        card(n, 2, 2 * n * n, n, "50.", "50."),
        card(1, 1, top, top + n, 1, 1, "2.8", "", "50."),
    ]
    return cards(n, "Pinned ends, L/D = 2, Drucker-Prager", material, stage, 1)
