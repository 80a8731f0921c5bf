"""Stability of every design with the exact dead time: rightmost pole, gain interval, delay margin."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from replicate.loops import Loop
from replicate.papers.ali import paper
from replicate.papers.ali.eq_11 import ROWS, printed_coefficients
from replicate.papers.ali.sensitivities import designed
from replicate.papers.ali.structures import Settings, Structure, d_filter, plant, series, unfiltered
from replicate.papers.ali.table_1 import table_1
from replicate.papers.ali.table_2 import table_2
from replicate.papers.ali.tuning import cubic, gain_product

if TYPE_CHECKING:
    import pandas as pd


def summarised(x: Fraction) -> Settings:
    """Return the settings by the paper's four final steps: gain by range, Td = theta/2, Ti from (11)."""
    exponent = Fraction(1, 2) if x <= Fraction(1, 2) else Fraction(2, 5)
    return Settings(gain_product(x, exponent), cubic(x, printed_coefficients()), float(x / 2))


def designs() -> dict[str, tuple[Fraction, Settings]]:
    """Return theta/T and settings of every design of the paper: both tables and the (11)-based rule."""
    tables = {
        f"{table.id}-{row}": (Fraction(row), designed(table.id, row))
        for table in (table_1, table_2)
        for row in table.rows
    }
    return tables | {f"eq-11-{row}": (Fraction(row), summarised(Fraction(row))) for row in ROWS}


DESIGNS = designs()

stability = paper.table(
    "stability",
    "Stability of every design",
    printed=False,
    rows=tuple(DESIGNS),
    columns=("pole_re", "pole_im", "KKp_min", "KKp", "KKp_max", "gain_up", "delay_margin"),
    caption="Exact dead time, $T = 1$, unrounded settings. Rightmost closed-loop pole $p$; the interval of $KK_p$ "
    "in which the loop is stable, all else fixed; by how many per cent the gain and the dead time may increase.",
    labels={
        **{id: f"Table {id[6]}, {id[8:]}" for id in DESIGNS if id.startswith("table")},
        **{id: f"(11), {id[6:]}" for id in DESIGNS if id.startswith("eq")},
        "pole_re": "Re $p$",
        "pole_im": "Im $p$",
        "KKp_min": "min $KK_p$",
        "KKp": "$KK_p$",
        "KKp_max": "max $KK_p$",
        "gain_up": "gain (%)",
        "delay_margin": "delay (%)",
    },
)


def robustness(x: Fraction, settings: Settings, structure: Structure) -> dict[str, float]:
    """Return the columns of the exhibit for one design.

    Raises
    ------
    UnstableLoopError
        If the loop is unstable.
    """
    loop = Loop(plant(float(x)), structure(settings))
    pole, margins = loop.rightmost_pole(), loop.margins()
    return {
        "pole_re": pole.real,
        "pole_im": pole.imag,
        "KKp_min": settings.Kp * margins.gain_reduction,
        "KKp": settings.Kp,
        "KKp_max": settings.Kp * margins.gain,
        "gain_up": 100.0 * (margins.gain - 1.0),
        "delay_margin": 100.0 * margins.delay / float(x),
    }


def _compute(structure: Structure) -> pd.DataFrame:
    rows = {id: robustness(x, settings, structure) for id, (x, settings) in DESIGNS.items()}
    return stability.frame(rows)


@stability.reading("as-written", "Controller (2), $\\alpha = 0.1$")
def with_filter() -> pd.DataFrame:
    """Compute all designs with the controller (2)."""
    return _compute(series)


@stability.reading(
    "no-filter",
    "No derivative filter",
    note="As the derivation assumes from (3) on. The loop is then of neutral type: $|L|$ tends to "
    "$KK_p\\theta/2T < 1$ at high frequency instead of to zero.",
)
def without_filter() -> pd.DataFrame:
    """Compute all designs without filter."""
    return _compute(unfiltered)


@stability.reading("filter-on-d", "Filter on D only", note="The structure with which the printed $M_s$ were computed.")
def filter_on_derivative() -> pd.DataFrame:
    """Compute all designs with the filter on the derivative term alone."""
    return _compute(d_filter)
