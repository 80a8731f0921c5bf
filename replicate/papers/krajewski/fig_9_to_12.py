"""Figures 9 to 12: step responses at the points that the paper discusses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.point_tables import point_table
from replicate.papers.krajewski.points import TAU, NamedPoint, named_points, response

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Responses:
    """One figure of step responses.

    Attributes
    ----------
    until
        End of the time axis.
    labels
        For every curve: the time at which its label stands, and the label's offset in points.
    """

    exhibit: str
    title: str
    caption: str
    alt: str
    until: float
    top: float
    labels: dict[str, tuple[float, tuple[float, float]]]


FIGURES = (
    Responses(
        "fig-9",
        "Step responses along the arc P1 P2",
        "$\\tau = 0.5$, $\\omega_A = 2$: from (a) $P_1$, $m_\\varphi = 45$ degrees, towards $P_2$ on the "
        "$b$ axis. The overshoot falls, the slow mode grows, and curve (d) has not settled long after the "
        "end of the axis.",
        "Four step responses that rise together. The one at P1 overshoots most and settles first; the one "
        "next to P2 swings below its neighbours and then creeps towards one.",
        12.0,
        1.35,
        {"a": (1.52, (6, 4)), "b": (1.75, (30, 6)), "c": (6.3, (0, -9)), "d": (7.0, (0, -12))},
    ),
    Responses(
        "fig-10",
        "Step responses along the arc of crossover frequency 1.5",
        "$\\tau = 0.5$: the points where the ellipse $\\omega_A = 1.5$ meets (a) 45, (b) 60 and (c) 75 "
        "degrees, as printed.",
        "Three step responses. Curve a overshoots and settles, curve b overshoots less and creeps from "
        "below, curve c stays below one and sags before it creeps up.",
        12.0,
        1.35,
        {"a": (2.0, (6, 5)), "b": (4.2, (2, -11)), "c": (5.5, (0, -12))},
    ),
    Responses(
        "fig-11",
        "Step responses on, or close to, the line b = a",
        "$\\tau = 0.5$: (a) the upper corner of Figure 8, (b) $a = b = 0.75$, (c) $a = b = 0.5$. The "
        "shaded band is $\\pm 2$ %.",
        "Three step responses of second-order shape. Curve a overshoots slightly; curves b and c rise "
        "without visible overshoot, c more slowly.",
        12.0,
        1.2,
        {"a": (2.3, (4, 6)), "b": (2.1, (12, -4)), "c": (2.9, (8, -8))},
    ),
    Responses(
        "fig-12",
        "Step responses on the line b = 0.916",
        "$\\tau = 0.5$: $a = 1$, $0.75$ and $0.5$ with $b = 11/12$. Towards the $b$ axis the slow "
        "aperiodic mode takes over. The shaded band is $\\pm 2$ %.",
        "Three step responses that start alike. Curve a overshoots slightly, b stays just below one, c "
        "bends away early and creeps up to one.",
        12.0,
        1.2,
        {"a": (2.3, (4, 6)), "b": (3.6, (6, -10)), "c": (4.4, (2, -12))},
    ),
)


def draw_responses(axes: Axes, figure: Responses) -> None:
    """Draw the responses of one figure with their names on them."""
    t = np.linspace(0.0, figure.until, 2401)
    axes.axhspan(0.98, 1.02, color="0.5", alpha=0.18, linewidth=0.0)
    axes.axvline(TAU, color="0.5", linewidth=0.8, linestyle=":", label="dead time")
    for index, (row, named) in enumerate(named_points(figure.exhibit).items()):
        y = response(named.a, named.b)
        color = f"C{index}"
        axes.plot(t, y(t), color=color, label=f"({row}) $a = {named.a:g}$, $b = {_shown(named)}$")
        time, offset = figure.labels[row]
        where = (time, float(y(time)))
        leader = {"arrowstyle": "-", "color": color, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
        axes.annotate(
            f"({row})",
            where,
            xytext=offset,
            textcoords="offset points",
            color=color,
            fontsize=9.5,
            ha="center",
            va="center",
            arrowprops=leader if abs(offset[0]) > 20 else None,
        )
    axes.set(xlim=(0.0, figure.until), ylim=(0.0, figure.top))
    axes.set_xlabel("time $t/T$")
    axes.set_ylabel("output $y(t)$")
    curves = axes.get_lines()[1:]
    axes.legend(handles=curves, loc="lower right")


def _shown(named: NamedPoint) -> str:
    """Return b with its digits, a repeating one as the paper's text prints it: with a bar."""
    digits = f"{named.caption_b:g}"
    return digits if named.b == named.caption_b else f"{digits[:-1]}\\bar{{{digits[-1]}}}"


def _register(figure: Responses) -> None:
    @paper.figure(figure.exhibit, figure.title, caption=figure.caption, alt=figure.alt, size=(6.4, 3.9))
    def draw(fig: Figure) -> None:
        draw_responses(fig.add_subplot(), figure)

    point_table(figure.exhibit, figure.title)


for _figure in FIGURES:
    _register(_figure)
