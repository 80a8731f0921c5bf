"""How much of the fits' range the closed forms cover, exactly."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from replicate.papers.khan import closed_form, paper
from replicate.papers.khan.fits import overshoot_fits, rise_time_fit
from replicate.papers.khan.sweep import dense

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]

exact_forms = paper.table(
    "closed-forms",
    "Closed forms in place of the fits",
    printed=False,
    columns=("loops", "share", "worst_closed", "worst_fit", "r2_fit"),
    caption="The first peak for $Kh \\ge e^{-ph}$, and the rise time where 90 % of the final value is reached before "
    "the feedback arrives (everywhere for $ph \\ge \\ln 10$): loops of the dense grid, the share of all stable loops, "
    "the largest difference from the exact response, and the fits on the same loops, where they apply. Overshoot in "
    "percentage points, rise time in per cent.",
    labels={
        "loops": "loops", "share": "share (%)", "worst_closed": "closed form, worst", "worst_fit": "fit, worst",
        "r2_fit": "fit, $r^2$", "overshoot": "overshoot of the first peak", "rise-time": "rise time",
    },
)  # fmt: skip


@exact_forms.reading("as-written", "Closed form and fit against the exact response")
def coverage() -> pd.DataFrame:
    """Compare closed forms and fits on the dense grid."""
    loops = dense()
    ph, kh = loops.ph, loops.kh
    peak = closed_form.has_first_peak(ph, kh)
    rise = closed_form.has_rise_time(ph, kh)
    fit = np.where(ph >= 0.5, rise_time_fit(ph, kh), np.nan)  # (3) is given for ph >= 0.5
    with np.errstate(invalid="ignore"):
        rows = {
            "overshoot": _row(peak, closed_form.first_peak(ph, kh), overshoot_fits(ph, kh), loops.first_peak, 1.0),
            "rise-time": _row(rise, closed_form.rise_time(ph, kh), fit, loops.rise_time, loops.rise_time / 100.0),
        }
    return exact_forms.frame(rows)


def _row(mask: NDArray[np.bool_], closed: Array, fit: Array, exact: Array, scale: Array | float) -> list[float]:
    """Return size, share, worst errors of closed form and fit, and r^2 of the fit."""
    error = np.abs(closed - exact) / scale
    both = mask & np.isfinite(fit)
    misfit = np.abs(fit - exact) / scale
    spread = exact[both] - exact[both].mean()
    r2 = 1.0 - float(np.sum((fit - exact)[both] ** 2) / np.sum(spread**2))
    # what is left of the closed form's error is rounding: to one digit it is the same on every machine
    worst = float(f"{error[mask].max():.0e}")
    return [float(mask.sum()), 100.0 * float(mask.mean()), worst, float(misfit[both].max()), r2]
