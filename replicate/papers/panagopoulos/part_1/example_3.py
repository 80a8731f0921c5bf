"""Example 3: the heat equation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.example_1 import LABELS, designs_at
from replicate.papers.panagopoulos.part_1.phase import frequencies_of_lag
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    import pandas as pd

LAGS = (90, 150, 180)

example_3 = paper.table(
    "I-example-3",
    "A distributed-parameter plant, $G_9(s) = e^{-\\sqrt{s}}$",
    kind="example",
    rows=(
        *(f"w{degrees}" for degrees in LAGS),
        "k_1.4",
        "ki_1.4",
        "w0_1.4",
        "k_2.0",
        "ki_2.0",
        "w0_2.0",
        "ki_ratio",
    ),
    columns=("value",),
    caption="Frequencies at which the plant lags by 90, 150 and 180 degrees; the controllers are in Table 2. "
    "The last row is the gain in $k_i$ from $M_s = 1.4$ to 2, the text's “significant increase in "
    "performance”.",
    shared_labels=LABELS,
    labels={"ki_ratio": "$k_i(2.0)/k_i(1.4)$"},
)


@example_3.reading("as-written", "As written")
def as_written() -> pd.DataFrame:
    """Compute the frequencies and the designs."""
    values = {
        **{f"w{degrees}": frequencies_of_lag(PLANTS["G9"], degrees)[0] for degrees in LAGS},
        **designs_at("G9"),
    }
    values["ki_ratio"] = values["ki_2.0"] / values["ki_1.4"]
    return example_3.frame({row: values[row] for row in example_3.rows})
