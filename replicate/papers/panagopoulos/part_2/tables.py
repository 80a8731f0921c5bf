"""Table 1 of paper II and Table 2 of the supplement, which is meant to replace it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

from replicate.exhibits import rank
from replicate.exhibits.exclusion import Box
from replicate.loops import PID, Loop, Plant
from replicate.loops.bounds.gain_boxes import GainBox
from replicate.loops.sweep.pairs import pair_metrics
from replicate.papers.panagopoulos import certain, paper
from replicate.papers.panagopoulos.part_2 import certain_setpoint
from replicate.papers.panagopoulos.part_2.designs import Problem, optimal, printed
from replicate.papers.panagopoulos.part_2.load_experiment import load_experiment, loop_of
from replicate.papers.panagopoulos.part_2.printed_gains import printed_number
from replicate.papers.panagopoulos.part_2.processes import PLANTS, ROW_LABELS, ROWS, split
from replicate.papers.panagopoulos.part_2.properties import BAND, COLUMNS, LABELS, Properties
from replicate.papers.panagopoulos.part_2.setpoint import GRIDS_TRIED, Resonance, filter_corrected, weight

if TYPE_CHECKING:
    import pandas as pd

    from replicate.exhibits import Table

SUPERSEDED = "II-table-1"
REPLACEMENT = "IIs-table-2"
GAINS = ("k", "Ti", "Td")
LOST_TD = "G3 Ms=2.0"

Numbers = Mapping[str, float]
Point = tuple[str, Numbers]


def design_properties(row: str, problem: Problem = "stated") -> Properties:
    """Return the properties of a design."""
    return Properties.of(split(row)[0], optimal(row, problem))


def printed_properties(table: str, row: str) -> Properties:
    """Return the properties that follow from the gains a table prints."""
    return Properties.of(split(row)[0], printed(table, row))


ONE_SIDED = 0.05  # as in paper I: the last time above +5 % of the step, undershoot ignored


@cache
def one_sided_settling(table: str, row: str) -> float:
    """Return the settling time by paper I's definition, from the end of the dead time, for the printed gains."""
    process, _ = split(row)
    last = load_experiment(process, printed(table, row)).output.last_crossing(ONE_SIDED)
    return last - PLANTS[process].dead_time if last else 0.0


def _designs(table: Table, problem: Problem) -> Callable[[], pd.DataFrame]:
    return lambda: table.frame({row: design_properties(row, problem).row() for row in ROWS})


def _controller(given: Numbers) -> PID:
    """Return the controller with printed gains; where Td is lost, b of (15) gives it back."""
    td = given["Td"] if "Td" in given else given["b"] ** 2 * given["Ti"]
    return PID.ideal(given["k"], given["Ti"], td)


def _from_gains(row: str, given: Numbers) -> dict[str, float]:
    """Return what follows from printed gains."""
    return _not_given(Properties.of(split(row)[0], _controller(given)).row(), given)


def _from_many_gains(points: Sequence[Point]) -> list[dict[str, float] | None]:
    """Return what `_from_gains` does, for many at once."""
    found = Properties.of_many([(split(row)[0], _controller(given)) for row, given in points])
    return [_not_given(one.row(), given) if one else None for (_, given), one in zip(points, found, strict=True)]


def _not_given(found: Mapping[str, float], given: Numbers) -> dict[str, float]:
    return {column: number for column, number in found.items() if column not in {*GAINS, *given}}


def _loops(row: str, box: Box) -> tuple[Plant, GainBox]:
    k, ti = certain.side(box, "k"), certain.side(box, "Ti")
    b = certain.side(box, "b") if "Td" not in box else None
    return PLANTS[split(row)[0]], GainBox.of_times(k, ti, b * b * ti if b else certain.side(box, "Td"))


class _WithFilter:
    """The row with (16) over the frequency of a peak; without the integrals of responses if not complete."""

    def __init__(self, peak_of: Callable[[Loop], Resonance] | None, *, complete: bool) -> None:
        self.peak_of, self.complete = peak_of, complete

    def __call__(self, row: str, given: Numbers) -> dict[str, float]:
        """Return the row for printed gains."""
        controller = _controller(given)
        loop = loop_of(split(row)[0], controller)
        exact = Resonance.of(loop)
        if self.complete:
            return _from_gains(row, given) | {"Tsp": self._size(row, controller, exact)}
        return self._row(row, given, exact, loop.sensitivity_peak().frequency)

    def many(self, points: Sequence[Point]) -> list[dict[str, float] | None]:
        """Return the rows for many gains at once."""
        loops = [(split(row)[0], _controller(given)) for row, given in points]
        if self.complete:
            found = Properties.of_many(loops)
            return [
                _not_given(one.row(), given) | {"Tsp": self._size(row, _controller(given), one.peak)} if one else None
                for (row, given), one in zip(points, found, strict=True)
            ]
        peaks = pair_metrics([(PLANTS[process], pid) for process, pid in loops], ("mp_frequency", "mp", "ms_frequency"))
        return [
            self._row(row, given, Resonance(*one[:2]), one[2]) if one else None
            for (row, given), one in zip(points, peaks, strict=True)
        ]

    def _row(self, row: str, given: Numbers, exact: Resonance, w0: float) -> dict[str, float]:
        controller = _controller(given)
        found = {
            "b": weight(controller, exact),
            "Tsp": self._size(row, controller, exact),
            "IE": 1.0 / controller.ki,
            "w0": w0,
            "Mp": exact.value,
        }
        return _not_given(found, given)

    def _size(self, row: str, controller: PID, exact: Resonance) -> float:
        """Return the time constant; whether there is a filter at all is decided by the exact peak."""
        size = filter_corrected(controller, exact)
        if not size or self.peak_of is None:
            return size
        return filter_corrected(controller, self.peak_of(loop_of(split(row)[0], controller)))


