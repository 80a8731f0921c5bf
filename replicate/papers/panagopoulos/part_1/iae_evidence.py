"""An exhibit that the paper does not have: how long the printed IAE of Ziegler-Nichols had been integrated."""

from __future__ import annotations

from typing import TYPE_CHECKING

from scipy.optimize import brentq

from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.plants import PLANTS
from replicate.papers.panagopoulos.part_1.simple_models import ziegler_nichols
from replicate.papers.panagopoulos.part_1.table_5 import table_5

if TYPE_CHECKING:
    import pandas as pd

ROWS = {f"{plant} ZN": plant for plant in ("G1", "G2", "G3")}

evidence = paper.table(
    "I-iae-horizon",
    "How long the printed IAE had been integrated",
    printed=False,
    rows=tuple(ROWS),
    columns=("IAE", "printed", "horizon", "ts"),
    caption="The IAE of the Ziegler–Nichols loops, the print, the time at which the running integral has "
    "reached the print, and the printed settling time. All three prints are too small, and the one of $G_2$, "
    "whose loop is very lightly damped, the most.",
    labels={
        **{row: table_5.labels[row] for row in ROWS},
        "printed": "Printed",
        "horizon": "Reached at",
        "ts": "Printed $t_s$",
    },
)


@evidence.reading("as-written", "Exact load responses")
def horizons() -> pd.DataFrame:
    """Look for the time at which the running IAE passes the print."""
    rows = {}
    for row, plant in ROWS.items():
        loop = Loop(PLANTS[plant], ziegler_nichols(plant))
        target, settling = (paper.printed_numbers("I-table-5")[row, column] for column in ("IAE", "ts"))

        def missing(until: float, loop: Loop = loop, target: float = target) -> float:
            return loop.load_step(until=until).iae() - target

        horizon = float(brentq(missing, 0.2 * settling, 0.9 * loop.horizon(), xtol=1e-9))
        rows[row] = [loop.load_step().iae(), target, horizon, settling]
    return evidence.frame(rows)
