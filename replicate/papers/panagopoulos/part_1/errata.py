"""The errata's equation (7): the circle that contains the Ms circle and the Mp circle."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper

if TYPE_CHECKING:
    import pandas as pd

Circle = tuple[Fraction, Fraction]

PAIRS = {
    f"Ms={ms} Mp={mp}": (Fraction(str(ms)), Fraction(str(mp)))
    for ms, mp in ((1.4, 1.4), (1.6, 1.2), (2.0, 1.2), (2.0, 1.5), (2.0, 2.0), (1.5, 3.0))
}

errata = paper.table(
    "I-errata",
    "Equation (7) and its correction",
    kind="formula",
    printed=False,
    rows=tuple(PAIRS),
    columns=("C", "R", "left", "right", "spare_Ms", "spare_Mp"),
    caption="Center $-C$ and radius $R$ of the circle for both bounds, its two points on the real axis, and "
    "how much of it is left around the $M_s$ and the $M_p$ circle, which must not be negative. The smallest "
    "circle on the real axis that contains both runs from $-M_p/(M_p-1)$, the far end of the $M_p$ circle, to "
    "$-(M_s-1)/M_s$, the near end of the $M_s$ circle. The last pair violates $M_s - 1 < M_p < M_s + 1$.",
    labels={
        **{row: f"${row.replace('Ms=', 'M_s = ').replace(' Mp=', '$, $M_p = ')}$" for row in PAIRS},
        "C": "$C$",
        "R": "$R$",
        "left": "$-C-R$",
        "right": "$-C+R$",
        "spare_Ms": "around $M_s$",
        "spare_Mp": "around $M_p$",
    },
)


def printed_circle(ms: Fraction, mp: Fraction) -> Circle:
    """Return (C, R) of (7) as the article prints it."""
    center = (ms - ms * mp - 2 * ms * mp**2 + mp**2 - 1) / (2 * ms * (mp**2 - 1))
    return center, (ms + mp - 1) / (2 * ms * (mp - 1))


def corrected_circle(ms: Fraction, mp: Fraction) -> Circle:
    """Return (C, R) of (7) as the errata print it."""
    center = (ms * (2 * mp - 1) - (mp - 1)) / (2 * ms * (mp - 1))
    return center, (ms + mp - 1) / (2 * ms * (mp - 1))


def geometric_circle(ms: Fraction, mp: Fraction) -> Circle:
    """Return (C, R) of the smallest circle on the real axis around both circles."""
    (ms_center, ms_radius), (mp_center, mp_radius) = sensitivity_circle(ms), complementary_circle(mp)
    left = max(ms_center + ms_radius, mp_center + mp_radius)
    right = min(ms_center - ms_radius, mp_center - mp_radius)
    return (left + right) / 2, (left - right) / 2


def sensitivity_circle(ms: Fraction) -> Circle:
    """Return (C, R) of the circle on which |S| = Ms."""
    return Fraction(1), 1 / ms


def complementary_circle(mp: Fraction) -> Circle:
    """Return (C, R) of the circle on which |T| = Mp."""
    return mp**2 / (mp**2 - 1), mp / (mp**2 - 1)


def spare(outer: Circle, inner: Circle) -> Fraction:
    """Return how much of the outer circle's radius the inner circle leaves; negative if it sticks out."""
    return outer[1] - inner[1] - abs(outer[0] - inner[0])


def _table(circle: Callable[[Fraction, Fraction], Circle]) -> pd.DataFrame:
    rows = {}
    for row, (ms, mp) in PAIRS.items():
        center, radius = circle(ms, mp)
        values = (
            center,
            radius,
            -center - radius,
            -center + radius,
            spare((center, radius), sensitivity_circle(ms)),
            spare((center, radius), complementary_circle(mp)),
        )
        rows[row] = [float(value) for value in values]
    return errata.frame(rows)


@errata.reading(
    "as-written",
    "Equation (7) of the article",
    note="The article's $C$ is the coordinate of the center, where the text wants its distance: with the "
    "center at $-C$ the circle lies on the wrong side of the origin.",
)
def as_printed() -> pd.DataFrame:
    """Evaluate the article's formula."""
    return _table(printed_circle)


@errata.reading("errata", "Equation (7) of the errata")
def corrected() -> pd.DataFrame:
    """Evaluate the corrected formula."""
    return _table(corrected_circle)


@errata.reading("geometry", "The smallest circle around both", note="From the end points of the circles, no formula.")
def geometry() -> pd.DataFrame:
    """Enclose the two circles."""
    return _table(geometric_circle)
