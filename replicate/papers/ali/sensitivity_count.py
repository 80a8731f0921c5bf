"""Which computation gives the printed Ms: a count over structures, dead-time models and ways to find the peak."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from replicate.exhibits.matching import meets
from replicate.papers.ali import paper
from replicate.papers.ali.sensitivities import Peak, designed, exact_peak, sensitivity, tabulated
from replicate.papers.ali.structures import (
    Settings,
    Structure,
    d_filter,
    ideal,
    series,
    unfiltered,
)
from replicate.papers.ali.table_1 import table_1
from replicate.papers.ali.table_2 import table_2
from replicate.papers.ali.toolchain import pade_sensitivity_norm, pade_sensitivity_peak

if TYPE_CHECKING:
    import pandas as pd

ORDERS = (2, 3, 4)


def _hypotheses() -> dict[str, tuple[str, Structure, Peak, Callable[[str, str], Settings]]]:
    """Return label, structure, way to find the peak and settings of each hypothesis."""
    found: dict[str, tuple[str, Structure, Peak, Callable[[str, str], Settings]]] = {
        "series-exact": ("(2), exact dead time, unrounded settings", series, exact_peak, designed),
        "series": ("(2), exact dead time", series, exact_peak, tabulated),
        "unfiltered": ("No filter, exact dead time", unfiltered, exact_peak, tabulated),
        "ideal": ("Parallel form, exact dead time", ideal, exact_peak, tabulated),
        "d-filter": ("Filter on D only, exact dead time", d_filter, exact_peak, tabulated),
    }
    for order in ORDERS:
        peak = partial(pade_sensitivity_peak, order=order)
        found[f"d-filter-pade-{order}"] = (f"Filter on D only, Padé {order}, true peak", d_filter, peak, tabulated)
    for order in ORDERS:
        norm = partial(pade_sensitivity_norm, order=order)
        found[f"d-filter-pade-{order}-norm"] = (
            f"Filter on D only, Padé {order}, norm at 1 %",
            d_filter,
            norm,
            tabulated,
        )
    norm = partial(pade_sensitivity_norm, order=3)
    found["d-filter-pade-3-norm-unrounded"] = (
        "Filter on D only, Padé 3, norm at 1\u00a0%, unrounded settings",
        d_filter,
        norm,
        designed,
    )
    fine = partial(pade_sensitivity_norm, order=3, tolerance=0.001)
    found["d-filter-pade-3-norm-fine"] = ("Filter on D only, Padé 3, norm at 0.1\u00a0%", d_filter, fine, tabulated)
    for name, structure in (("series", series), ("ideal", ideal)):
        title = "(2)" if name == "series" else "Parallel form"
        norm = partial(pade_sensitivity_norm, order=3)
        found[f"{name}-pade-3-norm"] = (f"{title}, Padé 3, norm at 1 %", structure, norm, tabulated)
    return found


HYPOTHESES = _hypotheses()

sensitivity_count = paper.table(
    "ms-count",
    "Printed $M_s$ reproduced, by hypothesis",
    printed=False,
    rows=tuple(HYPOTHESES),
    columns=("table_1", "table_2", "both", "largest_error", "printed"),
    caption="How many printed $M_s$ of Tables 1 and 2 are reproduced (rounded or truncated) under each combination "
    "of controller structure, model of the dead time and way to find the peak, and the largest relative "
    "deviation from the print in per cent. Except where it says unrounded, the settings are those of the reading "
    "*authors*.",
    labels={
        **{id: hypothesis[0] for id, hypothesis in HYPOTHESES.items()},
        "table_1": "Table 1",
        "table_2": "Table 2",
        "both": "Both",
        "largest_error": "Largest deviation (%)",
        "printed": "Of",
    },
)


@sensitivity_count.reading("as-written", "Number of printed values reproduced")
def count() -> pd.DataFrame:
    """Count the printed Ms that each hypothesis meets."""
    rows = {}
    for id, (_, structure, peak, settings) in HYPOTHESES.items():
        equal, deviations = [], []
        for table in (table_1, table_2):
            texts = paper.printed_cells(table.id)
            values = {row: sensitivity(table.id, row, structure, peak, settings) for row in table.rows}
            equal.append(sum(meets(texts[row, "Ms"], value) for row, value in values.items()))
            deviations += [abs(value / float(texts[row, "Ms"]) - 1.0) for row, value in values.items()]
        rows[id] = [*equal, sum(equal), 100.0 * max(deviations), len(deviations)]
    return sensitivity_count.frame(rows)
