"""Figure 5: which crossover frequencies are compatible with which phase margins, τ = 0.5."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.drawing import draw_locus, inside, label_locus, mark_point, plane
from replicate.papers.krajewski.loci import constant_crossover, constant_phase_margin
from replicate.papers.krajewski.normalised_loop import point

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TAU = 0.5
MARGINS = {45: "-", 60: "--", 75: "-."}


@paper.figure(
    "fig-5",
    "Compatibility of the specifications, τ = 0.5",
    caption="Curves of phase margin 45, 60 and 75 degrees and the arcs $\\omega_A = 2$ and $\\omega_A = "
    "1.5$. The arc $\\omega_A = 2$ enters the region $m_\\varphi \\ge 45$ degrees at $P_1$ and ends on "
    "the $b$ axis at $P_2$ (thick), where the phase margin is its largest; it stays outside the curves of "
    "60 and 75 degrees.",
    alt="Three nested curves of phase margin and two elliptic arcs. The arc for crossover 2 crosses the "
    "outermost curve at P1 and meets the b axis at P2, just above the end of the curve for 60 degrees.",
    size=(6.4, 5.2),
)
def draw(fig: Figure) -> None:
    """Draw Figure 5."""
    axes = fig.add_subplot()
    a, b = (0.0, 2.05), (-0.85, 2.75)
    plane(axes, a, b)
    for margin, line in MARGINS.items():
        locus = constant_phase_margin(TAU, margin)
        draw_locus(axes, locus, f"phase margin {margin}", edgecolor="C0", linestyle=line)
        label_locus(axes, locus, 0.42, f"{margin}°", "C0")
    for w in (2.0, 1.5):
        arc = constant_crossover(TAU, w)
        if arc is not None:
            draw_locus(axes, arc, f"crossover {w:g}", edgecolor="C2", linewidth=1.4)
            u = inside(arc, a, b, 0.1)
            if u is not None:
                label_locus(axes, arc, u, f"$\\omega_A = {w:g}$", "C2")
    admissible = constant_crossover(TAU, 2.0, 45.0)
    if admissible is not None:
        draw_locus(axes, admissible, "arc P1 P2", edgecolor="C1", linewidth=3.0)
    a1, b1 = (float(x) for x in point(TAU, 2.0, 45.0))
    mark_point(axes, a1, b1, "$P_1$", (6, 4))
    mark_point(axes, 0.0, float(np.sqrt(5.0)), "$P_2$", (6, 5))  # (17) with ω = 2
