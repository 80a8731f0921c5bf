"""Figure 3: curves of constant phase margin for τ = 0.5."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.drawing import draw_locus, inside, label_locus, plane
from replicate.papers.krajewski.loci import constant_phase_margin

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TAU = 0.5
MARGINS = range(0, 180, 15)  # degrees; the paper does not print its set


@paper.figure(
    "fig-3",
    "Curves of constant phase margin, τ = 0.5",
    caption="From $0$ (the stability boundary, thick) to 165 degrees in steps of 15; the paper does not "
    "print its set. Each curve runs from $(0, -\\cos m_\\varphi)$ to $(0, b_u)$: the two ends lie on both "
    "sides of $(0, 1)$ (dot), through which no curve passes.",
    alt="Nested curves of constant phase margin in the a-b plane. They shrink towards the point a = 0, b "
    "= 1 as the phase margin grows.",
    size=(6.4, 5.2),
)
def draw(fig: Figure) -> None:
    """Draw Figure 3."""
    axes = fig.add_subplot()
    a, b = (0.0, 4.4), (-1.15, 4.0)
    plane(axes, a, b)
    for margin in MARGINS:
        locus = constant_phase_margin(TAU, margin)
        width = 2.4 if margin == 0 else 1.3
        draw_locus(axes, locus, f"phase margin {margin}", edgecolor="C0", linewidth=width)
        u = inside(locus, a, b, 0.5)
        if u is not None and margin <= 135:
            label_locus(axes, locus, u, f"{margin}°", "C0")
    axes.plot([0.0], [1.0], "o", color=axes.xaxis.label.get_color(), label="(0, 1)", clip_on=False, zorder=4)
