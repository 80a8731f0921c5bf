"""Figure 6: load disturbance responses of Example 2."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.ali import paper
from replicate.papers.ali.comparisons import visioli
from replicate.papers.ali.responses import draw_outputs

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-6",
    "Load responses, Example 2",
    caption="Unit step of a load at the plant input, exact dead time; Visioli's load setting. Read in the "
    "printed form (2) it is unstable (left); in the parallel form (right) it rejects the load with the "
    "smaller peak.",
    alt="Two panels of load responses. Left, Visioli's response oscillates with growing amplitude; right, it "
    "decays and has a smaller peak than the proposed one, which is smooth in both panels.",
    size=(7.4, 3.4),
)
def draw(fig: Figure) -> None:
    """Draw Figure 6."""
    draw_outputs(fig, visioli("load", 6.0), limits=(-0.45, 0.75))
