"""Example 1: a pure dead time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import complementary_peak, design
from replicate.papers.panagopoulos.part_1.phase import frequencies_of_lag
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    import pandas as pd

LABELS = {
    "w90": "$\\omega_{90}$",
    "w150": "$\\omega_{150}$",
    "w180": "$\\omega_{180}$",
    **{
        f"{key}_{ms}": f"${symbol}$, $M_s = {ms}$"
        for ms in ("1.4", "2.0")
        for key, symbol in (("k", "k"), ("ki", "k_i"), ("Ti", "T_i"), ("w0", "\\omega_0"), ("Mp", "M_p"))
    },
    "value": "Value",
}

example_1 = paper.table(
    "I-example-1",
    "Pure dead time, $G_7(s) = e^{-s}$",
    kind="example",
    printed=False,
    rows=("w90", "w180", "k_1.4", "ki_1.4", "Ti_1.4", "w0_1.4", "k_2.0", "ki_2.0", "Ti_2.0", "w0_2.0"),
    columns=("value",),
    caption="The text gives $\\omega_{90} = \\pi/2$ and $\\omega_{180} = \\pi$ and refers to Table 2 for the "
    "controllers.",
    shared_labels=LABELS,
)


def designs_at(plant: str) -> dict[str, float]:
    """Return gains, integral times, frequencies and resonance peaks for Ms = 1.4 and 2.0."""
    found: dict[str, float] = {}
    for ms in (1.4, 2.0):
        values = design(plant, ms)
        found |= {f"k_{ms}": values.k, f"ki_{ms}": values.ki, f"Ti_{ms}": values.integral_time}
        found |= {f"w0_{ms}": values.frequency, f"Mp_{ms}": complementary_peak(plant, ms).value}
    return found


@example_1.reading("as-written", "As written")
def as_written() -> pd.DataFrame:
    """Compute the frequencies and the designs."""
    lags = {f"w{degrees}": frequencies_of_lag(PLANTS["G7"], degrees)[0] for degrees in (90, 180)}
    values = {**lags, **designs_at("G7")}
    return example_1.frame({row: values[row] for row in example_1.rows})
