"""Figure 3: a typical step response under proportional control."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PI, Loop
from replicate.papers.khan import paper
from replicate.papers.khan.processes import plant

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-3",
    "A typical step response, $p = h = K = 1$",
    caption="Final value $y_{ss} = K/(K+p)$, peak $M_P$, and the rise time $t_r$ from 10 % to 90 % of the final value.",
    alt="Step response that starts after one dead time, overshoots 0.5 once and settles there; peak, final "
    "value and the "
    "rise time are marked.",
)
def draw(fig: Figure) -> None:
    """Draw the response with its marks."""
    y = Loop(plant(1.0, 1.0), PI(1.0)).step(until=10.0)
    axes = fig.subplots()
    t = np.linspace(0.0, 10.0, 801)
    axes.plot(t, y(t), label="$y(t)$")
    peak = y.peak()
    low, high = y.first_reach(0.1 * y.final), y.first_reach(0.9 * y.final)
    axes.axhline(y.final, color="0.5", lw=0.8, ls="--")
    axes.plot([peak.time], [peak.value], "o")
    axes.annotate("$M_P$", (peak.time, peak.value), xytext=(4, 4), textcoords="offset points")
    axes.annotate("$y_{ss}$", (0.0, y.final), xytext=(5, 4), textcoords="offset points")
    axes.plot([low, high], [0.1 * y.final, 0.9 * y.final], "s", ms=4)
    axes.vlines([low, high], 0.0, [0.1 * y.final, 0.9 * y.final], color="0.5", lw=0.8, ls=":")
    axes.annotate("", (high, 0.02), (low, 0.02), arrowprops={"arrowstyle": "<->", "lw": 0.9})
    axes.annotate("$t_r$", (0.5 * (low + high), 0.03), ha="center", va="bottom")
    axes.set(xlabel="$t$ (s)", ylabel="$y$", xlim=(0, 10), ylim=(0, 0.8))
