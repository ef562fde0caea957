"""A program with types, as a user writes it: mypy --strict must find nothing in it."""

from typing import Tuple

import numpy as np
from numpy.typing import NDArray

import sagefe


def ratio(nu: float) -> float:
    model = sagefe.read("deck.dat").with_(materials={1: {"nu": nu}}, geometry="axisymmetric")
    result: sagefe.Result = model.run(strict=True)
    return float(result.report[1]["ratio"][-1])


def stresses(result: sagefe.Result) -> NDArray[np.float64]:
    return result.at(strain=0.1).points["stress"]


def elastic(
    p: object,
    stress: NDArray[np.float64],
    strain: NDArray[np.float64],
    dstrain: NDArray[np.float64],
    history: NDArray[np.float64],
) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
    tangent = np.eye(4)
    return stress + tangent @ dstrain, tangent


def ratios(study: str) -> NDArray[np.float64]:
    return sagefe.sweep(study, jobs=1, collect=["report1.ratio"])["report1.ratio"]


sagefe.add_law("elastic", elastic, parameters={"E": None})
