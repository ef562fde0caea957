"""Many cases of one deck."""

from __future__ import annotations

import csv
import io
import os
from typing import Any, Dict, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _sagefe

_WORDS = ("status", "warnings", "reason")


def _column(name: str, cells: Sequence[str]) -> NDArray[Any]:
    if name not in _WORDS:
        try:
            return np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError:  # names of things: "b-bar"
            pass
    return np.array(cells, dtype=str)


def sweep(
    study: Union[str, "os.PathLike[str]"],
    *,
    output: Union[str, "os.PathLike[str]"] = "out",
    jobs: int = 0,
    collect: Sequence[str] = (),
) -> Dict[str, NDArray[Any]]:
    """Computes all cases of a study (docs/manual/sweep.md) and returns the columns of its table.

    Numbers are float arrays with one entry per case, NaN where a cell is blank; ``status``, ``warnings``, ``reason`` and
    names of things are arrays of str.  Values have the deck's units and signs.  ``jobs``: cases at a time, 0 means one
    for each processor.  ``collect``: quantities beside those of the study.

    Finished cases are kept in ``output``: the same call after Ctrl-C or a kill computes only what is missing.  Cases
    without an answer are rows with their ``status`` and ``reason``.  Raises DeckError for mistakes in the study or deck,
    before the first case.
    """
    if jobs < 0:
        raise ValueError("jobs is 0 or the number of cases at a time")
    if isinstance(collect, str):
        raise TypeError("collect is a list of names")
    text = _sagefe.sweep(os.fspath(study), os.fspath(output), jobs, list(collect), _sagefe.__file__)
    lines = [line for line in csv.reader(io.StringIO(text)) if line and not line[0].startswith("#")]
    names, rows = lines[0], lines[1:]
    return {name: _column(name, [row[place] for row in rows]) for place, name in enumerate(names)}
