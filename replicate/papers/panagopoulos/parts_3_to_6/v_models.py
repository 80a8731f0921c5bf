"""V: what the paper gives and does not derive, the fitted models and the earlier settings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper

if TYPE_CHECKING:
    import pandas as pd

models = paper.table(
    "V-models",
    "What the paper gives: the fitted models and the earlier settings",
    rows=("K_p", "dead_time", "T_1", "T_2", "K_PI", "Ti_PI", "level", "temperature", "N", "scan", "band", "outer_T"),
    columns=("starch", "drying"),
    labels={
        "K_p": "gain",
        "dead_time": "dead time (s)",
        "T_1": "lag (s)",
        "T_2": "lead (s)",
        "K_PI": "$K$ of the earlier PI",
        "Ti_PI": "$T_i$ of the earlier PI (s)",
        "level": "operating point (% of range)",
        "temperature": "operating point (°C)",
        "N": "filter factor of the derivative",
        "scan": "time between two set points $r_2$ (s)",
        "band": "band of the settling time (%)",
        "outer_T": "time constant from $r_2$ to $y_1$ (s)",
        "starch": "starch boiler",
        "drying": "drying section",
    },
    caption="$1.34\\,e^{-12.9s}/(43.3s+1)^2$ and $0.008\\,(30s+1)/(s(5s+1))\\,e^{-2s}$. These numbers are taken as "
    "printed: they were fitted or measured at the mill, and the data are not in the paper.",
)


@models.reading("as-written", "Not computable", note="The step responses to which the models were fitted are lost.")
def given() -> pd.DataFrame:
    """Return an empty table: nothing of it can be computed."""
    return models.blank()
