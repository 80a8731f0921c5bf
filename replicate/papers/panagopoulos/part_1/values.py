"""Worked examples: one column of named quantities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

VALUE = "value"


def column(values: Mapping[str, float]) -> pd.DataFrame:
    """Return named quantities as a table of one column."""
    import pandas as pd

    return pd.DataFrame({VALUE: [float(value) for value in values.values()]}, index=list(values))
