"""The formula as a curve, with the quoted measurements over it."""

import numpy as np
from matplotlib.figure import Figure

from balmer1885 import paper
from balmer1885.lines import ORDERS, H, coefficient


@paper.figure(
    "lines",
    "The formula and the measurements",
    alt="A falling curve of wavelength over the order of the line; the four measured points lie on it.",
    size=(5.0, 3.0),
    points=True,
)
def spectrum(fig: Figure) -> None:
    """Draw wavelength over order, and the limit of the series."""
    axes = fig.subplots()
    orders = np.union1d(np.linspace(2.8, 9.0, 200), list(ORDERS.values()))  # with the orders themselves
    axes.plot(orders, H * coefficient(orders), label="formula")
    axes.axhline(H, color="0.5", linestyle="--", linewidth=0.8, label="limit")
    axes.set_xlabel("order $m$")
    axes.set_ylabel("wavelength in $10^{-7}$ mm")
    axes.legend()
