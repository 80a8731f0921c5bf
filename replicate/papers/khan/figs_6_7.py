"""Figures 6 and 7: the PI loop in two forms."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.khan import paper
from replicate.papers.khan.loop_diagram import loop_diagram

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-6",
    "The PI loop in the parameters $K_P$, $K_I$, $p$",
    kind="diagram",
    caption="The load $\\tilde w$ enters at the process input, before the dead time.",
    alt="Block diagram: summing junction, controller K_P + K_I/s, a second junction where the load enters, process "
    "exp(-hs)/(s+p), unit feedback.",
    size=(7.0, 2.3),
)
def parallel_form(fig: Figure) -> None:
    """Draw the loop in parallel form."""
    loop_diagram(fig, ["$K_P + \\dfrac{K_I}{s}$", "$\\dfrac{e^{-hs}}{s + p}$"], load=True)


@paper.figure(
    "fig-7",
    "The PI loop in the parameters $L_P$, $L_I$, $\\tau$",
    kind="diagram",
    caption="The same loop with $\\tau = 1/p$, $L_P = K_P\\tau$, $L_I = K_I/K_P$ (4).",
    alt="Block diagram: summing junction, controller L_P (1 + L_I/s), load junction, process exp(-hs)/(tau s + "
    "1), unit "
    "feedback.",
    size=(7.0, 2.3),
)
def ideal_form(fig: Figure) -> None:
    """Draw the loop in the form of (4)."""
    loop_diagram(fig, ["$L_P\\left(1 + \\dfrac{L_I}{s}\\right)$", "$\\dfrac{e^{-hs}}{\\tau s + 1}$"], load=True)
