"""The unit of work of a run: one reading of a table, one figure, or the claims of a paper.

A unit travels to a worker process as three names; the worker imports the paper's package and does the work
there. An exhibit that raises, or that tries to leave, is recorded with its reason and takes nothing else down.
"""

from __future__ import annotations

import importlib
import inspect
import math
import traceback
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, get_args

from replicate.errors import PaperDefinitionError, ReplicateError
from replicate.exhibits import Claim, Claims, ClaimVerdict, Exhibit, Figure, Finding, Paper, Reading, Table
from replicate.exhibits.file_names import display_name
from replicate.exhibits.frame_check import checked_frame
from replicate.exhibits.frames import read_frame
from replicate.exhibits.printed import Key, PrintedValue, read_printed
from replicate.exhibits.readings import other_cell
from replicate.exhibits.results import ClaimsResult, FigureResult, Ranges, Result, TableResult
from replicate.exhibits.rounded_inputs import compute_reading, places_elsewhere
from replicate.exhibits.trials import TableTrials, computed_trials, declared_trials
from replicate.run.modules import is_standard

if TYPE_CHECKING:
    import pandas as pd

_LONGEST_REASON = 400
_CORE, _BUNDLED = "replicate.", "replicate.papers."


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


def loaded(package: str) -> Paper:
    """Return the paper of a package, with its exhibits, in whichever process this is."""
    paper: Paper = importlib.import_module(package).paper
    return paper.load()


def compute(unit: Unit, without: Collection[str] = (), before: Callable[[str], object] = lambda _: None) -> Result:
    """Do the work of one unit; this is what runs in a worker process.

    Parameters
    ----------
    without
        Ids of claims to leave out.
    before
        Called with the id of every claim before it is checked.

    Returns
    -------
    Result
        For a reading, a `TableResult` with that reading alone.
    """
    paper = loaded(unit.package)
    exhibit = paper.exhibits[unit.exhibit]
    if isinstance(exhibit, Table):
        return _compute_reading(unit, paper, exhibit)
    if isinstance(exhibit, Figure):
        return _draw(unit, exhibit)
    if isinstance(exhibit, Claims):
        return _check_claims(unit, exhibit, without, before)
    msg = f"{unit} cannot be computed"
    raise TypeError(msg)


def failed(unit: Unit, exhibit: Exhibit, why: str) -> Result:
    """Return the record of a unit of which nothing is left but the reason."""
    if unit.reading:
        return TableResult(unit.paper, unit.exhibit, errors={unit.reading: why})
    if isinstance(exhibit, Claims):
        return ClaimsResult(unit.paper, unit.exhibit, errors=dict.fromkeys(exhibit.claims, why))
    from replicate.run.drawing import no_figure

    return no_figure(unit.paper, unit.exhibit, why)


def fits(result: Result, unit: Unit, exhibit: Exhibit) -> bool:
    """Say whether a result is one of this unit: of its kind, and of all its parts."""
    if (result.paper, result.exhibit) != (unit.paper, unit.exhibit):
        return False
    if isinstance(exhibit, Table):
        return isinstance(result, TableResult) and {*result.frames, *result.errors} == {unit.reading}
    if isinstance(exhibit, Claims):
        return isinstance(result, ClaimsResult) and {*result.findings, *result.errors} == set(exhibit.claims)
    return isinstance(exhibit, Figure) and isinstance(result, FigureResult)


def reason(error: BaseException, function: Callable[..., object] | None = None) -> str:
    """Return one line that says what was raised, and where in the paper's own code, or in the core if not there.

    Parameters
    ----------
    function
        What of the paper was called: named where the call itself was wrong and nothing of the paper ran.
    """
    own, core = "", ""
    for frame, line in traceback.walk_tb(error.__traceback__):
        module, file = frame.f_globals.get("__name__", ""), frame.f_code.co_filename
        if is_standard(module) or "site-packages" in file or file.startswith("<"):
            continue
        place = f" ({display_name(Path(file))}:{line})"
        if not module.startswith(_CORE) or module.startswith(_BUNDLED):
            own = place
        elif module.rpartition(".")[0] != __package__:
            core = place
    place = own or (f" ({_place(function)})" if function else core)
    if isinstance(error, SystemExit):
        return f"it tries to end the program, with status {_text(error.code)}{place}"
    text = _text(error)
    if isinstance(error, ReplicateError):  # whose text says all, but for the place of a call that was refused
        return f"{text}{own}"
    return f"{type(error).__name__}: {text}{place}" if text else f"{type(error).__name__}{place}"


def _text(value: object) -> str:
    """Return a text of one line, whatever an exception carries."""
    try:
        text = str(value)
    except Exception as error:  # noqa: BLE001  -- also the text of an exception is a paper's own code
        text = f"(its text raises {type(error).__name__})"
    line = " ".join("".join(sign if sign.isprintable() else " " for sign in text[: 4 * _LONGEST_REASON]).split())
    return line if len(line) <= _LONGEST_REASON else f"{line[:_LONGEST_REASON]} ..."


