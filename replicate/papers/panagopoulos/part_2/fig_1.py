"""Figure 1 of paper II: the design problem."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from replicate.papers.panagopoulos import paper

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "II-fig-1",
    "The design problem",
    kind="diagram",
    caption="A controller with two degrees of freedom: feedforward $G_{ff}$ from the set point, feedback $G_c$ "
    "from the measurement. The load $l$ enters at the input of the process, the noise $n$ at its output.",
    alt="Block diagram. The set point goes through Gff to a summing junction, where the feedback signal from Gc "
    "is subtracted. The sum u and the load l drive the process G. Noise n is added to the process output, and the "
    "measurement y feeds Gc.",
    size=(6.4, 2.3),
)
def draw(fig: Figure) -> None:
    """Draw the block diagram."""
    import matplotlib as mpl
    import schemdraw
    from schemdraw import dsp

    axes = fig.add_subplot()
    drawing = schemdraw.Drawing(canvas=axes, show=False)
    drawing.config(fontsize=11, color=mpl.rcParams["text.color"], lw=1.2, unit=1.0)
    drawing += dsp.Arrow().right(1.0).label("$y_{sp}$", loc="top")
    drawing += (forward := dsp.Box(w=1.7, h=1.0).anchor("W").label("$G_{ff}(s)$"))
    drawing += dsp.Arrow().right(0.9).at(forward.E)
    drawing += (difference := dsp.Circle(radius=0.28))  # type: ignore[no-untyped-call]
    drawing += dsp.Arrow().right(1.0).at(difference.E).label("$u$", loc="top")
    drawing += (load := dsp.Circle(radius=0.28))  # type: ignore[no-untyped-call]
    drawing += dsp.Arrow().right(0.9).at(load.E)
    drawing += (process := dsp.Box(w=1.7, h=1.0).anchor("W").label("$G(s)$"))
    drawing += dsp.Arrow().right(0.9).at(process.E)
    drawing += (noise := dsp.Circle(radius=0.28))  # type: ignore[no-untyped-call]
    drawing += dsp.Line().right(0.8).at(noise.E)
    drawing += (tap := dsp.Dot(radius=0.06))
    drawing += dsp.Arrow().right(0.8).at(tap.center).label("$y$", loc="top")
    for junction, name in ((load, "$l$"), (noise, "$n$")):
        drawing += dsp.Line().at((junction.N[0], junction.N[1] + 0.8)).to(junction.N).label(name, loc="top")
        drawing += dsp.Arrow().at((junction.N[0], junction.N[1] + 0.4)).to(junction.N)
    drawing += dsp.Line().down(1.7).at(tap.center)
    drawing += dsp.Line().left(tap.center[0] - process.E[0] + 0.2)
    drawing += (feedback := dsp.Box(w=1.7, h=1.0).anchor("E").label("$G_c(s)$"))
    drawing += dsp.Line().at(feedback.W).tox(difference.S)
    drawing += dsp.Arrow().toy(difference.S)
    drawing.draw(show=False)
    text: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 10}
    axes.text(difference.S[0] + 0.22, difference.S[1] - 0.22, "$-$", **text)
    axes.set_axis_off()
    axes.set_aspect("equal")
