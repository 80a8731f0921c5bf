"""III, Figures 1 and 2: the loop of H-infinity control, without and with frequency weights."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.diagrams import Diagram

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "III-fig-1",
    "The loop with load disturbance $l$ and measurement noise $n$",
    kind="diagram",
    caption="The norm $\\gamma$ measures how the disturbances $n$ and $l$ reach the process output $x$ and the "
    "signal $v$.",
    alt="Block diagram. The load disturbance l and the negative controller output meet in v, which drives the "
    "process G; noise n is added to its output x before the controller Gc.",
    size=(6.4, 2.3),
)
def loop(fig: Figure) -> None:
    """Draw the loop without weights."""
    diagram = Diagram(fig)
    diagram.arrow((-1.4, 0), (-0.2, 0), label="$l$")
    diagram.sum((0, 0), {"left": "$+$", "bottom": "$-$"})
    diagram.arrow((0.2, 0), (1.6, 0), label="$v$")
    diagram.box((2.4, 0), "$G$")
    diagram.arrow((3.2, 0), (6.6, 0), label="$x$", at=(6.3, 0.25))
    diagram.dot((4.6, 0))
    diagram.arrow((4.6, 0), (4.6, -1.4))
    diagram.sum((4.6, -1.6), {"top": "$+$", "right": "$+$"})
    diagram.arrow((6.6, -1.6), (4.8, -1.6), label="$n$", at=(6.3, -1.35))
    diagram.arrow((4.4, -1.6), (3.2, -1.6))
    diagram.box((2.4, -1.6), "$G_c$")
    diagram.arrow((1.6, -1.6), (0, -1.6), (0, -0.2))
    diagram.frame(-1.6, 6.8, -2.3, 0.7)


@paper.figure(
    "III-fig-2",
    "The same loop with frequency weights",
    kind="diagram",
    caption="With the weights, process and controller become $W_o G W_i$ and $W_i^{-1} G_c W_o^{-1}$; the loop "
    "transfer function stays the same.",
    alt="Block diagram. The process G stands between an input weight and an output weight, the controller Gc between "
    "their inverses.",
    size=(6.4, 2.0),
)
def weighted_loop(fig: Figure) -> None:
    """Draw the loop with weights."""
    diagram = Diagram(fig)
    diagram.arrow((-1.4, 0), (-0.2, 0), label="$\\bar l$")
    diagram.sum((0, 0), {"left": "$+$", "bottom": "$-$"})
    forward = ((2.0, "$W_i$"), (4.6, "$G$"), (7.2, "$W_o$"))
    back = ((2.0, "$W_i^{-1}$"), (4.6, "$G_c$"), (7.2, "$W_o^{-1}$"))
    diagram.arrow((0.2, 0), (1.2, 0), label="$\\bar v$")
    for x, text in forward:
        diagram.box((x, 0), text)
    for x, text in back:
        diagram.box((x, -1.7), text)
    for x in (2.8, 5.4):
        diagram.arrow((x, 0), (x + 1.0, 0))
        diagram.arrow((x + 1.0, -1.7), (x, -1.7))
    diagram.arrow((8.0, 0), (10.8, 0), label="$\\bar x$", at=(10.5, 0.28))
    diagram.dot((9.2, 0))
    diagram.arrow((9.2, 0), (9.2, -1.5))
    diagram.sum((9.2, -1.7), {"top": "$+$", "right": "$+$"})
    diagram.arrow((10.8, -1.7), (9.4, -1.7), label="$\\bar n$", at=(10.5, -1.4))
    diagram.arrow((9.0, -1.7), (8.0, -1.7))
    diagram.arrow((1.2, -1.7), (0, -1.7), (0, -0.2))
    diagram.frame(-1.6, 11.0, -2.4, 0.7)
