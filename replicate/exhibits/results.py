"""What computing an exhibit leaves behind: records that every later stage (verdicts, report, diff) reads.

The records hold data only, no functions: a worker process can send them back and the cache can keep them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

from replicate.exhibits.claims import Finding
from replicate.exhibits.frames import FrameCells, read_frame
from replicate.exhibits.printed import Key
from replicate.exhibits.trials import TableTrials

if TYPE_CHECKING:
    import pandas as pd


Proof = Literal["alone", "jointly"]


@dataclass(frozen=True)
class Ranges:
    """What a reading with printed inputs gives while these run through the intervals of their last digits.

    Attributes
    ----------
    lower, upper
        The range of the quantity in a cell, by (row, column); NaN where it does not exist for all inputs.
    joint
        Its value at the point of the case, by (row, column).
    points
        By case: the inputs at which most of its printed quantities hold together, by quantity.
    proofs
        By (row, column), of the values that do not hold at that point: what proves that there is none at which they do,
        neither by themselves nor, ``jointly``, with those of the case that hold. Missing where that is only the outcome
        of a search.
    """

    lower: dict[Key, float] = field(default_factory=dict)
    upper: dict[Key, float] = field(default_factory=dict)
    joint: dict[Key, float] = field(default_factory=dict)
    points: dict[str, dict[str, float]] = field(default_factory=dict)
    proofs: dict[Key, Proof] = field(default_factory=dict)


@dataclass(frozen=True)
class TableResult:
    """A table, worked example or formula, computed under each of its readings.

    Attributes
    ----------
    frames
        By reading id, in the exhibit's order: the whole exhibit, indexed by row key. Missing where computing
        failed.
    errors
        By reading id: a one-line reason for each reading that raised.
    ranges
        By reading id, for the readings with printed inputs.
    trials
        Loops that a reader may try out; they are listed with the first reading.
    """

    paper: str
    exhibit: str
    frames: dict[str, pd.DataFrame] = field(default_factory=dict)
    errors: dict[str, str] = field(default_factory=dict)
    ranges: dict[str, Ranges] = field(default_factory=dict)
    trials: TableTrials = field(default_factory=TableTrials)

    @cached_property
    def cells(self) -> Mapping[str, FrameCells]:
        """The cells of every frame by reading id; each frame is read once."""
        return {reading: read_frame(frame) for reading, frame in self.frames.items()}


@dataclass(frozen=True)
class FigureResult:
    """A figure: drawn, and read back out of its axes as data.

    Attributes
    ----------
    curves
        Columns ``panel, curve, x, y`` (text, text, float, float), points in drawing order; a row without x
        and y is a break in the curve.
    axes
        One description per panel: title, limits, scales, labels, legend, annotation texts, and all that is drawn.
    figure
        The same of the figure as a whole: its size, and what is drawn outside the axes.
    error
        A one-line reason if drawing raised; the other fields are then empty.
    """

    paper: str
    exhibit: str
    svg: str
    png: bytes
    curves: pd.DataFrame
    axes: list[dict[str, Any]]
    error: str = ""
    figure: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class ClaimsResult:
    """The claims of a paper: what each check found.

    Attributes
    ----------
    findings
        By claim id, in the paper's order. Missing where the check raised.
    errors
        By claim id: a one-line reason for each check that raised.
    """

    paper: str
    exhibit: str
    findings: dict[str, Finding] = field(default_factory=dict)
    errors: dict[str, str] = field(default_factory=dict)


Result = TableResult | FigureResult | ClaimsResult
Results = dict[tuple[str, str], Result]


def errors_of(result: Result) -> dict[str, str]:
    """Return what went wrong, by reading or claim (by the empty text for a figure, or the trials of a table)."""
    if isinstance(result, FigureResult):
        return {"": result.error} if result.error else {}
    if isinstance(result, TableResult) and result.trials.error:
        return {**result.errors, "": result.trials.error}
    return result.errors
