"""What the printed digits leave open: G3, whose derivative time has two digits, and a sensitivity with two peaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PID, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.designs import printed
from replicate.papers.panagopoulos.part_2.processes import PLANTS, split
from replicate.papers.panagopoulos.part_2.setpoint import Resonance, weight
from replicate.papers.panagopoulos.part_2.tables import REPLACEMENT, SUPERSEDED

if TYPE_CHECKING:
    import pandas as pd

HALF_UNIT = 0.005  # of a derivative time with two decimals
CASES = {
    "superseded, Ms=1.4": (SUPERSEDED, "G3 Ms=1.4"),
    "errata, Ms=1.4": (REPLACEMENT, "G3 Ms=1.4"),
    "errata, Ms=2.0": (REPLACEMENT, "G3 Ms=2.0"),
}

ranges = paper.table(
    "IIs-rounding",
    "$G_3$: what two digits of $T_d$ leave open",
    printed=False,
    rows=tuple(CASES),
    columns=("Ms_low", "Ms_high", "w0_low", "w0_high", "Mp_low", "Mp_high", "b_low", "b_high"),
    caption="Smallest and largest value of each quantity over the derivative times that round to the printed "
    "one, with the "
    "printed $k$ and $T_i$.",
    labels={
        "superseded, Ms=1.4": "Table 1, $M_s = 1.4$",
        "errata, Ms=1.4": "errata, $M_s = 1.4$",
        "errata, Ms=2.0": "errata, $M_s = 2.0$",
        "Ms_low": "$M_s$ from",
        "w0_low": r"$\omega_0$ from",
        "Mp_low": "$M_p$ from",
        "b_low": "$b$ from",
    }
    | dict.fromkeys(("Ms_high", "w0_high", "Mp_high", "b_high"), "to"),
)


@ranges.reading("as-written", "From the printed gains")
def over_the_rounding() -> pd.DataFrame:
    """Return the range of each quantity over the rounding of Td."""
    import pandas as pd

    rows = {}
    for key, (table, row) in CASES.items():
        plant, center = PLANTS["G3"], printed(table, row)
        found = []
        for td in np.linspace(center.derivative_time - HALF_UNIT, center.derivative_time + HALF_UNIT, 21):
            controller = PID.ideal(center.k, center.integral_time, float(td))
            peak = Loop(plant, controller).sensitivity_peak()
            resonance = Resonance.of(plant, controller)
            found.append((float(peak), peak.frequency, resonance.value, weight(controller, resonance)))
        low, high = np.min(found, axis=0), np.max(found, axis=0)
        rows[key] = [float(v) for pair in zip(low, high, strict=True) for v in pair]
    return pd.DataFrame.from_dict(rows, orient="index", columns=list(ranges.columns))


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
    import pandas as pd

    loop = Loop(PLANTS[split(TWO_PEAKS)[0]], printed(SUPERSEDED, TWO_PEAKS))
    w = np.geomspace(0.1, 5.0, 40001)
    size = np.abs(1.0 / (1.0 + loop(1j * w)))
    at = np.nonzero((size[1:-1] > size[:-2]) & (size[1:-1] > size[2:]))[0] + 1
    at = np.sort(at[np.argsort(-size[at])][:2])
    return pd.DataFrame({"w": w[at], "S": size[at]}, index=["first", "second"])
