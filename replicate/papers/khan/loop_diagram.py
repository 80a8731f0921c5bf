"""Block diagram of a feedback loop, with or without a load before its last block."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def loop_diagram(fig: Figure, blocks: list[str], *, load: bool) -> None:
    """Draw the blocks in a row between the summing junction and the output, with unit feedback."""
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
