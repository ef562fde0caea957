"""States as meshes of meshio."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Tuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import meshio  # type: ignore[import]

    from ._results import State

# By VTK's number of the cell.
_TYPES = {3: "line", 5: "triangle", 9: "quad", 21: "line3", 22: "triangle6", 23: "quad8", 28: "quad9"}
_CORNERS = {2: "line", 3: "triangle", 4: "quad"}


def _cells(group: Dict[str, Any]) -> Tuple[str, NDArray[np.int32]]:
    nodes = group["nodes"]
    if group["vtk_type"] in _TYPES:
        order = group["vtk_nodes"] or list(range(nodes.shape[1]))
        return _TYPES[group["vtk_type"]], nodes[:, order]
    corners = group["corners"]
    return _CORNERS[corners], nodes[:, :corners]


def element_means(state: "State", kind: str, name: str) -> Dict[int, NDArray[np.float64]]:
    """Means of a field over the points of each element, by the number of the group."""
    fields = {"solid": state.points, "interface": state.interfaces, "structure": state.structures,
              "flow": state.flow}[kind]
    values = fields[name]
    numbers = fields.number
    means = {}
    for group in state._state.groups:
        if group["kind"] != kind:
            continue
        own = values[numbers[:, 0] == group["number"]]
        means[group["number"]] = own.reshape(len(group["elements"]), group["points"], *values.shape[1:]).mean(axis=1)
    return means


def to_meshio(state: "State") -> "meshio.Mesh":
    import meshio

    groups = state._state.groups
    cells: List[Tuple[str, NDArray[np.int32]]] = []
    rows: List[Tuple[str, int, int]] = []
    for group in groups:
        cells.append(_cells(group))
        rows.append((group["kind"], group["number"], len(group["elements"])))
    data: Dict[str, List[NDArray[np.float64]]] = {
        "group": [np.full(count, number, dtype=float) for _, number, count in rows]
    }
    names: Dict[str, str] = {}
    for kind in {kind for kind, _, _ in rows}:
        for name in state._state.point_names(kind):
            names.setdefault(name, kind)
    for name in sorted(names):
        by_group: Dict[int, NDArray[np.float64]] = {}
        for kind in {kind for kind, _, _ in rows}:
            if name in state._state.point_names(kind):
                by_group.update(element_means(state, kind, name))
        shape = next(iter(by_group.values())).shape[1:]
        data[name] = [by_group.get(number, np.full((count, *shape), np.nan)) for _, number, count in rows]
    point_data = {name: np.array(state.nodes[name]) for name in state.nodes.names()}
    return meshio.Mesh(np.array(state.nodes.place), cells, point_data=point_data, cell_data=data)
