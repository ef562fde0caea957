"""Models: from decks, from arrays, and with other values; runs and stepping."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _sagefe
from ._errors import AnalysisError, Diagnostic, NotConverged
from ._results import Result, State

Value = Union[float, str]
_KEEP = ("all", "ends", "none")


def _whole(values: ArrayLike) -> List[int]:
    return [int(one) for one in np.asarray(values).ravel()]


class Material:
    """A material: the name of a law (``sagefe.laws()``) and its parameters by name, as decks give them.

    saturated_unit_weight: of solids below a phreatic line; 0: the unit weight everywhere.
    """

    def __init__(self, law: str, *, unit_weight: float = 0.0, saturated_unit_weight: float = 0.0, name: str = "",
                 **parameters: float) -> None:
        self.law = law
        self.unit_weight = float(unit_weight)
        self.saturated_unit_weight = float(saturated_unit_weight)
        self.name = name
        self.parameters = {key: float(value) for key, value in parameters.items()}


class Group:
    """Elements of one kind and material.  ``elements``: (number, nodes of each), node numbers from 1."""

    def __init__(self, element: str, elements: ArrayLike, *, material: int = 1, formulation: str = "", name: str = "",
                 overlay: bool = False) -> None:
        self.element = element
        self.elements = [[int(node) for node in one] for one in np.asarray(elements)]
        self.material = material
        self.formulation = formulation
        self.name = name
        self.overlay = overlay


class Support:
    """Supports of nodes: "fixed", "released" or "" (as before) along x and y, with displacements of the stage.

    With an angle (degrees, anticlockwise from x), x is along a line at this angle and y normal to it.
    """

    def __init__(self, nodes: ArrayLike, x: str = "", y: str = "", *, x_value: float = 0.0, y_value: float = 0.0,
                 unknown: str = "", angle: float = 0.0) -> None:
        self.nodes = _whole(nodes)
        self.x, self.y = x, y
        self.x_value, self.y_value = float(x_value), float(y_value)
        self.unknown = unknown
        self.angle = float(angle)


class Tie:
    """In every stage the nodes move as node ``to`` does, in x, y or both; or, with ``to_step``, each as the next one."""

    def __init__(self, nodes: ArrayLike, to: int, *, x: bool = True, y: bool = True, to_step: int = 0) -> None:
        self.nodes = _whole(nodes)
        self.to, self.to_step = int(to), int(to_step)
        self.x, self.y = bool(x), bool(y)


class Load:
    """Forces on each of the nodes, added over the stage."""

    def __init__(self, nodes: ArrayLike, x: float = 0.0, y: float = 0.0, *, unknown: str = "") -> None:
        self.nodes = _whole(nodes)
        self.x, self.y = float(x), float(y)
        self.unknown = unknown


class Pressure:
    """Pressure (positive in compression) and shear on one edge, from 1, of each of the elements (numbers from 1).

    ``normal`` and ``shear`` are numbers, or pairs for the two ends of the edge.
    """

    def __init__(self, elements: ArrayLike, edge: int, normal: "float | Tuple[float, float]" = 0.0,
                 shear: "float | Tuple[float, float]" = 0.0) -> None:
        self.elements = _whole(elements)
        self.edge = edge
        self.normal1, self.normal2 = (float(one) for one in np.broadcast_to(normal, 2))
        self.shear1, self.shear2 = (float(one) for one in np.broadcast_to(shear, 2))


class Initial:
    """Initial stress of a group, as on the card.

    kind: "uniform", "geostatic", "zero", "traction", "history", "lock off", "material", "parameter" or "at rest".
    """

    def __init__(self, group: int, kind: str = "uniform", values: Sequence[float] = ()) -> None:
        self.group = group
        self.kind = kind
        self.values = [float(one) for one in values]


@dataclass
class Stage:
    """A stage of loading.  ``gravity`` in multiples of the unit weights: (0, -1) is the whole weight."""

    increments: int = 1
    title: str = ""
    supports: Sequence[Support] = ()
    loads: Sequence[Load] = ()
    pressures: Sequence[Pressure] = ()
    initials: Sequence[Initial] = ()
    gravity: Tuple[float, float] = (0.0, 0.0)
    activated: Sequence[int] = ()
    removed: Sequence[int] = ()
    method: str = "newton"
    max_iterations: int = 0
    tolerance: float = 0.0
    duration: float = 1.0


@dataclass
class ReportOf:
    """A report: kind "triaxial", "nodes", "point", "discharge", "uplift" or "section" (place and end)."""

    kind: str
    nodes: Sequence[int] = ()
    group: int = 0
    stage: int = 1
    height: float = 0.0
    area: float = 0.0
    cell_pressure: float = 0.0
    place: Tuple[float, float] = (0.0, 0.0)
    name: str = ""
    end: Tuple[float, float] = (0.0, 0.0)


@dataclass
class ModelInput:
    """A model as arrays.  Numbers of nodes, elements, materials, groups and stages count from 1 in the order of lists."""

    nodes: NDArray[np.float64]
    materials: Sequence[Material]
    groups: Sequence[Group]
    stages: Sequence[Stage]
    supports: Sequence[Support] = ()
    initials: Sequence[Initial] = ()
    reports: Sequence[ReportOf] = ()
    geometry: str = "plane_strain"
    units: Tuple[str, str, str] = ("-", "-", "-")
    atmospheric_pressure: float = 0.0
    water_unit_weight: float = 0.0
    solver: str = ""
    name: str = "model"
    title: str = ""
    ties: Sequence[Tie] = ()


def _finish(result: Result, strict: bool) -> Result:
    if strict and result.status in ("not converged", "singular"):
        raise NotConverged(result.code or "", result.reason, result)
    if result.status == "failed":
        raise AnalysisError(result.code or "", result.reason)
    return result


class Model:
    """A model that does not change: ``with_()`` gives another one, ``run()`` a result."""

    def __init__(self, model: _sagefe.Model) -> None:
        self._model = model

    @property
    def warnings(self) -> List[Diagnostic]:
        """Warnings and notes about the deck and the model."""
        return self._model.diagnostics

    @property
    def title(self) -> str:
        return self._model.title

    @property
    def units(self) -> Dict[str, str]:
        """Names of the units of length, force and stress."""
        return self._model.units

    @property
    def geometry(self) -> str:
        """"plane_strain" or "axisymmetric"."""
        return "axisymmetric" if self._model.axisymmetric else "plane_strain"

    @property
    def nodes(self) -> NDArray[np.float64]:
        """(nodes, 2): their places."""
        return self._model.node_places

    @property
    def node_numbers(self) -> NDArray[np.int32]:
        return self._model.node_numbers

    @property
    def groups(self) -> List[Dict[str, Any]]:
        """For each group its number, name, element, kind, material, element numbers and nodes (indices of rows)."""
        return self._model.groups

    @property
    def materials(self) -> Dict[int, Tuple[str, str, Dict[str, float]]]:
        """By number: name, law, and parameters by name, as decks give them."""
        return self._model.materials

    @property
    def stages(self) -> List[Tuple[str, int]]:
        """Title and increments of each stage."""
        return self._model.stages

    def names(self) -> List[str]:
        """Names that ``with_()`` and sweeps may set, such as ``material.1.friction_angle``."""
        return self._model.names()

    def __getitem__(self, name: str) -> float:
        """The number of a name; NaN where it is left blank."""
        return self._model.value(name)

    def with_(self, values: Optional[Mapping[str, Value]] = None, *,
              materials: Optional[Mapping["int | str", Mapping[str, float]]] = None,
              stages: Optional[Mapping[int, Mapping[str, float]]] = None, **options: Value) -> "Model":
        """The same model with other values, built and checked anew.

        ``values``: by the names of ``names()``.  ``materials`` and ``stages``: the same by number (or name) and
        parameter, ``materials={1: dict(nu=.3)}``.  Options: ``geometry``, ``formulation``, ``element``, ``refine``,
        ``solver``.  Raises DeckError for unknown names and for values that can't be meant.
        """
        pairs: List[Tuple[str, Value]] = list((values or {}).items())
        for prefix, table in (("material", materials or {}), ("stage", stages or {})):
            for key, changed in table.items():  # type: ignore[attr-defined]
                pairs += [(f"{prefix}.{key}.{name}", value) for name, value in changed.items()]
        pairs += list(options.items())
        return Model(self._model.with_values(pairs))

    def run(self, *, strict: bool = False, keep: str = "all", threads: int = 1) -> Result:
        """Runs all stages.

        ``keep``: states of every increment ("all"), of the ends of stages ("ends"), or none ("none").
        ``strict``: raise NotConverged where no equilibrium is found; otherwise ``result.converged`` is False.
        Other threads of Python go on meanwhile; Ctrl-C ends the run with KeyboardInterrupt.
        """
        return _finish(Result(self._model.run(_threads(threads), _kept(keep))), strict)

    def analysis(self, *, keep: str = "none", threads: int = 1) -> "Analysis":
        """The model increment by increment, see Analysis."""
        return Analysis(self, keep=keep, threads=threads)

    def __repr__(self) -> str:
        units = self.units
        return (
            f"<model {self._model.file}: {self.title}; {self.geometry}, {len(self.nodes)} nodes, "
            f"units {units['length']}, {units['force']}, {units['stress']}>"
        )


def _threads(threads: int) -> int:
    if threads < 1:
        raise ValueError("threads must be 1 or more")
    return threads


def _kept(keep: str) -> str:
    if keep not in _KEEP:
        raise ValueError(f"keep is one of {', '.join(_KEEP)}, not {keep!r}")
    return keep


class Analysis:
    """An analysis under the control of a program: advance, read the state, change a load, go on.

    ``for state in analysis`` goes through the increments.  It has a model of its own: changes of loads do not
    reach the Model that it was made of.  Threads may have an analysis each, not one together.
    """

    def __init__(self, model: Model, *, keep: str = "none", threads: int = 1) -> None:
        self._analysis = _sagefe.Analysis(model._model, _threads(threads), _kept(keep))

    def advance(self) -> bool:
        """Computes the next increment.  False: nothing is left, or there is no equilibrium; ``close()`` says which."""
        return self._analysis.advance()

    def state(self) -> State:
        """The last state in equilibrium, which stays as it is when the analysis goes on."""
        return State(self._analysis.state())

    @property
    def stage(self) -> int:
        """Number of the stage, from 1, of the last increment that is complete."""
        return self._analysis.stage

    @property
    def increment(self) -> int:
        """Number of that increment, from 1; 0 before the first."""
        return self._analysis.increment

    @property
    def is_complete(self) -> bool:
        """Whether the last increment of the last stage is complete."""
        return self._analysis.is_complete

    @property
    def result(self) -> Result:
        """Reports (and states, where kept) so far."""
        return Result(self._analysis.run)

    def set_pressure(self, normal: float, shear: float = 0.0, *, stage: Optional[int] = None,
                     elements: Sequence[int] = ()) -> None:
        """Changes the pressures of a stage (that of the last increment), all of them or those on these elements.

        The loads then go from what acts now to the new loads at the end of the stage.
        """
        self._analysis.set_pressure(stage or self.stage, normal, shear, list(elements))

    def set_load(self, nodes: Sequence[int], x: float = 0.0, y: float = 0.0, *, stage: Optional[int] = None) -> None:
        """Replaces the forces on each of the nodes in a stage (that of the last increment)."""
        self._analysis.set_load(stage or self.stage, list(nodes), x, y)

    def scale_loads(self, factor: float, *, stage: Optional[int] = None) -> None:
        """Multiplies all loads of a stage (that of the last increment): forces, pressures and weights."""
        self._analysis.scale_loads(stage or self.stage, factor)

    def close(self, *, strict: bool = False) -> Result:
        """Ends the analysis; its status is "stopped" where increments are left."""
        return _finish(Result(self._analysis.close()), strict)

    def __iter__(self) -> Iterator[State]:
        while self.advance():
            yield self.state()

    def __enter__(self) -> "Analysis":
        return self

    def __exit__(self, *ignored: object) -> None:
        if not self._analysis.is_closed:
            self._analysis.close()

    def __repr__(self) -> str:
        return f"<analysis in stage {self.stage}, increment {self.increment}>"


def read(deck: "str | os.PathLike[str]", *, layout: str = "", partial: bool = False) -> Model:
    """Reads a deck.  Raises DeckError with every mistake found; ``model.warnings`` holds the rest."""
    return Model(_sagefe.read(os.fspath(deck), layout, partial))


def build(nodes: ArrayLike, materials: Sequence[Material], groups: Sequence[Group], stages: Sequence[Stage],
          **others: Any) -> Model:
    """A model of arrays; ``others`` are the further members of ModelInput.  Checked as a deck is."""
    return Model(_sagefe.build(ModelInput(np.asarray(nodes, dtype=float), materials, groups, stages, **others)))
