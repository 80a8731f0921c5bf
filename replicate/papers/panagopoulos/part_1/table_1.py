"""Table 1: the controllers for G1 to G6, with what they do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from replicate.exhibits import bound, rank
from replicate.exhibits.exclusion import Box
from replicate.loops import PI, Loop, Plant
from replicate.loops.bounds.gain_boxes import GainBox
from replicate.loops.sweep.pairs import pair_metrics
from replicate.papers.panagopoulos import certain, paper
from replicate.papers.panagopoulos.part_1.designs import (
    BOUNDS,
    SIX,
    complementary_peak,
    design,
    load_response,
    weight,
)
from replicate.papers.panagopoulos.part_1.frequency_grid import (
    DECADES_TRIED,
    FIRST_TRIED,
    POINTS_TRIED,
    peak_on_grid,
    weight_on_grid,
)
from replicate.papers.panagopoulos.part_1.labels import COLUMNS, design_rows
from replicate.papers.panagopoulos.part_1.plants import PLANTS, label
from replicate.papers.panagopoulos.part_1.printed_gains import printed_weights, trials
from replicate.papers.panagopoulos.part_1.settling import BAND, one_sided, since_dead_time, two_sided

if TYPE_CHECKING:
    import pandas as pd

ROWS = {f"{plant} Ms={ms}": (plant, ms) for plant in SIX for ms in BOUNDS}

table_1 = paper.table(
    "I-table-1",
    "Controllers for $G_1$ to $G_6$",
    rows=tuple(ROWS),
    columns=("k", "Ti", "b", "IE", "IE/IAE", "w0", "ts", "Mp"),
    caption="Largest $k_i$ for a given $M_s$: gain, integral time, set-point weight, integrated error of a "
    "unit load step and its ratio to the integrated absolute error, frequency at which the Nyquist curve "
    "touches the circle, settling time of the load response, and resonance peak. The paper's caption says "
    "$G_1$ to $G_7$. The column of $M_p$ is at the edge of the page: a question mark is a last digit that is missing "
    "or damaged in the copy at hand. (Where Table 5 prints the same design, for $G_2$ and $M_s = 1.6$, the whole "
    "number can be read.)",
    shared_labels=COLUMNS,
    labels=design_rows(ROWS),
)
table_1.trials = lambda: trials(
    table_1.id, {row: plant for row, (plant, _) in ROWS.items()}, printed_weights(table_1.id)
)

for _ms in BOUNDS:
    _designs = [f"{_plant} Ms={_ms}" for _plant in SIX]
    bound(table_1, "Mp", _designs, "$M_p$ is at most $M_s$", below=_ms, consequence="comparison")
for _plant in SIX:
    _pair = [f"{_plant} Ms={_ms}" for _ms in (BOUNDS[0], BOUNDS[-1])]
    rank(table_1, "ts", _pair, f"{label(_plant)} settles sooner with the larger $M_s$")
    rank(table_1, "IE/IAE", _pair, f"the response of {label(_plant)} swings more with the larger $M_s$")


def _rows(w0: dict[str, float], b: dict[str, float], ts: dict[str, float]) -> pd.DataFrame:
    rows = {}
    for row, (plant, ms) in ROWS.items():
        found = design(plant, ms)
        response = load_response(plant, ms)
        ie = 1.0 / found.ki
        rows[row] = [
            found.k,
            found.integral_time,
            b[row],
            ie,
            ie / response.iae(),
            w0[row],
            ts[row],
            complementary_peak(plant, ms).value,
        ]
    return table_1.frame(rows)


@table_1.reading(
    "as-written",
    "As the text says",
    note="$\\omega_0$ is the root of (18); $b$ follows (25) at $\\omega_{mp}$, the peak of $|L/(1+L)|$, as "
    "(24) says; IE is $1/k_i$. The text does not define $t_s$: here it is the last time at which the response "
    "to a unit load is outside $\\pm 5$ %, dead time included.",
)
def as_written() -> pd.DataFrame:
    """Compute the table by the definitions of the text."""
    return _rows(
        {row: design(*key).frequency for row, key in ROWS.items()},
        {row: weight(*key, "w_mp") for row, key in ROWS.items()},
        {row: two_sided(load_response(*key)) for row, key in ROWS.items()},
    )


@table_1.reading(
    "authors",
    "As the numbers were made: $b$ at $\\omega_0$, $\\omega_0$ on a grid, one-sided $t_s$",
    note="The printed $\\omega_0$ is the point of a grid at which $|S|$ is largest: 200 logarithmic points "
    "over three decades, 0.01 to 10 for $G_1$ and $G_5$, 0.1 to 100 for $G_2$ and $G_6$, 0.001 to 1 for $G_4$ "
    "(for $G_3$ no such grid was found, and the exact $\\omega_0$ fits). Equation (25) is evaluated there, "
    "not at $\\omega_{mp}$. $t_s$ is the last time at which the response is above $+5$ %, whatever it does "
    "below zero, and for $G_3$ counts from the end of the dead time.",
    tried={
        "points of the grid": len(POINTS_TRIED),
        "its decades": len(DECADES_TRIED),
        "the first of them, by plant": len(FIRST_TRIED) ** len(SIX),
        "frequency for $b$": 2,
        "level of $t_s$": 3,
        "sides of $t_s$": 2,
    },
)
def authors() -> pd.DataFrame:
    """Compute the table by the rules that its numbers follow."""
    return _rows(
        {row: peak_on_grid(*key) for row, key in ROWS.items()},
        {row: weight_on_grid(*key) for row, key in ROWS.items()},
        {row: one_sided(load_response(*key), PLANTS[key[0]].dead_time) for row, key in ROWS.items()},
    )


def _loops(row: str, box: Box) -> tuple[Plant, GainBox]:
    return PLANTS[ROWS[row][0]], GainBox.of_times(certain.side(box, "k"), certain.side(box, "Ti"))


def _printed_loop(row: str, given: Mapping[str, float]) -> tuple[Plant, PI]:
    return PLANTS[ROWS[row][0]], PI.from_integral_time(given["k"], given["Ti"])


def _from_many_prints(points: Sequence[tuple[str, Mapping[str, float]]]) -> list[dict[str, float] | None]:
    """Compute what many printed controllers do."""
    loops = [_printed_loop(*point) for point in points]
    found = pair_metrics(loops, ("load_iae", "load_last_above", "mp"), BAND)
    return [
        _properties(pi, one[0], since_dead_time(one[1], plant.dead_time), one[2]) if one else None
        for (plant, pi), one in zip(loops, found, strict=True)
    ]


def _properties(pi: PI, iae: float, ts: float, mp: float) -> dict[str, float]:
    return {"IE": 1.0 / pi.ki, "IE/IAE": 1.0 / pi.ki / iae, "ts": ts, "Mp": mp}


@table_1.reading(
    "printed-gains",
    "With the printed gain and integral time",
    note="What follows from the printed $k$ and $T_i$, by the rules of the reading before.",
    inputs=("k", "Ti"),
    rules_out=certain.rules(_loops, "IE", "Mp", "IE/IAE")
    | certain.settling(_loops, BAND, one_sided=True, from_dead_time=True),
    many=_from_many_prints,
)
def from_print(row: str, given: Mapping[str, float]) -> dict[str, float]:
    """Compute what a printed controller does."""
    plant, pi = _printed_loop(row, given)
    loop = Loop(plant, pi)
    load = loop.load_step()
    return _properties(pi, load.iae(), one_sided(load, plant.dead_time), loop.complementary_peak().value)
