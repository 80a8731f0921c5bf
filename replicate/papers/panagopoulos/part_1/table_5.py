"""Table 5: Ziegler-Nichols, lambda tuning and the new design, for G1, G2 and G3."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING

from replicate.exhibits import rank
from replicate.exhibits.exclusion import Box, Ends
from replicate.loops import PI, Loop, Plant, Signal
from replicate.loops.bounds.gain_boxes import GainBox
from replicate.loops.bounds.intervals import Interval, exactly
from replicate.loops.bounds.response_boxes import setpoint_errors
from replicate.loops.sweep.pairs import pair_metrics
from replicate.papers.panagopoulos import certain, paper
from replicate.papers.panagopoulos.part_1.designs import design, weight
from replicate.papers.panagopoulos.part_1.frequency_grid import weight_on_grid
from replicate.papers.panagopoulos.part_1.labels import COLUMNS
from replicate.papers.panagopoulos.part_1.plants import PLANTS, label
from replicate.papers.panagopoulos.part_1.printed_gains import printed_weights, trials
from replicate.papers.panagopoulos.part_1.settling import BAND, one_sided, since_dead_time, two_sided
from replicate.papers.panagopoulos.part_1.simple_models import METHODS, area_method, ziegler_nichols

if TYPE_CHECKING:
    import pandas as pd

MS = 1.6
METHOD_NAMES = {"ZN": "Ziegler–Nichols", "Lambda": "lambda tuning", "New": "new design"}
ROWS = {f"{plant} {method}": (plant, method) for plant in ("G1", "G2", "G3") for method in METHOD_NAMES}

table_5 = paper.table(
    "I-table-5",
    "Comparison with Ziegler–Nichols and lambda tuning",
    rows=tuple(ROWS),
    columns=("k", "Ti", "ki", "Ms", "IAE", "o", "ts", "Mp"),
    caption="Gains, maximum sensitivity, IAE and settling time of a unit load step, overshoot of a set-point "
    "step, resonance peak. Ziegler–Nichols is the frequency-response method, lambda tuning asks for three "
    "times the time constant, the new design for $M_s = 1.6$.",
    shared_labels=COLUMNS,
    labels={row: f"{label(plant)}, {METHOD_NAMES[method]}" for row, (plant, method) in ROWS.items()},
    units={"o": "%"},
)

for _plant in ("G1", "G2", "G3"):
    for _column in ("Ms", "IAE", "o", "ts", "Mp"):
        _methods = [f"{_plant} {_method}" for _method in METHOD_NAMES]
        rank(table_5, _column, _methods, f"the ranking of the three methods by {COLUMNS[_column]} for {label(_plant)}")


def _trials() -> dict[str, tuple[str, str]]:
    """Return the printed rows; the new design has the set-point weight that Table 1 prints for it."""
    weights = printed_weights("I-table-1")
    new = {row: weights[f"{plant} Ms={MS}"] for row, (plant, method) in ROWS.items() if method == "New"}
    return trials(table_5.id, {row: plant for row, (plant, _) in ROWS.items()}, new)


table_5.trials = _trials


def text_controller(plant: str, method: str) -> PI:
    """Return a controller as the text describes it, lambda tuning with the area method."""
    if method == "ZN":
        return ziegler_nichols(plant)
    if method == "Lambda":
        return area_method(plant).lambda_tuning()
    found = design(plant, MS)
    return PI(found.k, found.ki, weight(plant, MS, "w_mp"))


def authors_controller(plant: str, method: str) -> PI:
    """Return a controller as the numbers were made: lambda tuning with the printed gains, b by their rule."""
    if method == "Lambda":
        row = f"{plant} {method}"
        return PI(*(paper.printed_numbers("I-table-5")[row, column] for column in ("k", "ki")))
    if method == "New":
        found = design(plant, MS)
        return PI(found.k, found.ki, weight_on_grid(plant, MS))
    return text_controller(plant, method)


@cache
def responses(plant: str, k: float, ki: float, b: float) -> tuple[Signal, Signal]:
    """Return the responses to a set-point step and to a load step, each until it has died out."""
    loop = Loop(PLANTS[plant], PI(k, ki, b))
    return loop.step(), loop.load_step()


def _table(
    controller: Callable[[str, str], PI],
    overshoot: Callable[[Signal], float],
    settling: Callable[[Signal, str], float],
) -> pd.DataFrame:
    rows = {}
    for row, (plant, method) in ROWS.items():
        pi = controller(plant, method)
        loop = Loop(PLANTS[plant], pi)
        step, load = responses(plant, pi.k, pi.ki, pi.b)
        rows[row] = [
            pi.k,
            pi.integral_time,
            pi.ki,
            loop.sensitivity_peak().value,
            load.iae(),
            100.0 * overshoot(step),
            settling(load, plant),
            loop.complementary_peak().value,
        ]
    return table_5.frame(rows)


@table_5.reading(
    "as-written",
    "As the text says",
    note="Ziegler–Nichols: $k = 0.45K_u$, $T_i = T_u/1.2$, the only one of the usual factors that gives the "
    "printed gains. Lambda tuning: $k = T/(L+3T)$, $T_i = T$ with $T$ and $L$ from the area method (the text "
    "does not say how it finds them). Both have $b = 1$, the new design $b$ by (24) and (25). Overshoot "
    "relative to the final value; $t_s$ outside $\\pm 5$ %, dead time included.",
)
def as_written() -> pd.DataFrame:
    """Compute the table by the definitions of the text."""
    return _table(text_controller, lambda step: step.overshoot(), lambda load, _: two_sided(load))


def overshoot_of_peak(step: Signal) -> float:
    """Return what the peak exceeds the final value by, as a fraction of the peak."""
    peak = step.peak().value
    return max(peak - step.final, 0.0) / peak if step.overshoot() else 0.0


@table_5.reading(
    "authors",
    "As the numbers were made: overshoot relative to the peak, one-sided $t_s$, printed lambda gains",
    note="The overshoot is divided by the peak instead of the final value; $b$ of the new design is that of "
    "Table 1; $t_s$ is the last time above $+5$ %, from the end of the dead time. Lambda tuning is run with "
    "the printed $k$ and $k_i$, which are inputs here and so are not compared.",
    tried={"what the overshoot is relative to": 2, "frequency for $b$": 2, "level of $t_s$": 3, "sides of $t_s$": 2},
)
def authors() -> pd.DataFrame:
    """Compute the table by the rules that its numbers follow."""
    table = _table(authors_controller, overshoot_of_peak, lambda load, plant: one_sided(load, PLANTS[plant].dead_time))
    for row, (_, method) in ROWS.items():
        if method == "Lambda":
            table.loc[row, ["k", "Ti", "ki"]] = math.nan
    return table


def _loops(row: str, box: Box) -> tuple[Plant, GainBox]:
    return PLANTS[ROWS[row][0]], GainBox(certain.side(box, "k"), certain.side(box, "ki"))


def _overshoot_misses(row: str, box: Box, ends: Ends) -> bool:
    """Say whether the overshoot certainly misses an interval; the rule is for the rows with b = 1."""
    if ROWS[row][1] == "New":
        return False
    errors = setpoint_errors(*_loops(row, box))
    # the error at the peak is -excess; the overshoot is relative to the peak
    lowest = errors.trough() if errors else Interval(-math.inf, math.inf)
    excess = -lowest
    return excess.low > 0.0 and not (exactly(100.0) * excess / (exactly(1.0) + excess)).meets(*ends)


def _printed_loop(row: str, given: Mapping[str, float]) -> tuple[Plant, PI]:
    plant, method = ROWS[row]
    return PLANTS[plant], PI(given["k"], given["ki"], authors_controller(plant, method).b)


def _from_many_prints(points: Sequence[tuple[str, Mapping[str, float]]]) -> list[dict[str, float] | None]:
    """Compute what many printed controllers do."""
    loops = [_printed_loop(*point) for point in points]
    found = pair_metrics(loops, ("ms", "load_iae", "overshoot", "load_last_above", "mp"), BAND)
    return [
        {
            "Ms": one[0],
            "IAE": one[1],
            "o": 100.0 * one[2] / (1.0 + one[2]),  # relative to the peak
            "ts": since_dead_time(one[3], plant.dead_time),
            "Mp": one[4],
        }
        if one
        else None
        for (plant, _), one in zip(loops, found, strict=True)
    ]


@table_5.reading(
    "printed-gains",
    "With the printed gains",
    note="What follows from the printed $k$ and $k_i$, by the rules of the reading before; the new design has the "
    "set-point weight of that reading, the others have $b = 1$.",
    inputs=("k", "ki"),
    rules_out=certain.rules(_loops, "IAE")
    | certain.settling(_loops, BAND, one_sided=True, from_dead_time=True)
    | {"o": _overshoot_misses},
    many=_from_many_prints,
)
def from_print(row: str, given: Mapping[str, float]) -> dict[str, float]:
    """Compute what a printed controller does."""
    plant, pi = _printed_loop(row, given)
    loop = Loop(plant, pi)
    step, load = loop.step(), loop.load_step()
    return {
        "Ms": loop.sensitivity_peak().value,
        "IAE": load.iae(),
        "o": 100.0 * overshoot_of_peak(step),
        "ts": one_sided(load, plant.dead_time),
        "Mp": loop.complementary_peak().value,
    }


identification = paper.table(
    "I-lambda-models",
    "Models for lambda tuning",
    printed=False,
    rows=tuple(f"{plant} {symbol}" for plant in ("G1", "G2", "G3") for symbol in ("T", "L")),
    columns=(*METHODS, "implied"),
    caption="Time constant $T$ and dead time $L$ by five usual methods, and the values that the printed gains "
    "imply ($T = T_i$, $L = 1/k_i - 3T$). No method gives all of them; the area method is closest. $G_1$ and $G_3$ "
    "differ by a dead time only, so any method would give both the same $T$; the print does not.",
    labels={
        **{f"{plant} {symbol}": f"{label(plant)}, ${symbol}$" for plant in ("G1", "G2", "G3") for symbol in ("T", "L")},
        "area": "Area method",
        "two-points": "28 % and 63 %",
        "tangent": "Tangent",
        "tangent-63": "Tangent and 63 %",
        "moments": "Two moments",
        "implied": "Implied by the print",
    },
)


@identification.reading("as-written", "Exact step responses")
def models() -> pd.DataFrame:
    """Identify the three plants in five ways."""
    rows: dict[str, list[float]] = {}
    for plant in ("G1", "G2", "G3"):
        found = [method(plant) for method in METHODS.values()]
        integral_time, ki = (paper.printed_numbers("I-table-5")[f"{plant} Lambda", column] for column in ("Ti", "ki"))
        rows[f"{plant} T"] = [*(model.time_constant for model in found), integral_time]
        rows[f"{plant} L"] = [*(model.dead_time for model in found), 1.0 / ki - 3.0 * integral_time]
    return identification.frame(rows)
