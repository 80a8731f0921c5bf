"""Figure 1: the feedback loop."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from replicate.papers.bayhan import paper

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-1",
    "The process with dead time under PI control",
    kind="diagram",
    caption="The control error $e = r - y$ drives the PI controller $F(s)$; the process is a first-order "
    "lag followed by a dead time.",
    alt="Block diagram. The reference r enters a summing junction, its output e the PI controller F(s), "
    "whose output u drives the process G(s), a first-order lag times a dead time. The output y is fed back "
    "to the junction with a minus sign.",
    size=(6.4, 2.0),
)
def draw(fig: Figure) -> None:
    """Draw the block diagram."""
    import matplotlib as mpl
    import schemdraw
    from schemdraw import dsp

    axes = fig.add_subplot()
    ink = mpl.rcParams["text.color"]
    drawing = schemdraw.Drawing(canvas=axes, show=False)
    drawing.config(fontsize=11, color=ink, lw=1.2, unit=1.0)
    drawing += dsp.Arrow().right(1.2).label("$r(t)$", loc="top")
    drawing += (junction := dsp.Circle(radius=0.3))  # type: ignore[no-untyped-call]
    drawing += dsp.Arrow().right(1.2).at(junction.E).label("$e(t)$", loc="top")
    drawing += (controller := dsp.Box(w=2.6, h=1.3).anchor("W").label("$K_p + \\dfrac{K_i}{s}$"))
    drawing += dsp.Arrow().right(1.2).at(controller.E).label("$u(t)$", loc="top")
    drawing += (process := dsp.Box(w=3.2, h=1.3).anchor("W").label("$\\dfrac{K}{\\tau s + 1}\\,e^{-sL}$"))
    drawing += dsp.Line().right(0.8).at(process.E)
    drawing += (tap := dsp.Dot(radius=0.06))
    drawing += dsp.Arrow().right(1.0).at(tap.center).label("$y(t)$", loc="top")
    drawing += dsp.Line().down(1.5).at(tap.center)
    drawing += dsp.Line().tox(junction.S)
    drawing += dsp.Arrow().toy(junction.S)
    text: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 10}
    drawing.draw(show=False)
    axes.text(junction.W[0] - 0.22, junction.W[1] + 0.24, "$+$", **text)
    axes.text(junction.S[0] + 0.22, junction.S[1] - 0.22, "$-$", **text)
    for box, name in ((controller, "PI controller $F(s)$"), (process, "process $G(s)$")):
        axes.text(box.N[0], box.N[1] + 0.28, name, **text)
    axes.set_axis_off()
    axes.set_aspect("equal")
