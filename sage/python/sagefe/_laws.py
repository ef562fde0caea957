"""Laws along laboratory paths, and laws written in Python."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _sagefe
from ._errors import AnalysisError

LawFunction = Callable[
    [Any, NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]], Any
]


class Curve:
    """A path of a law: columns as read-only arrays, a row for each step; compression positive, degrees."""

    def __init__(self, answer: Dict[str, Any]) -> None:
        self.columns: Dict[str, NDArray[np.float64]] = answer["columns"]
        self.units: Dict[str, str] = answer["units"]
        self.failure: str = answer["failure"]
        """Why the path ends early; empty if it does not."""

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if name not in self.columns:
            raise KeyError(f"the curve has no column {name}; there are: {', '.join(self.columns)}")
        return self.columns[name]

    def __getattr__(self, name: str) -> NDArray[np.float64]:
        if name.startswith("_") or name == "columns":
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self.columns]

    def __repr__(self) -> str:
        return f"<curve: {', '.join(self.columns)}; compression positive, degrees>"


class Law:
    """A law with its parameters, as decks give them: degrees, compression positive; E, nu, c, phi, psi for short."""

    def __init__(self, law: str, *, atmospheric_pressure: float = 0.0, water_unit_weight: float = 0.0,
                 **parameters: float) -> None:
        self.law = law
        self.parameters = {key: float(value) for key, value in parameters.items()}
        self.atmospheric_pressure = atmospheric_pressure
        self.water_unit_weight = water_unit_weight

    def with_(self, **parameters: float) -> "Law":
        """The same law with other parameters."""
        return Law(self.law, atmospheric_pressure=self.atmospheric_pressure,
                   water_unit_weight=self.water_unit_weight, **{**self.parameters, **parameters})

    def drive(self, test: str = "triaxial", *, strain: Optional[float] = None, to: Sequence[float] = (),
              cell: float = 0.0, start: Sequence[float] = (), undrained: bool = False, steps: int = 100,
              normal_stiffness: float = 0.0, history: Optional[Mapping[str, float]] = None,
              strict: bool = False) -> Curve:
        """Drives the law along a laboratory's path (``sagefe drive --list``) to the value(s) of what the test drives.

        "triaxial" is triaxial_compression, or triaxial_extension for a negative strain.  ``cell``: pressure at the
        start, all round (across a joint).  ``strict``: raise AnalysisError where the path ends early.
        """
        turns = list(to) if strain is None else [strain, *to]
        if not turns:
            raise TypeError("drive() needs a strain (or values in `to`) to go to")
        if test == "triaxial":
            test = "triaxial_extension" if turns[0] < 0 else "triaxial_compression"
            if test == "triaxial_extension":
                turns = [-one for one in turns]
        curve = Curve(
            _sagefe.drive(self.law, list(self.parameters.items()), test, cell, list(start), turns, undrained, steps,
                          normal_stiffness, list((history or {}).items()), self.atmospheric_pressure,
                          self.water_unit_weight)
        )
        if strict and curve.failure:
            raise AnalysisError("S501", curve.failure)
        return curve

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value:g}" for name, value in self.parameters.items())
        return f"Law({self.law!r}, {values})"


def add_law(name: str, function: LawFunction, *, parameters: Mapping[str, Optional[float]],
            history: Optional[Mapping[str, float]] = None, size: int = 4, symmetric: bool = False,
            summary: str = "a law written in Python") -> None:
    """Makes a Python function a law, for this process: Material(name, ...) and Law(name, ...) then use it.

    ``function(p, stress, strain, dstrain, history)`` returns ``(stress, tangent)`` or ``(stress, tangent, history)``
    at strain + dstrain, or None where a smaller increment may help.  ``p`` has the parameters as attributes.
    Vectors are [xx yy zz xy] (size 4; size 2: [shear normal]), compression positive, engineering shear;
    tangent[i, j] = d stress[i] / d dstrain[j].  ``dstrain`` = 0 must give back stress and history.  The function
    must not change its arguments, and answer alike when it is asked again.
    ``parameters``: values that are used where a material leaves them out; None: they must be given.
    It is slow, for trying things: docs/manual/own_program.md makes a law of C++.
    """
    if size not in (2, 4):
        raise ValueError("size is 4 (solids) or 2 (joints)")
    pairs: List[Tuple[str, Optional[float]]] = list(parameters.items())
    _sagefe.add_law(name, function, pairs, [(key, float(value)) for key, value in (history or {}).items()], size,
                    symmetric, summary)


def laws() -> Dict[str, List[str]]:
    """Names of the laws that there are, with the names of their parameters."""
    return {name: [one[0] for one in entry[2]] for name, entry in _sagefe.laws().items()}


def load_plugin(library: str) -> None:
    """Loads a plug-in (docs/manual/plugins.md); its pieces are there for models that are read from then on."""
    _sagefe.load_plugin(library)
