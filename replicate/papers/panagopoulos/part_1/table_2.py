"""Table 2: the controllers for G7 to G11."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from replicate.exhibits.exclusion import Box
from replicate.loops import PI, Loop, Plant
from replicate.loops.bounds.gain_boxes import GainBox
from replicate.loops.sweep.pairs import pair_metrics
from replicate.papers.panagopoulos import certain, paper
from replicate.papers.panagopoulos.part_1.designs import WeightRule, complementary_peak, design, weight
from replicate.papers.panagopoulos.part_1.labels import COLUMNS, design_rows
from replicate.papers.panagopoulos.part_1.plants import PLANTS
from replicate.papers.panagopoulos.part_1.printed_gains import printed_weights, trials

if TYPE_CHECKING:
    import pandas as pd

ROWS = {f"{plant} Ms={ms}": (plant, ms) for plant in ("G7", "G8", "G9", "G10", "G11") for ms in (1.4, 2.0)}

table_2 = paper.table(
    "I-table-2",
    "Controllers for $G_7$ to $G_{11}$",
    rows=tuple(ROWS),
    columns=("k", "ki", "b", "w0", "Mp"),
    caption="A pure dead time, an integrator with dead time, the heat equation, and a plant with and without "
    "a slow mode (examples 1 to 4).",
    shared_labels=COLUMNS,
    labels=design_rows(ROWS),
)
table_2.trials = lambda: trials(
    table_2.id, {row: plant for row, (plant, _) in ROWS.items()}, printed_weights(table_2.id)
)


def _table(rule: WeightRule) -> pd.DataFrame:
    rows = {}
    for row, key in ROWS.items():
        found = design(*key)
        rows[row] = [found.k, found.ki, weight(*key, rule), found.frequency, complementary_peak(*key).value]
    return table_2.frame(rows)


@table_2.reading("as-written", "As the text says", note="$b$ by (25) at the peak of $|L/(1+L)|$, as (24) says.")
def as_written() -> pd.DataFrame:
    """Compute the table by the definitions of the text."""
    return _table("w_mp")


@table_2.reading(
    "authors",
    "$b$ at $\\omega_0$",
    note="As written, but with (25) evaluated at $\\omega_0$, the peak of the sensitivity.",
    tried={"frequency for $b$": 2},
)
def authors() -> pd.DataFrame:
    """Compute the table with the set-point weight's other frequency."""
    return _table("w_0")


def _loops(row: str, box: Box) -> tuple[Plant, GainBox]:
    return PLANTS[ROWS[row][0]], GainBox(certain.side(box, "k"), certain.side(box, "ki"))


def _printed_loop(row: str, given: Mapping[str, float]) -> tuple[Plant, PI]:
    return PLANTS[ROWS[row][0]], PI(given["k"], given["ki"])


def _from_many_prints(points: Sequence[tuple[str, Mapping[str, float]]]) -> list[dict[str, float] | None]:
    """Compute the two peaks of many printed controllers."""
    found = pair_metrics([_printed_loop(*point) for point in points], ("ms_frequency", "mp"))
    return [dict(zip(("w0", "Mp"), one, strict=True)) if one else None for one in found]


@table_2.reading(
    "printed-gains",
    "With the printed gains",
    note="$\\omega_0$ and $M_p$ of the loop with the printed $k$ and $k_i$.",
    inputs=("k", "ki"),
    rules_out=certain.rules(_loops, "Mp"),
    many=_from_many_prints,
)
def from_print(row: str, given: Mapping[str, float]) -> dict[str, float]:
    """Compute the two peaks of a printed controller."""
    loop = Loop(*_printed_loop(row, given))
    return {"w0": loop.sensitivity_peak().frequency, "Mp": loop.complementary_peak().value}
