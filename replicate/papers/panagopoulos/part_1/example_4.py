"""Example 4: a fast and a slow mode, and the plant without the slow one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import design
from replicate.papers.panagopoulos.part_1.plants import FAST, MIDDLE, PLANTS, SLOW, SLOW_TERM

if TYPE_CHECKING:
    import pandas as pd

_SYMBOLS = (("k", "k"), ("ki", "k_i"))
RATIOS = tuple(f"{key}_{ms}" for ms in (1.4, 2.0) for key, _ in _SYMBOLS)

example_4 = paper.table(
    "I-example-4",
    "A fast and a slow mode, $G_{10}$ and $G_{11}$",
    kind="example",
    rows=("T_fast", "T_middle", "T_slow", "gain_slow", "gain_total", "gain_G11", *RATIOS),
    columns=("value",),
    caption="Time constants of $G_{10}$, the steady-state gain of its slow term in (27), its whole steady-state gain "
    "and that of $G_{11}$; then the gains for $G_{11}$ relative to those for $G_{10}$. Dropping the slow mode "
    "of (27) would leave 100 in the numerator of (28), not 150: $G_{11}$ keeps the high-frequency gain "
    "instead.",
    labels={
        "T_fast": "fast modes",
        "T_middle": "middle mode",
        "T_slow": "slow mode",
        "gain_slow": "gain of the slow mode",
        "gain_total": "gain of $G_{10}$",
        "gain_G11": "gain of $G_{11}$",
        **{f"{key}_{ms}": f"${s}(G_{{11}})/{s}(G_{{10}})$, $M_s = {ms}$" for ms in (1.4, 2.0) for key, s in _SYMBOLS},
        "value": "Value",
    },
)


@example_4.reading("as-written", "As written")
def as_written() -> pd.DataFrame:
    """Take the modes from (27) and compare the designs."""
    ratios: dict[str, float] = {}
    for ms in (1.4, 2.0):
        with_mode, without = design("G10", ms), design("G11", ms)
        ratios |= {f"k_{ms}": without.k / with_mode.k, f"ki_{ms}": without.ki / with_mode.ki}
    times = {"T_fast": 1.0 / FAST, "T_middle": 1.0 / MIDDLE, "T_slow": 1.0 / SLOW}
    gains = {"gain_slow": SLOW_TERM.gain, "gain_total": PLANTS["G10"].gain, "gain_G11": PLANTS["G11"].gain}
    return example_4.frame({**times, **gains, **ratios})
