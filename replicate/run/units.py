"""The unit of work of a run: one reading of a table, one figure, or the claims of a paper.

A unit travels to a worker process as three names; the worker imports the paper's package and does the work
there. An exhibit that raises is recorded with its reason and takes nothing else down.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass

from replicate.exhibits import Claims, Exhibit, Figure, Finding, Paper, Table
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, TableResult


@dataclass(frozen=True)
class Unit:
    """What to compute: ``reading`` is empty for figures and claims."""

    paper: str
    package: str
    exhibit: str
    reading: str = ""

    def __str__(self) -> str:
        """Name the unit as a person would on the command line."""
        name = f"{self.paper}/{self.exhibit}"
        return f"{name} ({self.reading})" if self.reading else name


def units_of(paper: Paper, exhibit: Exhibit) -> list[Unit]:
    """Return the units of one exhibit; none if it cannot be computed."""
    if isinstance(exhibit, Table):
        return [Unit(paper.id, paper.package, exhibit.id, reading) for reading in exhibit.readings]
    if isinstance(exhibit, Figure | Claims):
        return [Unit(paper.id, paper.package, exhibit.id)]
    return []


def compute(unit: Unit) -> Result:
    """Do the work of one unit; this is what runs in a worker process.

    Returns
    -------
    Result
        For a reading, a `TableResult` with that reading alone.
    """
    paper: Paper = importlib.import_module(unit.package).paper
    exhibit = paper.load().exhibits[unit.exhibit]
    if isinstance(exhibit, Table):
        return _compute_reading(unit, exhibit)
    if isinstance(exhibit, Figure):
        return _draw(unit, exhibit)
    if isinstance(exhibit, Claims):
        return _check_claims(unit, exhibit)
    msg = f"{unit} cannot be computed"
    raise TypeError(msg)


def reason(error: Exception) -> str:
    """Return one line that says what was raised, and where in the paper's own code or the core."""
    text = " ".join(str(error).split())
    frame = error.__traceback__
    place = ""
    while frame is not None:
        module = frame.tb_frame.f_globals.get("__name__", "")
        if module != __name__ and "site-packages" not in frame.tb_frame.f_code.co_filename:
            place = f" ({module}, line {frame.tb_lineno})"
        frame = frame.tb_next
    return f"{type(error).__name__}: {text}{place}" if text else f"{type(error).__name__}{place}"


def _compute_reading(unit: Unit, table: Table) -> TableResult:
    import pandas as pd

    try:
        frame: object = table.readings[unit.reading].compute()
        if not isinstance(frame, pd.DataFrame):
            msg = f"the reading returns {type(frame).__name__}; expected: a pandas DataFrame"
            raise TypeError(msg)  # noqa: TRY301  -- reported like everything else the reading gets wrong
    except Exception as error:  # noqa: BLE001  -- one exhibit must not take the others down
        return TableResult(unit.paper, unit.exhibit, errors={unit.reading: reason(error)})
    return TableResult(unit.paper, unit.exhibit, frames={unit.reading: frame})


def _draw(unit: Unit, figure: Figure) -> FigureResult:
    from replicate.run.drawing import capture, no_figure

    try:
        return capture(unit.paper, figure)
    except Exception as error:  # noqa: BLE001  -- one exhibit must not take the others down
        return no_figure(unit.paper, unit.exhibit, reason(error))


def _check_claims(unit: Unit, claims: Claims) -> ClaimsResult:
    findings: dict[str, Finding] = {}
    errors: dict[str, str] = {}
    for id, claim in claims.claims.items():
        try:
            finding: object = claim.check()
            if not isinstance(finding, Finding):
                msg = f"the check returns {type(finding).__name__}; expected: a Finding"
                raise TypeError(msg)  # noqa: TRY301  -- reported like everything else the check gets wrong
            findings[id] = finding
        except Exception as error:  # noqa: BLE001  -- one claim must not take the others down
            errors[id] = reason(error)
    return ClaimsResult(unit.paper, unit.exhibit, findings, errors)
