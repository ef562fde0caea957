"""CSV files of results, as the scripts read them that compare other formats with them."""
import csv
import math

import numpy

# Ten digits are printed; means over points lose one.
DIGITS = 2e-9


def rows(file):
    with open(file, newline="") as stream:
        lines = csv.DictReader(line for line in stream if not line.startswith("#"))
        return [{name.split("[")[0]: value for name, value in line.items()} for line in lines]


def expect(condition, text):
    if not condition:
        raise AssertionError(text)


def near(found, wanted, what, scale=0.0):
    found, wanted = numpy.asarray(found, float), numpy.asarray(wanted, float)
    expect(found.shape == wanted.shape, f"{what}: shapes {found.shape} and {wanted.shape}")
    both = numpy.isfinite(wanted)
    expect((numpy.isfinite(found) == both).all(), f"{what}: not known in different places")
    bound = DIGITS * max(scale, numpy.abs(wanted[both]).max(initial=0.0))
    off = numpy.abs(found[both] - wanted[both]).max(initial=0.0)
    expect(off <= bound, f"{what}: {off:g} apart, allowed {bound:g}")


def number(text):
    return float(text) if text else math.nan


def last_step(table):
    last = table[-1]["stage"], table[-1]["increment"]
    return [row for row in table if (row["stage"], row["increment"]) == last]


def means(table, columns):
    """{element: mean over its points}"""
    of = {}
    for row in table:
        of.setdefault(int(row["element"]), []).append([number(row[c]) for c in columns])
    return {element: numpy.mean(values, axis=0) for element, values in of.items()}
