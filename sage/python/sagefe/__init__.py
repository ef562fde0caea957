"""2-D geotechnical finite elements: decks and models of arrays, runs, stepping, laws, results as numpy arrays.

>>> import sagefe
>>> model = sagefe.read("deck.dat")
>>> result = model.with_(materials={1: dict(nu=.3)}).run()
>>> result.report[1].ratio

Stresses, strains and pressures are positive in compression, displacements and forces along the axes, angles in
degrees, units those of the deck.  docs/manual/python.md is the manual.
"""

from ._errors import AnalysisError, DeckError, Diagnostic, NotConverged, SagefeError
from ._laws import Curve, Law, add_law, laws, load_plugin
from ._models import (
    Analysis,
    Group,
    Initial,
    Load,
    Material,
    Model,
    ModelInput,
    Pressure,
    ReportOf,
    Stage,
    Support,
    Tie,
    build,
    read,
)
from ._results import Fields, Report, Result, State
from ._sagefe import version as __version__
from ._sweeps import sweep

__all__ = [
    "Analysis",
    "AnalysisError",
    "Curve",
    "DeckError",
    "Diagnostic",
    "Fields",
    "Group",
    "Initial",
    "Law",
    "Load",
    "Material",
    "Model",
    "ModelInput",
    "NotConverged",
    "Pressure",
    "Report",
    "ReportOf",
    "Result",
    "SagefeError",
    "Stage",
    "State",
    "Support",
    "Tie",
    "__version__",
    "add_law",
    "build",
    "laws",
    "load_plugin",
    "read",
    "sweep",
]
