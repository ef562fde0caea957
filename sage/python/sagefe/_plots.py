"""Plots with matplotlib, which is imported on use."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from ._mesh import element_means

if TYPE_CHECKING:
    import matplotlib.axes  # type: ignore[import]

    from ._results import Report, State

_COMPONENTS = {"xx": 0, "yy": 1, "zz": 2, "xy": 3, "x": 0, "y": 1}


def _split(state: "State", name: str, known: List[str]) -> Optional[Tuple[str, int]]:
    """A field and its component (-1: all of it); None where it is none of these."""
    if name in known:
        return name, -1
    field, _, component = name.rpartition("_")
    return (field, _COMPONENTS[component]) if field in known and component in _COMPONENTS else None


def _number(values: NDArray[np.float64], component: int) -> NDArray[np.float64]:
    if values.ndim == 1:
        return values
    return np.asarray(values[:, component]) if component >= 0 else np.asarray(np.linalg.norm(values, axis=1))


def plot_state(state: "State", name: str, ax: Optional["matplotlib.axes.Axes"], scale: float) -> "matplotlib.axes.Axes":
    from matplotlib import pyplot
    from matplotlib.collections import PolyCollection  # type: ignore[import]

    at_points = _split(state, name, state.points.names())
    at_nodes = None if at_points else _split(state, name, state.nodes.names())
    if at_points is None and at_nodes is None:
        raise KeyError(f"no field {name}; there are: {', '.join(state.points.names() + state.nodes.names())}")
    if at_points and at_points[1] < 0 and state.points[at_points[0]].ndim > 1:
        raise KeyError(f"which component of {name}? {name}_xx, {name}_yy, {name}_zz or {name}_xy")
    places = state.nodes.place + scale * state.nodes.displacement
    polygons: List[Any] = []
    values: List[NDArray[np.float64]] = []
    means = element_means(state, "solid", at_points[0]) if at_points else {}
    for group, active in zip(state._state.groups, state._state.active_groups):
        if group["kind"] != "solid" or not active:
            continue
        corners = group["nodes"][:, : group["corners"]]
        polygons += list(places[corners])
        if at_points:
            values.append(_number(means[group["number"]], at_points[1]))
        else:
            assert at_nodes is not None
            values.append(_number(state.nodes[at_nodes[0]], at_nodes[1])[corners].mean(axis=1))
    if ax is None:
        ax = pyplot.figure().add_subplot()
    drawn = PolyCollection(polygons, array=np.concatenate(values), cmap="viridis", edgecolors="face", linewidths=0.2)
    ax.add_collection(drawn)
    ax.autoscale_view()
    ax.set_aspect("equal")
    unit = state._state.unit((at_points or at_nodes or ("", 0))[0])
    ax.figure.colorbar(drawn, ax=ax, label=name + ("" if unit == "-" else f" [{unit}]"))
    length = state._state.units["length"]
    ax.set_xlabel(f"x [{length}]")
    ax.set_ylabel(f"y [{length}]")
    ax.set_title(f"stage {state.stage}, increment {state.increment}")
    return ax


def plot_columns(report: "Report", x: str, y: str, ax: Optional["matplotlib.axes.Axes"]) -> "matplotlib.axes.Axes":
    from matplotlib import pyplot

    if ax is None:
        ax = pyplot.figure().add_subplot()
    ax.plot(report[x], report[y], marker=".", label=report.name or f"report {report.number}")
    for name, label in ((x, ax.set_xlabel), (y, ax.set_ylabel)):
        unit = report.units.get(name, "-")
        label(name if unit == "-" else f"{name} [{unit}]")
    return ax
