"""Responses as pandas data frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from replicate.loops import checks
from replicate.loops.time_domain.piecewise import Piecewise

if TYPE_CHECKING:
    import pandas as pd

POINTS = 501


def signal_frame(signal: Piecewise, times: ArrayLike | None = None) -> pd.DataFrame:
    """Return a signal at given times as a data frame with the index ``t`` and the column ``value``.

    Parameters
    ----------
    times
        Times of any order; by default 501 equally spaced ones from 0 to the horizon.

    Raises
    ------
    LoopError
        If a time lies beyond the horizon.
    """
    import pandas as pd

    if times is None:
        times = np.linspace(0.0, signal.horizon, POINTS)
    t = np.atleast_1d(checks.times("the times of a data frame", times))
    return pd.DataFrame({"value": signal(t)}, index=pd.Index(t, name="t"))
