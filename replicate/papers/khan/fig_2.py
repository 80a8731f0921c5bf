"""Figure 2: the loop under proportional control."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.khan import paper
from replicate.papers.khan.loop_diagram import loop_diagram

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-2",
    "Process with dead time under proportional control",
    kind="diagram",
    alt="Block diagram: reference, summing junction, gain K, process exp(-hs)/(s+p), unit feedback.",
    size=(6.0, 1.9),
)
def proportional(fig: Figure) -> None:
    """Draw the proportional loop."""
    loop_diagram(fig, ["$K$", "$\\dfrac{e^{-hs}}{s + p}$"], load=False)
