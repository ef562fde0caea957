"""What goes wrong, as exceptions with the places in the deck and the codes of the messages."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, List

if TYPE_CHECKING:
    from ._results import Result


@dataclass(frozen=True)
class Diagnostic:
    """A message about a deck or a model.

    ``line`` and columns count from 1 and include both ends; 0 means unknown.  ``sagefe explain CODE`` says more.
    """

    severity: str  # "note", "warning" or "error"
    code: str  # "S104"
    file: str
    line: int
    first_column: int
    last_column: int
    text: str
    detail: List[str] = field(default_factory=list)  # lines shown below: the card, carets, notes

    def __str__(self) -> str:
        where = self.file
        if self.line > 0:
            where += f":{self.line}"
        if self.first_column > 0:
            where += f":{self.first_column}-{self.last_column}"
        lines = [f"{where}: {self.severity}: {self.text} [{self.code}]", *self.detail]
        return "\n".join(lines)


class SagefeError(Exception):
    """Base of all exceptions of this package."""


class DeckError(SagefeError, ValueError):
    """The deck or model can't be used.  ``diagnostics`` holds every mistake that was found."""

    def __init__(self, diagnostics: List[Diagnostic]) -> None:
        super().__init__("\n".join(str(one) for one in diagnostics))
        self.diagnostics = diagnostics

    @property
    def code(self) -> str:
        """The code of the first error."""
        errors = [one for one in self.diagnostics if one.severity == "error"] or self.diagnostics
        return errors[0].code if errors else ""


class AnalysisError(SagefeError, RuntimeError):
    """The analysis could not go on.  ``code`` is the code of the message."""

    def __init__(self, code: str, text: str) -> None:
        super().__init__(f"{text} [{code}]" if f"[{code}]" not in text else text)
        self.code = code


class NotConverged(AnalysisError):
    """No equilibrium was found.  ``result`` holds what was computed before, up to the last state in equilibrium."""

    def __init__(self, code: str, text: str, result: "Result") -> None:
        super().__init__(code, text)
        self.result = result
