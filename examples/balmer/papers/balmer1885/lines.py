"""The table of the first four lines: formula, measurement, and their difference."""

import statistics

import pandas as pd

from balmer1885 import paper

H = 3645.6  # the fundamental number of hydrogen, in 1e-7 mm
ORDERS = {"H-alpha": 3, "H-beta": 4, "H-gamma": 5, "H-delta": 6}

lines = paper.table(
    "hydrogen-lines",
    "Wavelengths of the first four lines, in $10^{-7}$ mm",
    rows=tuple(ORDERS),
    columns=("formula", "measured", "difference"),
    labels={
        "H-alpha": r"$H_\alpha$",
        "H-beta": r"$H_\beta$",
        "H-gamma": r"$H_\gamma$",
        "H-delta": r"$H_\delta$",
        "formula": "by the formula",
        "measured": "Ångström",
    },
)


def coefficient(order: float) -> float:
    """Return the factor of the fundamental number, m²/(m² - 4)."""
    return order**2 / (order**2 - 4)


def measured() -> dict[str, float]:
    """Return Ångström's wavelengths as the note quotes them."""
    printed = paper.printed_numbers("hydrogen-lines")
    return {line: printed[line, "measured"] for line in ORDERS}


def fitted() -> float:
    """Return the mean of the four quotients of measurement and coefficient."""
    return statistics.fmean(found / coefficient(ORDERS[line]) for line, found in measured().items())


@lines.reading("as-written", "the fundamental number 3645.6")
def as_written() -> pd.DataFrame:
    """Multiply the fundamental number, and subtract the product from the measurement."""
    return _rows(H)


@lines.reading(
    "unrounded",
    "the mean of the four quotients, not rounded",
    note="What the formula gives if the fundamental number is not rounded to five digits.",
)
def unrounded() -> pd.DataFrame:
    """Do the same with the mean of the quotients."""
    return _rows(fitted())


def _rows(fundamental: float) -> pd.DataFrame:
    rows = {}
    for line, order in ORDERS.items():
        wavelength = fundamental * coefficient(order)
        rows[line] = {"formula": wavelength, "difference": measured()[line] - wavelength}
    return lines.frame(rows)