def _trials(table: Table) -> dict[str, tuple[str, str]]:
    """Return plant and printed controller, with the printed set-point filter where there is one."""
    found = {}
    for row in ROWS:
        filter_time = printed_number(table.id, row, "Tsp")
        controller = replace(printed(table.id, row), setpoint_filter=0.0 if math.isnan(filter_time) else filter_time)
        found[row] = PLANTS[split(row)[0]].notation(), controller.notation()
    return found


def _add_readings(table: Table) -> None:
    # The scan of the superseded table has lost one derivative time.
    lost = {LOST_TD: ("k", "Ti", "b")} if table.id == SUPERSEDED else {}
    followed = certain.rules(_loops, "IE", "w0", "Mp", "IE/IAE") | certain.settling(_loops, BAND)
    table.reading(
        "as-written",
        "The optimum of the stated problem",
        "The largest $k_i$ under the circle, negative curvature and falling phase on the search range of section 4 of "
        "the supplement; for $G_1$ (integrating) and $G_3$ (a pole close to zero, seen from its other poles) without "
        "the curvature, as the text says. The other columns follow from these gains: $b$ by (13) and (15), $T_{sp}$ by "
        "(16) as printed. The text gives no band for $t_s$: here it is the time after which the response to a unit "
        "load stays within ±0.02.",
    )(_designs(table, "stated"))
    table.reading(
        "printed-gains",
        "The other columns from the printed gains",
        "What follows from the printed $k$, $T_i$ and $T_d$ by the same formulas; this says nothing about the "
        "gains themselves."
        + (
            " $T_d$ of $G_3$, $M_s = 2.0$, is missing in the scan; it is taken from the printed $b = \\sqrt{T_d/T_i}$."
            if table.id == SUPERSEDED
            else ""
        ),
        inputs=GAINS,
        inputs_of=lost,
        rules_out=followed | certain_setpoint.rules("as printed"),
        many=_from_many_gains,
    )(_from_gains)
    corrected = _WithFilter(None, complete=False)
    coarse = _WithFilter(Resonance.on_coarse_grid, complete=table.id == SUPERSEDED)
    table.reading(
        "filter-corrected",
        "The printed gains, (16) over $\\omega_{mp}$",
        "$T_{sp} = \\sqrt{k_i^2M_p^2/A-1}/\\omega_{mp}$, which does what the text intends; the print divides by "
        "$\\omega_{mp}^2$.",
        inputs=GAINS,
        inputs_of=lost,
        rules_out=certain.rules(_loops, "IE", "w0", "Mp") | certain_setpoint.rules("corrected"),
        many=corrected.many,
    )(corrected)
    table.reading(
        "filter-coarse-grid",
        "The same, with the peak read off 50 frequencies",
        "As before, with the peak of $|T|$ taken from `logspace(-2,2)`. 50 is the number of points that this function "
        "takes by itself; the two decades on either side of one are our choice, and the paper says nothing of a grid.",
        inputs=GAINS,
        inputs_of=lost,
        tried={name: len(values) for name, values in GRIDS_TRIED.items()} | {"power of $\\omega_{mp}$ in (16)": 2},
        rules_out=followed | certain_setpoint.rules("coarse grid"),
        many=coarse.many,
    )(coarse)
    table.reading(
        "paper-1-settling",
        "The settling time of paper I",
        "$t_s$ as the numbers of paper I show it: the last time at which the load response is above $+0.05$, "
        "undershoot ignored, counted from the end of the dead time; for the printed gains.",
        # signals, scales, sides and bands, as the table of definitions lists them
        tried={"signal": 3, "scale of the band": 2, "sides of the band": 2, "band": 5},
    )(lambda: table.frame({row: {"ts": one_sided_settling(table.id, row)} for row in ROWS}))
    table.reading(
        "ms-only",
        "The optimum under the circle alone",
        "The largest $k_i$ with neither curvature nor phase constraint.",
    )(_designs(table, "ms-only"))
    table.trials = lambda: _trials(table)
    for process in PLANTS:
        pair = [row for row in ROWS if split(row)[0] == process]
        rank(table, "ts", pair, f"{process} settles sooner with the larger $M_s$")
        rank(table, "k", pair, f"the gain for {process} is larger with the larger $M_s$")


table_1 = paper.table(
    SUPERSEDED,
    "Properties of the controllers for $G_1$ to $G_8$ (superseded)",
    rows=ROWS,
    columns=COLUMNS,
    caption="The table of the conference paper, which the errata replace.",
    labels=ROW_LABELS | LABELS,
)
_add_readings(table_1)


def replacement() -> Table:
    """Define the table of the errata; its module calls this where the supplement stands in the thesis."""
    table = paper.table(
        REPLACEMENT,
        "Properties of the controllers for $G_1$ to $G_8$ (errata)",
        rows=ROWS,
        columns=COLUMNS,
        caption="The table of the errata, which replaces Table 1 of the paper.",
        labels=ROW_LABELS | LABELS,
    )
    _add_readings(table)
    return table
