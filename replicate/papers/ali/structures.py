r"""The structures in which a PID setting can be meant, and the plant (1).

The paper prints the series form (2) and calls every controller "PID". Three other forms are in common use and fit a
setting (Kp, Ti, Td); all of them are special cases of the parallel form with a filtered derivative:

======== =============================================================== ======================================
series   :math:`K_p (1 + 1/sT_i)\,(1 + sT_d)/(1 + s\alpha T_d)`, eq. (2)   filter on the whole lead factor
d-filter :math:`K_p (1 + 1/sT_i)\,(1 + sT_d/(1 + s\alpha T_d))`            filter on the derivative term alone
ideal    :math:`K_p (1 + 1/sT_i + sT_d/(1 + s\alpha T_d))`                 parallel (ISA) form
======== =============================================================== ======================================
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from replicate.loops import PID, Plant
from replicate.papers.ali import paper

ALPHA = 0.1  # "in this work, alpha is assumed as 0.1"


@dataclass(frozen=True)
class Settings:
    """Gain, integral and derivative time of one controller; times in the plant's unit."""

    Kp: float
    Ti: float
    Td: float


def series(settings: Settings) -> PID:
    """Return the series form (2)."""
    return PID.series(settings.Kp, settings.Ti, settings.Td, alpha=ALPHA)


def d_filter(settings: Settings) -> PID:
    r"""Return the series form with the filter on the derivative term alone.

    :math:`1 + sT_d/(1 + s\alpha T_d) = (1 + s(1+\alpha)T_d)/(1 + s\alpha T_d)`, so it is the form (2) with
    the derivative time :math:`(1+\alpha)T_d` and the filter constant :math:`\alpha/(1+\alpha)`.
    """
    return PID.series(settings.Kp, settings.Ti, (1.0 + ALPHA) * settings.Td, alpha=ALPHA / (1.0 + ALPHA))


def ideal(settings: Settings) -> PID:
    """Return the parallel form with filtered derivative, all of it acting on the error."""
    return _parallel(settings, c=1.0)


def ideal_on_output(settings: Settings) -> PID:
    """Return the parallel form with the derivative acting on the output only: the same loop, no derivative kick."""
    return _parallel(settings, c=0.0)


def unfiltered(settings: Settings) -> PID:
    """Return the series form without derivative filter, as the derivation assumes it from (3) on."""
    return PID.series(settings.Kp, settings.Ti, settings.Td)


def _parallel(settings: Settings, c: float) -> PID:
    return PID.ideal(settings.Kp, settings.Ti, settings.Td, b=1.0, c=c, derivative_filter=ALPHA * settings.Td)


Structure = Callable[[Settings], PID]

STRUCTURES: dict[str, Structure] = {
    "series": series,
    "d-filter": d_filter,
    "ideal": ideal,
    "ideal-on-output": ideal_on_output,
}

NAMES = {
    "series": "form (2)",
    "d-filter": "filter on D only",
    "ideal": "parallel form",
    "ideal-on-output": "parallel form, D on the output",
}


def trial(theta: float, controller: PID) -> tuple[str, str]:
    """Return the plant and a controller for readers to try out, its derivative acting on the output: the same loop."""
    return plant(theta).notation(), replace(controller, c=0.0).notation()


def plant(theta: float) -> Plant:
    """Return (1) with K = T = 1, as in both examples."""
    return Plant([1.0], [1.0, -1.0], dead_time=theta)


def printed_settings(exhibit: str, name: str) -> Settings:
    """Return the settings (Kp, Ti, Td) that the paper prints for one controller, in a row or a column of an exhibit."""
    texts = paper.printed_cells(exhibit)
    return Settings(*(float(texts.get((name, key)) or texts[key, name]) for key in ("Kp", "Ti", "Td")))
