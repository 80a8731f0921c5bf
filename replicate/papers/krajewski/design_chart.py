"""One panel of Figure 6 for any dead time: the loci of phase margin and crossover frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.krajewski.drawing import draw_locus, inside, label_locus, plane
from replicate.papers.krajewski.loci import (
    constant_crossover,
    constant_phase_margin,
    largest_a,
    stability_boundary,
    upper_end,
)
from replicate.papers.krajewski.normalised_loop import end_frequency

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MARGINS = {60: "-", 75: "--"}  # solid and dashed, as in the paper


def round_steps(largest: float, count: int) -> tuple[float, ...]:
    """Return about ``count`` round numbers from a step up to ``largest``: steps of 1, 2, 2.5 or 5 times a power of ten.

    Examples
    --------
    >>> round_steps(2.1, 8)
    (0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)
    """
    power = 10.0 ** np.floor(np.log10(largest / count))
    step = min((f * power for f in (1.0, 2.0, 2.5, 5.0, 10.0)), key=lambda s: abs(largest / s - count))
    return tuple(float(f"{k * step:.12g}") for k in range(1, int(largest / step + 1e-9) + 1))


def design_chart(axes: Axes, tau: float, crossovers: int = 8) -> None:
    """Draw the loci of phase margin 60 and 75 degrees and of crossover frequency for one τ."""
    a = (0.0, 1.28 * largest_a(tau, 60.0))
    top = upper_end(tau, 60.0)
    b = (-0.5 - 0.06 * top, 1.12 * top)
    plane(axes, a, b, f"τ = {tau:g}")
    draw_locus(axes, stability_boundary(tau), "stability boundary", edgecolor="0.5", linewidth=1.0)
    for w in round_steps(1.1 * end_frequency(tau, 60.0), crossovers):
        arc = constant_crossover(tau, w)
        if arc is None:
            continue
        draw_locus(axes, arc, f"crossover {w:g}", edgecolor="C2", linewidth=1.0, linestyle=(0, (1, 1.6)))
        # The label stands outside the curve of 60 degrees, where it covers no other curve.
        outer = constant_crossover(tau, w, 0.0, 60.0) or arc
        u = inside(outer, a, b, 0.42)
        if u is not None:
            label_locus(axes, outer, u, f"{w:g}", "C2", fontsize=8.5)
    for margin, line in MARGINS.items():
        locus = constant_phase_margin(tau, margin)
        draw_locus(axes, locus, f"phase margin {margin}", edgecolor="C0", linestyle=line, linewidth=1.7)
        label_locus(axes, locus, 0.36, f"{margin}°", "C0", fontsize=9)
