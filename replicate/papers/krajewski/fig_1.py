"""Figure 1: six typical Nyquist diagrams, and the pole counts that the Nyquist criterion gives for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.normalised_loop import frequency_response, loop
from replicate.papers.krajewski.nyquist import asymptote, encirclements, quadrant

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TAU = 0.5

# The paper prints no parameters: one loop for each of its six cases (i) to (iv), the last two twice.
CASES = {
    "a": (-1.0, 1.0),
    "b": (-1.0, -3.0),
    "c": (4.0, 0.5),
    "d": (1.0, 5.0),
    "e": (1.5, 1.0),
    "f": (0.5, 2.0),
}
VIEW = 6.0


@paper.figure(
    "fig-1",
    "Typical Nyquist diagrams",
    caption="$G(j\\omega)$ of (6) for $\\omega > 0$ with $\\tau = 0.5$ near the critical point $-1$ "
    "(dot); dashed: the asymptote (12) for $\\omega \\to 0$; the circle is the unit circle. The paper "
    "prints no parameters; these are clear examples of its cases, (a) and (b) with $a < 0$, (c) and (d) "
    "with $a > 0$ and too much gain, (e) and (f) stable.",
    alt="Six panels with Nyquist curves that come from infinity along a vertical dashed line and spiral "
    "into the origin. In panels a to d the curve passes the point minus one on the wrong side and the "
    "loop is unstable; in panels e and f it leaves the point minus one on its left and the loop is stable.",
    size=(7.4, 5.4),
)
def draw(fig: Figure) -> None:
    """Draw Figure 1."""
    w = np.geomspace(0.02, 25.0, 6001)
    circle = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 361))
    for axes, (name, (a, b)) in zip(fig.subplots(2, 3, sharex=True, sharey=True).flat, CASES.items(), strict=True):
        unstable = loop(a, b, TAU).unstable_poles()
        count = "stable" if unstable == 0 else f"{unstable} unstable pole{'s' if unstable > 1 else ''}"
        axes.set_title(f"({name}) $a = {a:g}$, $b = {b:g}$: {count}", fontsize=10)
        axes.plot(circle.real, circle.imag, color="0.5", linestyle="-", linewidth=0.8, label="unit circle")
        axes.axvline(float(asymptote(a, b, TAU)), color="C1", linestyle="--", linewidth=1.0, label="asymptote")
        response = frequency_response(a, b, TAU, w)
        axes.plot(response.real, response.imag, color="C0", label="Nyquist diagram")
        _arrow(axes, response)
        axes.plot([-1.0], [0.0], "o", color=axes.xaxis.label.get_color(), markersize=4, label="critical point")
        ticks = (-6, -3, 0, 3, 6)
        axes.set(xlim=(-VIEW, VIEW), ylim=(-VIEW, VIEW), aspect="equal", xticks=ticks, yticks=ticks)
        axes.axhline(0.0, color="0.5", linewidth=0.6, zorder=0)
        axes.axvline(0.0, color="0.5", linewidth=0.6, zorder=0)
    fig.supxlabel("real part", fontsize=10.5)
    fig.supylabel("imaginary part", fontsize=10.5)


def _arrow(axes: Axes, response: NDArray[np.complex128]) -> None:
    """Show the direction of rising frequency where the curve has been in view for a while."""
    visible = np.flatnonzero((abs(response.real) < 0.95 * VIEW) & (abs(response.imag) < 0.95 * VIEW))
    x, y = response.real[visible], response.imag[visible]
    length = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    at = int(np.searchsorted(length, 2.2))
    axes.annotate(
        "",
        (x[at + 1], y[at + 1]),
        xytext=(x[at - 40], y[at - 40]),
        arrowprops={"arrowstyle": "-|>", "color": "C0", "mutation_scale": 11, "shrinkA": 0, "shrinkB": 0},
    )


fig_1_values = paper.table(
    "fig-1-values",
    "The six loops of Figure 1",
    printed=False,
    rows=tuple(CASES),
    columns=("a", "b", "asymptote", "initial_quadrant", "encirclements", "unstable_poles"),
    caption="The parameters chosen for Figure 1. The quadrant is that of $G(j\\omega)$ for $\\omega \\to "
    "0_+$; encirclements are clockwise turns of the whole Nyquist curve around $-1$, found by following "
    "its angle; the unstable poles are counted on the closed loop itself. $G$ has no unstable pole, so "
    "the two must agree.",
    labels={
        "asymptote": "$b - (1 + \\tau)a$ (12)",
        "initial_quadrant": "quadrant",
        "encirclements": "encirclements of $-1$",
        "unstable_poles": "unstable poles",
    },
)


@fig_1_values.reading("as-written", "Nyquist criterion and closed-loop poles")
def values() -> pd.DataFrame:
    """Count encirclements and poles."""
    rows = {}
    for name, (a, b) in CASES.items():
        start = complex(frequency_response(a, b, TAU, 1e-6))
        unstable = loop(a, b, TAU).unstable_poles()
        rows[name] = [a, b, float(asymptote(a, b, TAU)), quadrant(start), encirclements(a, b, TAU), unstable]
    return fig_1_values.frame(rows)