def _compute_reading(unit: Unit, paper: Paper, table: Table) -> TableResult:
    try:
        reading, ranges = table.readings[unit.reading], dict[str, Ranges]()
        file = paper.folder() / "printed" / f"{table.id}.csv"
        printed = read_printed(file, table) if table.printed and not table.points else {}
        made: object
        if reading.takes_inputs:
            made, ranges[reading.id] = compute_reading(table, reading, printed, _elsewhere(paper, reading))
        else:
            made = reading.compute()
        frame = _checked(table, reading, made, printed)
    except BaseException as error:  # noqa: BLE001  -- one exhibit must not take the others down
        function = table.readings[unit.reading].compute if unit.reading in table.readings else None
        return TableResult(unit.paper, unit.exhibit, errors={unit.reading: reason(error, function)})
    trials = _trials(table, frame) if unit.reading == next(iter(table.readings)) else TableTrials()
    return TableResult(unit.paper, unit.exhibit, {unit.reading: frame}, {}, ranges, trials)


def _trials(table: Table, frame: pd.DataFrame) -> TableTrials:
    """List the loops of a table, with those that its first reading computes."""
    declared = partial(declared_trials, table.trials, table.rows)
    computed = partial(computed_trials, table.computed_trial, read_frame(frame))
    asked = declared
    try:
        loops = declared()
        asked = computed
        return TableTrials(loops, computed())
    except PaperDefinitionError as error:
        return TableTrials(error=f"{_place(asked.args[0])}: {reason(error)}")
    except BaseException as error:  # noqa: BLE001  -- they must not take the table's numbers down
        return TableTrials(error=f"trials: {reason(error, asked.args[0])}")


def _elsewhere(paper: Paper, reading: Reading) -> dict[str, PrintedValue]:
    """Return the inputs of a reading that are printed in other tables or in the text, by place."""
    found = {}
    for place in places_elsewhere(reading):
        if ":" not in place:
            name, _, text = place.partition("=")
            found[place] = PrintedValue(text, name)
            continue
        id, *key = other_cell(place)
        exhibit = paper.exhibits.get(id)
        if not isinstance(exhibit, Table) or not exhibit.printed or exhibit.points:
            msg = f"reading '{reading.id}': input '{place}': there is no table '{id}' with printed numbers"
            raise PaperDefinitionError(msg)
        cells = read_printed(paper.folder() / "printed" / f"{id}.csv", exhibit)
        if (key[0], key[1]) not in cells:
            msg = f"reading '{reading.id}': input '{place}': row '{key[0]}', column '{key[1]}' of {id} is not printed"
            raise PaperDefinitionError(msg)
        found[place] = cells[key[0], key[1]]
    return found


def _checked(table: Table, reading: Reading, made: object, printed: Mapping[Key, PrintedValue]) -> pd.DataFrame:
    """Return what a reading has made if it is the table, or say where the reading is defined."""
    try:
        return checked_frame(table, made, printed)
    except PaperDefinitionError as error:
        msg = f"{_place(reading.compute)}: {error}"
        raise PaperDefinitionError(msg) from error


def _draw(unit: Unit, figure: Figure) -> FigureResult:
    from replicate.run.drawing import capture, no_figure

    try:
        return capture(unit.paper, figure)
    except PaperDefinitionError as error:
        return no_figure(unit.paper, unit.exhibit, f"{_place(figure.draw)}: {reason(error)}")
    except BaseException as error:  # noqa: BLE001  -- one exhibit must not take the others down
        return no_figure(unit.paper, unit.exhibit, reason(error, figure.draw))


def _check_claims(
    unit: Unit, claims: Claims, without: Collection[str], before: Callable[[str], object]
) -> ClaimsResult:
    findings: dict[str, Finding] = {}
    errors: dict[str, str] = {}
    for id, claim in claims.claims.items():
        if id in without:
            continue
        before(id)
        try:
            findings[id] = _valid(claim, claim.check())
        except BaseException as error:  # noqa: BLE001  -- one claim must not take the others down
            errors[id] = reason(error, claim.check)
    return ClaimsResult(unit.paper, unit.exhibit, findings, errors)


def _valid(claim: Claim, found: object) -> Finding:
    """Return what a check found if it is a verdict with a number and a sentence."""
    from replicate.run.storage import number

    where = f"claim '{claim.id}' ({_place(claim.check)}): "
    allowed = get_args(ClaimVerdict)
    if not isinstance(found, Finding):
        msg = f"{where}the check returns {type(found).__name__}; expected: a Finding"
    elif found.verdict not in allowed:
        msg = f"{where}the verdict is {found.verdict!r}; allowed: {', '.join(allowed)}"
    elif type(found.evidence) is not str:
        msg = f"{where}the evidence is {type(found.evidence).__name__}; expected: text"
    else:
        try:
            value = number(found.value, f"{where}the value is")
            if not math.isnan(value) or found.verdict == "undecided":
                return Finding(found.verdict, value, found.evidence)
            msg = f"{where}the value is nan; expected: the number that decides it"
        except (TypeError, ValueError) as error:
            raise PaperDefinitionError(str(error)) from error
    raise PaperDefinitionError(msg)


def _place(function: Callable[..., object]) -> str:
    """Return file and line of a function."""
    while isinstance(function, partial):
        function = function.func
    code = getattr(inspect.unwrap(function), "__code__", None)
    return f"{display_name(Path(code.co_filename))}:{code.co_firstlineno}" if code else "place unknown"
