"""Results of runs: states with fields as arrays, and reports as columns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional

import numpy as np
from numpy.typing import NDArray

from . import _sagefe
from ._errors import Diagnostic

if TYPE_CHECKING:
    import matplotlib.axes  # type: ignore[import]
    import meshio  # type: ignore[import]

Array = NDArray[np.float64]


class Fields:
    """Fields of a state at one kind of place, each a read-only array with one row for each place.

    ``fields.stress`` or ``fields["stress"]`` has the shape (places, components), or (places,) for single numbers.
    Stresses and strains are [xx yy zz xy], compression positive, engineering shear (zz is the hoop direction in
    axisymmetry); displacements and forces are along the axes; units are those of the deck (``unit(name)``).
    NaN: there is no value, as in groups that are not active.
    """

    def __init__(self, state: _sagefe.State, kind: str) -> None:
        self._state = state
        self._kind = kind
        self._known: Dict[str, Array] = {}

    def names(self) -> List[str]:
        """Names of the fields that there are."""
        return self._state.node_names() if self._kind == "node" else self._state.point_names(self._kind)

    def unit(self, name: str) -> str:
        """Unit of a field; "-" for pure numbers."""
        return self._state.unit(name)

    def words(self, name: str) -> NDArray[Any]:
        """Words of a field such as ``status``, one for each place."""
        words = np.array(self._state.words(name) + [""])
        numbers = self[name]
        return np.asarray(words[np.where(np.isnan(numbers), len(words) - 1, numbers).astype(int)])

    @property
    def place(self) -> Array:
        """(places, 2): x and y, or r and z."""
        return self._state.node_places if self._kind == "node" else self._state.point_places(self._kind)[1]

    @property
    def number(self) -> NDArray[np.int32]:
        """Numbers of the nodes; for points (points, 3): group, element and point, from 1."""
        return self._state.node_numbers if self._kind == "node" else self._state.point_places(self._kind)[0]

    def __getitem__(self, name: str) -> Array:
        if name not in self._known:
            if self._kind == "node":
                self._known[name] = self._state.node_field(name)
            else:
                self._known[name] = self._state.point_field(self._kind, name)
        return self._known[name]

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __len__(self) -> int:
        return len(self.place)

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self.names()]

    def __repr__(self) -> str:
        units = self._state.units
        return (
            f"<fields of {len(self)} {'nodes' if self._kind == 'node' else self._kind + ' points'}: "
            f"{', '.join(self.names())}; compression positive, units {units['length']}, {units['force']}, "
            f"{units['stress']}>"
        )


class State:
    """A state in equilibrium.  It stays valid after its result or analysis has gone."""

    def __init__(self, state: _sagefe.State) -> None:
        self._state = state
        self.nodes = Fields(state, "node")
        self.points = Fields(state, "solid")
        self.interfaces = Fields(state, "interface")
        self.structures = Fields(state, "structure")
        self.flow = Fields(state, "flow")

    @property
    def stage(self) -> int:
        """Number of the stage, from 1."""
        return self._state.stage

    @property
    def increment(self) -> int:
        """Increment of the stage, from 1; 0 is its start."""
        return self._state.increment

    @property
    def load_factor(self) -> float:
        """Part of the stage that is applied, 0 to 1."""
        return self._state.load_factor

    @property
    def converged(self) -> bool:
        """False for the last state in equilibrium within an increment that failed."""
        return self._state.converged

    @property
    def iterations(self) -> int:
        """Iterations of the increment."""
        return self._state.iterations

    def to_meshio(self) -> "meshio.Mesh":
        """The mesh with displacements at nodes and element means of all fields at points."""
        from ._mesh import to_meshio

        return to_meshio(self)

    def plot(self, field: str = "displacement", ax: Optional["matplotlib.axes.Axes"] = None,
             scale: float = 0.0) -> "matplotlib.axes.Axes":
        """Draws a field: of nodes, of points (element means), or a component such as ``stress_yy``.

        ``scale``: factor on displacements of the drawn mesh; 0 draws the mesh as it was.
        """
        from ._plots import plot_state

        return plot_state(self, field, ax, scale)

    def __repr__(self) -> str:
        units = self._state.units
        return (
            f"<state of stage {self.stage}, increment {self.increment}, load factor {self.load_factor:g}; "
            f"compression positive, units {units['length']}, {units['force']}, {units['stress']}>"
        )


class Report:
    """A report of the deck: its columns as read-only arrays, one value for each increment."""

    def __init__(self, run: _sagefe.Run, index: int) -> None:
        self.number = index + 1
        self.name = run.report_kinds[index][1]
        self.columns: Dict[str, NDArray[Any]] = run.report(index)
        self.units: Dict[str, str] = run.report_units(index)
        self.messages: List[str] = run.report_messages(index)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self.columns:
            raise KeyError(f"report {self.number} has no column {name}; there are: {', '.join(self.columns)}")
        return self.columns[name]

    def __getattr__(self, name: str) -> NDArray[Any]:
        if name.startswith("_") or name == "columns":
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __len__(self) -> int:
        return len(self.columns["stage"])

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self.columns]

    def plot(self, x: str, y: str, ax: Optional["matplotlib.axes.Axes"] = None) -> "matplotlib.axes.Axes":
        """Draws one column over another."""
        from ._plots import plot_columns

        return plot_columns(self, x, y, ax)

    def __repr__(self) -> str:
        columns = ", ".join(f"{name} [{self.units[name]}]" for name in self.columns if name in self.units)
        return f"<report {self.number} {self.name}: {len(self)} rows; {columns}; compression positive>"


class Reports:
    """The reports of a run by number, from 1, or by name."""

    def __init__(self, run: _sagefe.Run) -> None:
        self._all = [Report(run, index) for index in range(run.report_count)]

    def __getitem__(self, key: "int | str") -> Report:
        for report in self._all:
            if key in (report.number, report.name) and key != "":
                return report
        known = [str(one.number) + (f" {one.name}" if one.name else "") for one in self._all]
        raise KeyError(f"there is no report {key}; there are: {', '.join(known) or 'none'}")

    def __len__(self) -> int:
        return len(self._all)

    def __iter__(self) -> Iterator[Report]:
        return iter(self._all)


class Result:
    """What a run left: its end, its reports, and the states that were kept, in the order of time.

    ``result[-1]`` is the last state, ``result.at(...)`` finds one.
    """

    def __init__(self, run: _sagefe.Run) -> None:
        self.status: str = run.status
        """"completed", "not converged", "singular", "failed" or "stopped"."""
        self.reason: str = run.reason
        """Why the run did not complete; empty if it did."""
        self.code: Optional[str] = run.code
        self.warnings: List[Diagnostic] = run.warnings
        self.solver: str = run.solver
        self.equations: int = run.equations
        self.report = Reports(run)
        self.states: List[State] = [State(state) for state in run.states()]

    @property
    def converged(self) -> bool:
        """Whether all increments of all stages are in equilibrium."""
        return self.status == "completed"

    def __getitem__(self, index: int) -> State:
        return self.states[index]

    def __len__(self) -> int:
        return len(self.states)

    def __iter__(self) -> Iterator[State]:
        return iter(self.states)

    def at(self, *, stage: Optional[int] = None, increment: Optional[int] = None, strain: Optional[float] = None,
           report: int = 1) -> State:
        """The state at a stage and increment, the end of a stage, or an axial strain of a triaxial report.

        Raises KeyError where there is no such state: values between increments are not made up.
        """
        if strain is not None:
            return self._at_strain(strain, report)
        if stage is None:
            raise TypeError("at() needs a stage or a strain")
        found = [one for one in self.states if one.stage == stage and increment in (None, one.increment)]
        if not found:
            known = [(one.stage, one.increment) for one in self.states]
            raise KeyError(f"no state of stage {stage}, increment {increment} was kept; there are {known}")
        return found[-1]

    def _at_strain(self, strain: float, report: int) -> State:
        rows = self.report[report]
        strains = rows["axial_strain"]
        off = np.abs(strains - strain)
        row = int(np.argmin(off)) if len(off) else -1
        if row < 0 or off[row] > 1e-6 * max(abs(strain), 1e-12):
            known = ", ".join(f"{one:g}" for one in strains)
            raise KeyError(f"no increment ends at an axial strain of {strain:g}; there are {known}")
        return self.at(stage=int(rows["stage"][row]), increment=int(rows["increment"][row]))

    def to_meshio(self) -> "meshio.Mesh":
        """The last state as a mesh of meshio."""
        return self.states[-1].to_meshio()

    def plot(self, field: str = "displacement", ax: Optional["matplotlib.axes.Axes"] = None,
             scale: float = 0.0) -> "matplotlib.axes.Axes":
        """Draws a field of the last state."""
        return self.states[-1].plot(field, ax, scale)

    def __repr__(self) -> str:
        return (
            f"<result: {self.status}; {len(self.states)} states, {len(self.report)} reports, "
            f"{self.equations} equations, solver {self.solver}>"
        )
