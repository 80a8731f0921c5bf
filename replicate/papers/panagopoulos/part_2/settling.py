"""The settling times of both tables against the definitions one could think of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Literal

from replicate.loops import Loop, Signal
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.designs import printed
from replicate.papers.panagopoulos.part_2.load_experiment import load_experiment
from replicate.papers.panagopoulos.part_2.printed_gains import printed_number
from replicate.papers.panagopoulos.part_2.processes import PLANTS, ROW_LABELS, ROWS, split
from replicate.papers.panagopoulos.part_2.setpoint import with_setpoint
from replicate.papers.panagopoulos.part_2.tables import REPLACEMENT, SUPERSEDED, one_sided_settling

if TYPE_CHECKING:
    import pandas as pd

WITHIN = 0.02  # of the print
BANDS = (0.01, 0.02, 0.03, 0.05, 0.1)
SignalName = Literal["load y", "load u", "set-point y"]
SIGNALS: tuple[SignalName, ...] = ("load y", "load u", "set-point y")


@dataclass(frozen=True)
class Definition:
    """A settling time: of which signal, in a band of what, on one side or two."""

    signal: SignalName
    relative: bool  # to the largest deviation, instead of to the unit step
    two_sided: bool
    band: float

    @property
    def row(self) -> str:
        """Key of the definition without its band."""
        scale = "of the peak" if self.relative else "of the step"
        return f"{self.signal}, {scale}, {'both sides' if self.two_sided else 'above'}"

    def of(self, table: str, row: str) -> float:
        """Return the settling time for the printed gains."""
        level = self.band * (largest(table, row, self.signal) if self.relative else 1.0)
        levels = (level, -level) if self.two_sided else (level,)
        return max(last_crossing(table, row, self.signal, level) for level in levels)


@cache
def deviation(table: str, row: str, signal: SignalName) -> Signal:
    """Return a signal minus its final value."""
    process, _ = split(row)
    if signal == "set-point y":
        response = Loop(PLANTS[process], with_setpoint(row, printed(table, row))).step()
    else:
        both = load_experiment(process, printed(table, row))
        response = both.output if signal == "load y" else both.control
    coefficients = response.coefficients.copy()
    coefficients[:, 0] -= response.final
    return Signal(response.breaks, coefficients, final=0.0)


@cache
def largest(table: str, row: str, signal: SignalName) -> float:
    """Return the largest deviation to either side."""
    moved = deviation(table, row, signal)
    return max(float(moved.peak()), -float(moved.trough()))


@cache
def last_crossing(table: str, row: str, signal: SignalName, level: float) -> float:
    """Return the last time at which a deviation crosses a level; 0 where it does not."""
    return deviation(table, row, signal).last_crossing(level)


def definitions() -> Iterator[Definition]:
    """Enumerate what was tried."""
    for signal in SIGNALS:
        for relative in (False, True):
            for two_sided in (True, False):
                for band in BANDS:
                    yield Definition(signal, relative, two_sided, band)


def hits(table: str, definition: Definition) -> int:
    """Return how many printed settling times a definition meets within 2 %."""
    count = 0
    for row in ROWS:
        wanted = printed_number(table, row, "ts")
        if wanted == wanted:  # noqa: PLR0124  -- NaN: lost in the scan
            count += abs(definition.of(table, row) - wanted) <= WITHIN * wanted
    return count


KEYS = tuple(dict.fromkeys(definition.row for definition in definitions()))

tried = paper.table(
    "IIs-settling",
    "Settling times: definitions tried",
    printed=False,
    rows=KEYS,
    columns=(SUPERSEDED, REPLACEMENT),
    caption="How many printed $t_s$ a definition gives within 2 %, for the best of the bands "
    + ", ".join(f"{100 * band:g}" for band in BANDS)
    + " %, with the printed gains. Load: unit step at the process input; set point: with the weight and filter "
    "of the text.",
    labels={SUPERSEDED: "Table 1", REPLACEMENT: "errata"},
)


@tried.reading("as-written", "Printed values met")
def counts() -> pd.DataFrame:
    """Count the hits of every definition."""
    best: dict[str, dict[str, int]] = {key: {SUPERSEDED: 0, REPLACEMENT: 0} for key in KEYS}
    for definition in definitions():
        for table, most in best[definition.row].items():
            best[definition.row][table] = max(most, hits(table, definition))
    return tried.frame(best)


_COLUMNS = {"printed": "printed", "above": "last above $+0.05$", "late": "print later by, %"}
shifted = paper.table(
    "II-settling",
    "Settling times: the definition of paper I",
    printed=False,
    rows=ROWS,
    columns=(*_COLUMNS, *(f"{key}_errata" for key in _COLUMNS)),
    caption="The printed $t_s$ of both tables beside the last time at which the response to a unit load is "
    "above $+0.05$, counted from the end of the dead time, and how much later the print is. In paper I the prints are "
    "one to six percent late by this measure, as if read off a coarse grid. $G_1$ would need a smaller load, $G_3$ a "
    "larger one.",
    labels=ROW_LABELS | _COLUMNS | {f"{key}_errata": f"errata: {label}" for key, label in _COLUMNS.items()},
)


@shifted.reading("as-written", "Exact load responses of the printed gains")
def by_paper_1() -> pd.DataFrame:
    """Compare the printed settling times with paper I's definition."""
    rows = {}
    for row in ROWS:
        values: list[float] = []
        for table in (SUPERSEDED, REPLACEMENT):
            text, time = printed_number(table, row, "ts"), one_sided_settling(table, row)
            values += [text, time, 100.0 * (text / time - 1.0) if time > 0.0 else float("nan")]
        rows[row] = values
    return shifted.frame(rows)
