"""Exhibits the paper does not have, which show how single digits of it were judged."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from replicate.exhibits.matching import meets
from replicate.papers.khan import paper
from replicate.papers.khan.definitions import VERSIONS, specifications_of
from replicate.papers.khan.processes import LOAD_AT, loop, settling_after_load
from replicate.papers.khan.tables import QUANTITIES

if TYPE_CHECKING:
    import pandas as pd

swapped = paper.table(
    "swapped-rows",
    "The load settling times of Haalman and Bryant in Table I",
    printed=False,
    columns=("printed", "own", "other", "off_own", "off_other", "digits_own", "digits_other"),
    caption="Each printed $t_d$ against the exact value of its own row and of the other row (load at $t = 100$, as the "
    "text says), the differences in per cent, and the number of digits that differ at the precision of the print. In "
    "its own row neither number is close; in the other's row, one agrees in every digit and the other in all but one.",
    labels={
        "printed": "printed", "own": "exact", "other": "exact, other row", "off_own": "off (%)",
        "off_other": "off, other row (%)", "digits_own": "wrong digits", "digits_other": "wrong digits, other row",
    },
)  # fmt: skip

scaling = paper.table(
    "scaling",
    "Cancelled loops depend on $t/h$ alone: the prints scatter",
    printed=False,
    columns=("table_1", "ph1", "ph0.1", "example_3_1", "exact"),
    caption="With the pole cancelled, (6) has no time constant left: overshoot and settling time over $h$ must be the "
    "same for every $h$. The printed values, divided by $h$, scatter, all at or below the exact ones: the simulations "
    "of the time carry errors of a few tenths of a per cent, more than half a unit of the last digits they print.",
    labels={
        "table_1": "Table I, $h = 10$", "ph1": "Table II, $h = 1$", "ph0.1": "Table II, $h = 0.1$",
        "example_3_1": "Example 3.1, $h = 1.82$", "exact": "exact",
    },
)  # fmt: skip

cohen_coon = paper.table(
    "cohen-coon",
    "Cohen-Coon at $ph = 1$: what was tried",
    printed=False,
    columns=("KP", "KI", *QUANTITIES, "met_ph1", "met_ph0.1"),
    caption="Versions of the rule at $ph = 1$, and how many of the four printed numbers each reproduces, there "
    "and at $ph = 0.1$. The first row is the print.",
    labels={"KP": "$K_P$", "KI": "$K_I$", "Mp": "$M_P$ (%)", "ts": "$t_s$", "td": "$t_d$", "Ms": "$M_s$",
            "met_ph1": "met at $ph = 1$", "met_ph0.1": "met at $ph = 0.1$"},
)  # fmt: skip


@swapped.reading("as-written", "Own row and other row")
def swapped_rows() -> pd.DataFrame:
    """Compare both printed times with both exact ones."""
    pair = ("Haalman", "Bryant")
    printed = paper.printed_cells("table-1")
    exact = {rule: settling_after_load(loop(rule, 1.0, 10.0), LOAD_AT[10.0]) for rule in pair}
    rows = {}
    for rule, other in (pair, pair[::-1]):
        text = printed[rule, "td"]
        own, crossed = (_against(text, exact[name]) for name in (rule, other))
        rows[rule] = [float(text), exact[rule], exact[other], own[0], crossed[0], own[1], crossed[1]]
    return swapped.frame(rows)


def _against(text: str, value: float) -> tuple[float, float]:
    """Return the difference in per cent and the number of digits that differ at the print's precision."""
    shown = f"{value:.{len(text.partition('.')[2])}f}"
    return 100.0 * (float(text) / value - 1.0), float(sum(a != b for a, b in zip(text, shown, strict=True)))


@scaling.reading("as-written", "Printed times over $h$")
def scaled() -> pd.DataFrame:
    """Divide the printed times of the cancelled loops by the dead time."""
    first, second, example = (paper.printed_cells(id) for id in ("table-1", "table-2", "example-3-1"))
    rows = {}
    for rule in ("Haalman", "Bryant"):
        y = loop(rule, 1.0, 1.0).step()
        cells = (
            (first[rule, "ts"], 10.0), (second[rule, "ph1_ts"], 1.0), (second[rule, "ph0.1_ts"], 0.1),
            (example[f"{rule}_ts", "value"], 1.82),
        )  # fmt: skip
        rows[f"{rule}, ts/h"] = [*(float(text) / h for text, h in cells), y.settling_time(0.02)]
        tr = float(example[f"{rule}_tr", "value"]) / 1.82
        rows[f"{rule}, tr/h"] = [math.nan, math.nan, math.nan, tr, y.rise_time()]
    return scaling.frame(rows)


@cohen_coon.reading("as-written", "Versions of the rule")
def cohen_coon_versions() -> pd.DataFrame:
    """Evaluate every version at ph = 1 and count the cells it meets."""
    printed = paper.printed_cells("table-2")
    rows: dict[str, list[float]] = {
        "printed": [math.nan, math.nan, *(float(printed["CC", f"ph1_{q}"]) for q in QUANTITIES), 4.0, 4.0]
    }
    for name, version in VERSIONS["CC"].items():
        found = {h: specifications_of(version(h), h) for h in (1.0, 0.1)}
        met = [float(sum(meets(printed["CC", f"ph{h:g}_{q}"], found[h][q]) for q in QUANTITIES)) for h in (1.0, 0.1)]
        rows[name.removeprefix("CC: ")] = [*version(1.0), *(found[1.0][q] for q in QUANTITIES), *met]
    return cohen_coon.frame(rows)
