"""Figure 1: the bump test."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.khan import paper

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-1",
    "Step response of a process and its three-parameter model",
    kind="diagram",
    caption="The bump test: the tangent at the steepest point cuts the time axis at $h$ and reaches the final value "
    "$R_{ss}$ at $h + \\tau$. A lag of third order with dead time stands for the process, which the paper does "
    "not name.",
    alt="An S-shaped step response with its steepest tangent, dashed lines at the final value, and the times h "
    "and h plus "
    "tau marked on the axis.",
    size=(6.0, 3.2),
)
def bump_test(fig: Figure) -> None:
    """Draw the bump test of 1/(s+1)^3 e^{-0.5s}."""
    axes = fig.subplots()
    t = np.linspace(0.0, 10.0, 400)
    shifted = np.maximum(t - 0.5, 0.0)
    axes.plot(t, 1.0 - np.exp(-shifted) * (1.0 + shifted + shifted**2 / 2.0), label="response")
    # steepest where t^2 e^-t / 2 is largest, at t = 2
    slope, steepest = 2.0 * np.exp(-2.0), 1.0 - 5.0 * np.exp(-2.0)
    h = 2.5 - steepest / slope
    tau = 1.0 / slope
    axes.plot([h, h + tau], [0.0, 1.0], "--", label="tangent")
    axes.axhline(1.0, color="0.6", lw=0.8, ls=":")
    axes.axvline(h + tau, ymax=0.9, color="0.6", lw=0.8, ls=":")
    axes.set(xlim=(0, 10), ylim=(0, 1.15), xlabel="$t$", ylabel="$y$", yticks=[0, 1], yticklabels=["0", "$R_{ss}$"])
    axes.set_xticks([0, h, h + tau], ["0", "$h$", "$h + \\tau$"])
    axes.legend(loc="lower right")
