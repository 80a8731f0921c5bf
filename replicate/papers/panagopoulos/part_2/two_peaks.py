"""A sensitivity with two equal peaks: which is the larger depends on digits of the gains that are not printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.extrema import largest
from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.designs import printed
from replicate.papers.panagopoulos.part_2.processes import PLANTS, split
from replicate.papers.panagopoulos.part_2.tables import SUPERSEDED

if TYPE_CHECKING:
    import pandas as pd

TWO_PEAKS = "G8 Ms=1.4"
peaks = paper.table(
    "II-two-peaks",
    "Two equal peaks of the sensitivity",
    printed=False,
    rows=("first", "second"),
    columns=("w", "S"),
    caption="$G_8$, $M_s = 1.4$, the printed gains of Table 1: the two highest local maxima of $|S|$.",
    labels={"w": r"$\omega$", "S": "$|S|$"},
)


@peaks.reading("as-written", "From the printed gains")
def two_peaks() -> pd.DataFrame:
    """Return the local maxima of the sensitivity."""
    loop = Loop(PLANTS[split(TWO_PEAKS)[0]], printed(SUPERSEDED, TWO_PEAKS))
    log_w = np.log(np.geomspace(0.1, 5.0, 1001))

    def sensitivity(x: float) -> float:
        return float(abs(1.0 / (1.0 + loop(1j * np.exp(x)))))

    size = np.array([sensitivity(float(x)) for x in log_w])
    at = np.nonzero((size[1:-1] > size[:-2]) & (size[1:-1] > size[2:]))[0] + 1
    found = [largest(sensitivity, log_w[i - 1 : i + 2]) for i in at]
    highest = sorted(sorted(found, key=lambda one: -one[1])[:2])
    return peaks.frame({row: (float(np.exp(x)), top) for row, (x, top) in zip(peaks.rows, highest, strict=True)})
