"""Figures 1, 2, 6 and 7: the bump test and the block diagrams."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

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


def _loop(fig: Figure, blocks: list[str], *, load: bool) -> None:
    import matplotlib as mpl
    import schemdraw
    from schemdraw import dsp

    axes = fig.add_subplot()
    drawing = schemdraw.Drawing(canvas=axes, show=False)
    drawing.config(fontsize=11, color=mpl.rcParams["text.color"], lw=1.2, unit=1.0)
    drawing += dsp.Arrow().right(1.1).label("$r$", loc="top")
    drawing += (junction := dsp.Circle(radius=0.28))  # type: ignore[no-untyped-call]
    last = junction
    summing = None
    for index, text in enumerate(blocks):
        drawing += dsp.Arrow().right(0.9).at(last.E)
        if load and index == 1:
            drawing += (summing := dsp.Circle(radius=0.28).anchor("W"))  # type: ignore[no-untyped-call]
            drawing += dsp.Arrow().down(0.9).at((summing.N[0], summing.N[1] + 0.9))
            drawing += dsp.Arrow().right(0.9).at(summing.E)
        drawing += (last := dsp.Box(w=max(1.7, 0.16 * len(text)), h=1.2).anchor("W").label(text))
    drawing += dsp.Line().right(0.7).at(last.E)
    drawing += (tap := dsp.Dot(radius=0.06))
    drawing += dsp.Arrow().right(0.9).at(tap.center).label("$y$", loc="top")
    drawing += dsp.Line().down(1.4).at(tap.center)
    drawing += dsp.Line().tox(junction.S)
    drawing += dsp.Arrow().toy(junction.S)
    drawing.draw(show=False)
    style: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 10}
    axes.text(junction.W[0] - 0.2, junction.W[1] + 0.22, "$+$", **style)
    axes.text(junction.S[0] + 0.22, junction.S[1] - 0.2, "$-$", **style)
    if summing is not None:
        axes.text(summing.N[0], summing.N[1] + 1.1, "$\\tilde w$" if "+ p" in blocks[-1] else "$w$", **style)
    axes.set_axis_off()
    axes.set_aspect("equal")


@paper.figure(
    "fig-2",
    "Process with dead time under proportional control",
    kind="diagram",
    alt="Block diagram: reference, summing junction, gain K, process exp(-hs)/(s+p), unit feedback.",
    size=(6.0, 1.9),
)
def proportional(fig: Figure) -> None:
    """Draw the proportional loop."""
    _loop(fig, ["$K$", "$\\dfrac{e^{-hs}}{s + p}$"], load=False)


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
    _loop(fig, ["$K_P + \\dfrac{K_I}{s}$", "$\\dfrac{e^{-hs}}{s + p}$"], load=True)


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
    _loop(fig, ["$L_P\\left(1 + \\dfrac{L_I}{s}\\right)$", "$\\dfrac{e^{-hs}}{\\tau s + 1}$"], load=True)
