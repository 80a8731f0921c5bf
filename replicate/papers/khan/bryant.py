"""Bryant's three gains of the cancelled loop against the damping ratios they are said to have."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from replicate.papers.khan import paper

if TYPE_CHECKING:
    import pandas as pd

DAMPING = {"zeta1.0": 1.0, "zeta0.6": 0.6, "zeta0.0": 0.0}

bryant = paper.table(
    "bryant",
    "Bryant's constants",
    kind="formula",
    rows=tuple(DAMPING),
    columns=("Kh",),
    caption="The gain $Kh = L_{PB}L_{IB}h$ of the cancelled loop (6) at which its dominant poles have the damping "
    "ratio $\\zeta$ that the text names.",
    labels={key: f"$\\zeta = {value}$" for key, value in DAMPING.items()} | {"Kh": "$Kh$"},
)


def gain_for_damping(zeta: float) -> float:
    r"""Return the gain Kh at which the dominant poles of s + K e^{-sh} have a damping ratio, 0 <= zeta <= 1.

    With $s h = \varphi(-\cot\varphi + i)$, $\varphi = \arccos\zeta$, the phase of $s h\,e^{sh} = -Kh$ is met, and its
    modulus is $Kh = \varphi\,e^{-\varphi\cot\varphi}/\sin\varphi$.

    Examples
    --------
    >>> gain_for_damping(0.0) == math.pi / 2, gain_for_damping(1.0) == math.exp(-1.0)
    (True, True)
    """
    if zeta == 1.0:
        return math.exp(-1.0)
    angle = math.acos(zeta)
    return angle / math.sin(angle) * math.exp(-angle * zeta / math.sin(angle))


def gain_for_damping_pade(zeta: float) -> float:
    """Return the same for the first-order Pade model, s^2 h/2 + (1 - Kh/2) s + K: (1 - k/2)^2 = 2 k zeta^2."""
    half = 2.0 + 4.0 * zeta**2
    return half - math.sqrt(half**2 - 4.0)


@bryant.reading("as-written", "Dominant poles, exact dead time")
def as_written() -> pd.DataFrame:
    """Compute the gains with the exact dead time."""
    return bryant.frame({row: gain_for_damping(zeta) for row, zeta in DAMPING.items()})


@bryant.reading(
    "pade-1", "First-order Padé model of the dead time", "Tried because it was the usual model of the time."
)
def pade() -> pd.DataFrame:
    """Compute the gains with a first-order Pade model."""
    return bryant.frame({row: gain_for_damping_pade(zeta) for row, zeta in DAMPING.items()})
