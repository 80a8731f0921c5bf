"""Table 4: example 8, the pure dead time with a filter on the measurement."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Literal

from replicate.exhibits import rank
from replicate.exhibits.exclusion import Box
from replicate.loops import PI, PIDesign, Plant, design_pi
from replicate.loops.bounds.gain_boxes import GainBox
from replicate.papers.panagopoulos import certain, paper
from replicate.papers.panagopoulos.part_1.designs import design
from replicate.papers.panagopoulos.part_1.labels import COLUMNS
from replicate.papers.panagopoulos.part_1.plants import PLANTS, filtered_dead_time

if TYPE_CHECKING:
    import pandas as pd

MS = 2.0
NOISE_CORNER = 2.0  # a of the noise model s/(s + a)
NOISE_DENSITY = 1.0  # phi

INFINITY = "\\infty"
FACTORS = {"m=2": 2.0, "m=5": 5.0, "m=10": 10.0, "m=20": 20.0, "m=inf": math.inf}


@dataclass(frozen=True)
class Filtered:
    """A filter and the design that knows of it."""

    filter_time: float
    found: PIDesign

    @property
    def plant(self) -> Plant:
        """The dead time behind the filter."""
        return filtered_dead_time(self.filter_time)

    @property
    def sigma(self) -> float:
        """Standard deviation of the control signal."""
        return deviation(self.found.k, self.found.ki, self.filter_time)


def deviation(k: float, ki: float, filter_time: float) -> float:
    """Return the control signal's standard deviation by the paper's formula, |S| replaced by Ms; inf without filter."""
    a, tf = NOISE_CORNER, filter_time
    if tf == 0.0:
        return math.inf
    variance = MS**2 * NOISE_DENSITY * (a * k**2 + ki**2 * tf) / (2.0 * a * tf * (1.0 + a * tf))
    return math.sqrt(variance)


@cache
def filtered(m: float) -> Filtered:
    """Return the filter (26) for one m, and the design repeated with it."""
    unfiltered = design("G7", MS)
    if math.isinf(m):
        return Filtered(0.0, unfiltered)
    filter_time = 1.0 / (m * unfiltered.frequency)  # (26)
    return Filtered(filter_time, design_pi(filtered_dead_time(filter_time), ms=MS))


table_4 = paper.table(
    "I-table-4",
    "Noise filtering for the pure dead time $G_7$, $M_s = 2$",
    rows=tuple(FACTORS),
    columns=("k", "ki", "w0", "IE", "sigma", "Ti/Tf"),
    caption="The filter $1/(1+sT_f)$ has $T_f = 1/(m\\omega_0)$, and the design is repeated with it; "
    "$\\sigma$ is the standard deviation of the control signal for white noise through $s/(s+2)$. Without "
    "filter ($m = \\infty$) $\\sigma$ is infinite.",
    shared_labels=COLUMNS,
    labels={key: f"${key.replace('=', ' = ').replace('inf', INFINITY)}$" for key in FACTORS},
)


def _trials() -> dict[str, tuple[str, str]]:
    """Return the dead time behind each filter, as the printed ratio gives it, with the printed gains."""
    printed, found = paper.printed_numbers(table_4.id), {}
    for row, m in FACTORS.items():
        k, ki = printed[row, "k"], printed[row, "ki"]
        filter_time = k / ki / printed[row, "Ti/Tf"] if math.isfinite(m) else 0.0
        plant = filtered_dead_time(filter_time) if filter_time else PLANTS["G7"]
        found[row] = plant.notation(), PI(k, ki).notation()
    return found


table_4.trials = _trials

for _column in ("IE", "sigma"):
    _finite = [row for row, m in FACTORS.items() if math.isfinite(m)]
    rank(table_4, _column, _finite, "a smaller $m$ costs performance and filters more")


def _table(filter_of_ratio: Literal["first", "new"]) -> pd.DataFrame:
    rows = {}
    for row, m in FACTORS.items():
        case = filtered(m)
        found = case.found
        filter_time = case.filter_time if filter_of_ratio == "first" else 1.0 / (m * found.frequency)
        ratio = found.integral_time / filter_time if filter_time else math.nan
        sigma = case.sigma if case.filter_time else math.nan
        rows[row] = [found.k, found.ki, found.frequency, 1.0 / found.ki, sigma, ratio]
    return table_4.frame(rows)


@table_4.reading(
    "as-written",
    "One filter for all columns",
    note="$T_f$ comes from the $\\omega_0$ of the design without filter, as the text says, and IE is $1/k_i$.",
)
def as_written() -> pd.DataFrame:
    """Compute the table with the filter that the design was made with."""
    return _table("first")


@table_4.reading(
    "authors",
    "$T_i/T_f$ with $T_f$ from the new $\\omega_0$",
    note="The last column divides by $1/(m\\omega_0)$ with the $\\omega_0$ of its own row; design and "
    "$\\sigma$ use the first filter.",
    tried={"$\\omega_0$ of $T_f$": 2},
)
def authors() -> pd.DataFrame:
    """Compute the table with the last column's other filter."""
    return _table("new")


def _loops(_: str, box: Box) -> tuple[Plant, GainBox]:
    return PLANTS["G7"], GainBox(certain.side(box, "k"), certain.side(box, "ki"))


@table_4.reading(
    "printed-gains",
    "With the printed gains",
    note="IE is $1/k_i$ of the printed $k_i$, and $\\sigma$ follows from the printed gains and the exact filter.",
    inputs=("k", "ki"),
    rules_out=certain.rules(_loops, "IE"),
)
def from_print(row: str, given: Mapping[str, float]) -> dict[str, float]:
    """Compute what follows from the printed gains of a row."""
    found = {"IE": 1.0 / given["ki"]}
    if filter_time := filtered(FACTORS[row]).filter_time:
        found["sigma"] = deviation(given["k"], given["ki"], filter_time)
    return found
