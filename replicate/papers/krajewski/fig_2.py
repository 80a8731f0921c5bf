"""Figure 2: the stability regions for ten dead times."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.drawing import draw_locus, inside, label_locus, plane
from replicate.papers.krajewski.loci import stability_boundary

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIRST, SECOND = (0.1, 0.2, 0.3, 0.4, 0.5), (0.6, 0.7, 0.8, 0.9, 1.0)
PANELS = {
    "(a) τ = 0.1 to 0.5": (FIRST, (0.0, 70.0), (-2.0, 17.5), 0.62),
    "(a), enlarged": (FIRST, (0.0, 10.5), (-1.4, 9.4), 0.62),
    "(b) τ = 0.6 to 1.0": (SECOND, (0.0, 3.6), (-1.2, 3.5), 0.7),
}


@paper.figure(
    "fig-2",
    "Stability regions in the parameter plane",
    caption="The loop is stable between the $b$ axis and the curve of its $\\tau$, which starts at $(0, "
    "-1)$ for every $\\tau$. The curves are $m_\\varphi = 0$ in (11). The middle panel enlarges the left "
    "one.",
    alt="Three panels of nested curves from the point a = 0, b = -1 bulging to the right and back to the "
    "b axis; the smaller the dead time, the larger the region.",
    size=(7.4, 3.5),
)
def draw(fig: Figure) -> None:
    """Draw Figure 2."""
    for axes, (title, (taus, a, b, place)) in zip(fig.subplots(1, 3), PANELS.items(), strict=True):
        plane(axes, a, b, title)
        for index, tau in enumerate(taus):
            color = f"C{index}"
            boundary = stability_boundary(tau)
            draw_locus(axes, boundary, f"tau = {tau:g}", edgecolor=color)
            u = inside(boundary, a, b, place)
            crowded = tau > 0.3 and a[1] > 50.0  # in the full view of panel (a)
            if u is not None and not crowded:
                label_locus(axes, boundary, u, f"{tau:.1f}", color)
