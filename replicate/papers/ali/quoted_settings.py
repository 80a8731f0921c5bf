"""The competing settings of both examples, which the paper quotes from other papers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.ali import paper
from replicate.papers.ali.examples import LABELS

if TYPE_CHECKING:
    import pandas as pd

quoted_settings = paper.table(
    "quoted-settings",
    "Competing settings, quoted from other papers",
    rows=("padma-sree", "visioli-setpoint", "visioli-load"),
    columns=("Kp", "Ti", "Td"),
    caption="Inputs of the two examples. The rules that gave them are not in this paper, nor is the controller "
    "structure that they were made for.",
    labels=LABELS,
)


@quoted_settings.reading("as-written", "No rule is given")
def nothing() -> pd.DataFrame:
    """Compute nothing: the paper has no rule for these settings."""
    import pandas as pd

    shape = (len(quoted_settings.rows), len(quoted_settings.columns))
    return pd.DataFrame(np.full(shape, np.nan), index=list(quoted_settings.rows), columns=list(quoted_settings.columns))
