"""Settings of Tables 1 and 2, and the ways in which their Ms can have been computed."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

from replicate.exhibits import AS_WRITTEN, Table, rank
from replicate.loops import PID, Loop
from replicate.papers.ali import paper
from replicate.papers.ali.structures import Settings, Structure, d_filter, plant, series, trial
from replicate.papers.ali.toolchain import pade_sensitivity_norm, pade_sensitivity_peak
from replicate.papers.ali.tuning import gain_product, integral_time, specified_sensitivity

if TYPE_CHECKING:
    import pandas as pd

EXPONENTS = {"table-1": Fraction(1, 2), "table-2": Fraction(2, 5)}
PADE_ORDER = 3
TRIED = 15  # combinations of structure, dead time and way to find the peak, all in `sensitivity_count`

Peak = Callable[[float, PID], float]  # of theta and controller


def exact_peak(theta: float, controller: PID) -> float:
    """Return Ms with the exact dead time."""
    return Loop(plant(theta), controller).sensitivity_peak().value


def pade_peak(theta: float, controller: PID) -> float:
    """Return Ms of the third-order Padé model."""
    return pade_sensitivity_peak(theta, controller, PADE_ORDER)


def pade_norm(theta: float, controller: PID) -> float:
    """Return Ms of the third-order Padé model as the norm routine reports it."""
    return pade_sensitivity_norm(theta, controller, PADE_ORDER)


def designed(table: str, row: str) -> Settings:
    """Return the settings of a row by the paper's rules, unrounded."""
    x = Fraction(row)
    return Settings(gain_product(x, EXPONENTS[table]), integral_time(x), float(x / 2))


def tabulated(table: str, row: str) -> Settings:
    """Return the settings with which the printed Ms can have been computed.

    Ti as printed; the gain unrounded in Table 1 (the printed 1.82 or 1.49 would change Ms in the second digit), and as
    printed in Table 2.
    """
    texts = paper.printed_cells(table)
    gain = gain_product(Fraction(row)) if table == "table-1" else float(texts[row, "KKp"])
    return Settings(gain, float(texts[row, "Ti"]), float(Fraction(row) / 2))


def sensitivity(
    table: str, row: str, structure: Structure, peak: Peak, settings: Callable[[str, str], Settings]
) -> float:
    """Return Ms of one row in one structure, computed in one way."""
    return peak(float(Fraction(row)), structure(settings(table, row)))


def compute(table: Table, structure: Structure, peak: Peak, settings: Callable[[str, str], Settings]) -> pd.DataFrame:
    """Return a whole table: the settings by the rules, and Ms."""
    rows = {}
    for row in table.rows:
        design = designed(table.id, row)
        values = {
            "KKp": design.Kp,
            "Ti": design.Ti,
            "Ms": sensitivity(table.id, row, structure, peak, settings),
            "Ms_star": float(specified_sensitivity(Fraction(row))),
        }
        rows[row] = [values[column] for column in table.columns]
    return table.frame(rows)


def add_readings(table: Table) -> None:
    """Register the readings that Tables 1 and 2 share."""
    gain = "the unrounded gain" if table.id == "table-1" else "the printed gain"
    readings: tuple[tuple[str, str, Structure, Peak, Callable[[str, str], Settings], str], ...] = (
        (
            AS_WRITTEN,
            "Controller (2), exact dead time",
            series,
            exact_peak,
            designed,
            (
                "The specified sensitivity $M_s^* = 1/y$ runs over 1.2, 1.3, ... (the text says that $y$ does, "
                "but by (7) and (8) $y = 1/|S|$, and with $y \\ge 1.2$ there is no real $q$), up to the first "
                "value for which (9) has real roots; $q > 0$, and $T_i$ is the larger root. $M_s$ is that of the "
                "controller printed in (2), $\\alpha = 0.1$, with unrounded settings and the exact dead time."
            ),
        ),
        (
            "authors",
            "The authors' computation: filter on D only, Padé model of order 3, norm routine at 1 %",
            d_filter,
            pade_norm,
            tabulated,
            (
                "Reconstructed from the printed digits. The derivative filter acts on the derivative term alone, "
                "$K_p(1+1/sT_i)(1 + sT_d/(1+s\\alpha T_d))$; the dead time is a third-order Padé approximation; and "
                "$M_s$ is the lower bound at which Bruinsma and Steinbuch's algorithm stops at a relative tolerance of "
                "0.01, the documented default of MATLAB's `norm(sys, inf)`, started from the peaking frequencies of "
                f"the closed loop's modes. Settings: {gain} and the printed $T_i$."
            ),
        ),
        (
            "pade-3",
            "The same, with the true peak of the Padé model",
            d_filter,
            pade_peak,
            tabulated,
            (
                "As *authors*, but the peak of $|S|$ is exact. The difference between the two is the tolerance "
                "of the norm routine alone."
            ),
        ),
        (
            "filter-on-d",
            "Filter on D only, exact dead time",
            d_filter,
            exact_peak,
            designed,
            (
                "As written, except that the derivative filter acts on the derivative term alone. The difference "
                "to the first reading is the place of the filter alone."
            ),
        ),
    )
    for id, title, structure, peak, settings, note in readings:

        def computed(
            structure: Structure = structure,
            peak: Peak = peak,
            settings: Callable[[str, str], Settings] = settings,
        ) -> pd.DataFrame:
            return compute(table, structure, peak, settings)

        tried = {} if id == AS_WRITTEN else {"structure, dead time and way to find the peak": TRIED}
        table.reading(id, title, note, tried=tried)(computed)
    rank(table, "Ms", table.rows, "$M_s$ grows with $\\theta/T$")
    table.trials = lambda: {row: trial(float(Fraction(row)), series(tabulated(table.id, row))) for row in table.rows}


LABELS = {"KKp": "$KK_p$", "Ti": "$T_i/T$", "Ms": "$M_s$", "Ms_star": "$M_s^*$"}
