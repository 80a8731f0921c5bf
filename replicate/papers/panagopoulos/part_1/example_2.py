"""Example 2: an integrator with dead time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.example_1 import LABELS, designs_at
from replicate.papers.panagopoulos.part_1.phase import frequencies_of_lag
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    import pandas as pd

example_2 = paper.table(
    "I-example-2",
    "Integrator with dead time, $G_8(s) = e^{-s}/s$",
    kind="example",
    rows=("w90", "w180", "k_1.4", "ki_1.4", "Ti_1.4", "w0_1.4", "k_2.0", "ki_2.0", "Ti_2.0", "w0_2.0"),
    columns=("value",),
    caption="The text gives $\\omega_{90} = 0$ and $\\omega_{180} = \\pi/2$ and refers to Table 2 for the controllers.",
    shared_labels=LABELS,
)


@example_2.reading("as-written", "As written")
def as_written() -> pd.DataFrame:
    """Compute the frequencies and the designs."""
    lags = {f"w{degrees}": frequencies_of_lag(PLANTS["G8"], degrees)[0] for degrees in (90, 180)}
    values = {**lags, **designs_at("G8")}
    return example_2.frame({row: values[row] for row in example_2.rows})
