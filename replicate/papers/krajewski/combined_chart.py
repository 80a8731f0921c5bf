"""One chart with everything a designer needs at a given τ: the paper's loci together, and the maximum sensitivity."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.design_chart import design_chart, round_steps
from replicate.papers.krajewski.drawing import draw_locus, fill_loci, inside, label_locus, plane
from replicate.papers.krajewski.gain_chart import gain_chart
from replicate.papers.krajewski.loci import (
    Locus,
    constant_crossover,
    constant_gain_ratio,
    constant_phase_margin,
    largest_a,
    stability_boundary,
    upper_end,
)
from replicate.papers.krajewski.normalised_loop import end_frequency
from replicate.papers.krajewski.sensitivity_locus import constant_sensitivity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARGINS = (30.0, 45.0, 60.0, 75.0, 90.0)  # degrees
RATIOS = (0.2, 0.3, 0.4, 0.5)
SENSITIVITIES = (2.0, 1.6, 1.4, 1.2)
SHORTEST, LONGEST = 0.01, 20.0  # range of τ in which the chart has been checked
SIZE = (8.2, 7.4)

Box = tuple[tuple[float, float], tuple[float, float]]

STYLES: dict[str, dict[str, Any]] = {
    "phase margin": {"edgecolor": "C0", "linewidth": 1.9},
    "gain ratio": {"edgecolor": "C1", "linewidth": 1.4, "linestyle": (0, (5, 2))},
    "crossover": {"edgecolor": "C2", "linewidth": 1.1, "linestyle": (0, (1, 1.6))},
    "sensitivity": {"edgecolor": "C3", "linewidth": 1.2, "linestyle": (0, (6, 1.5, 1, 1.5))},
}


def draw_combined(axes: Axes, tau: float) -> None:
    """Draw all loci for one τ on the axes of the (a, b) plane."""
    least = min(MARGINS)
    top = upper_end(tau, least)
    box: Box = ((0.0, 1.1 * largest_a(tau, least)), (-1.0 - 0.02 * top, 1.06 * top))
    plane(axes, *box)
    draw_locus(axes, stability_boundary(tau), "stability boundary", edgecolor="0.45", linewidth=2.4)
    _sensitivities(axes, tau, box)
    _crossovers(axes, tau, box)
    for g in RATIOS:
        _labelled(axes, constant_gain_ratio(tau, g), box, 0.88, ("gain ratio", f"g = {g:g}", f"{g:g}"))
    for margin in MARGINS:
        name = ("phase margin", f"phase margin {margin:g}", f"{margin:g}°")
        _labelled(axes, constant_phase_margin(tau, margin), box, 0.34, name)
    end = min(box[0][1], box[1][1])
    axes.plot([0.0, end], [0.0, end], color="0.5", linestyle="-", linewidth=0.9, label="b = a", zorder=1)
    diagonal = Locus(lambda u: (end * np.column_stack([u, u]), np.full((u.size, 2), end)))
    label_locus(axes, diagonal, 0.93, "$b = a$", "0.5", fontsize=9)


def _labelled(axes: Axes, locus: Locus, box: Box, fraction: float, name: tuple[str, str, str]) -> None:
    """Draw a locus of a family with its label at a fraction of the part inside the box."""
    family, curve, text = name
    draw_locus(axes, locus, curve, **STYLES[family])
    u = inside(locus, *box, fraction)
    if u is not None:
        label_locus(axes, locus, u, text, STYLES[family]["edgecolor"], fontsize=9)


def _sensitivities(axes: Axes, tau: float, box: Box) -> None:
    """Draw the loci of Ms over nested tints: the deeper the tint, the smaller Ms."""
    for ms in SENSITIVITIES:
        pieces = constant_sensitivity(tau, ms)
        fill_loci(axes, pieces, f"Ms at most {ms:g}", facecolor="C3", alpha=0.09, zorder=0.5)
        draw_locus(axes, pieces, f"Ms = {ms:g}", **STYLES["sensitivity"])
        u = inside(pieces[0], *box, 0.33)
        if u is not None:
            label_locus(axes, pieces[0], u, f"{ms:g}", "C3", fontsize=9)


def _crossovers(axes: Axes, tau: float, box: Box) -> None:
    least = min(MARGINS)
    for w in round_steps(1.02 * end_frequency(tau, least), 9):
        arc = constant_crossover(tau, w)
        if arc is None:
            continue
        draw_locus(axes, arc, f"crossover {w:g}", **STYLES["crossover"])
        outer = constant_crossover(tau, w, 0.0, least) or arc
        u = inside(outer, *box, 0.5)
        if u is not None:
            label_locus(axes, outer, u, f"{w:g}", "C2", fontsize=9)


def combined_chart(tau: float, fig: Figure | None = None) -> Figure:
    """Draw phase margin, gain margin, crossover frequency and maximum sensitivity for any normalised dead time.

    Parameters
    ----------
    tau
        Normalised dead time L/T, from 0.01 to 20.
    fig
        An empty figure to draw on; by default a new one of a suitable size.

    Returns
    -------
    matplotlib.figure.Figure
        Ready for ``savefig``.

    Raises
    ------
    ValueError
        If τ is outside its range.
    """
    from matplotlib.figure import Figure as Canvas
    from matplotlib.lines import Line2D

    if not SHORTEST <= tau <= LONGEST:
        msg = f"tau must be between {SHORTEST:g} and {LONGEST:g}, not {tau:g}"
        raise ValueError(msg)
    fig = Canvas(figsize=SIZE, layout="constrained") if fig is None else fig
    axes = fig.add_subplot()
    draw_combined(axes, tau)
    axes.set_title(f"PI design chart, $\\tau = L/T = {tau:g}$:  $K_P = b/K$,  $K_I = a/(KT)$,  $T_I = bT/a$")
    names = {
        "phase margin": "phase margin $m_\\varphi$, degrees",
        "gain ratio": "$g$, gain margin $1/g$",
        "crossover": "crossover $\\omega_A = T\\hat\\omega_A$",
        "sensitivity": "maximum sensitivity $M_s$",
    }
    handles = [
        Line2D([], [], color=style["edgecolor"], linewidth=style["linewidth"], linestyle=style.get("linestyle", "-"))
        for style in STYLES.values()
    ]
    handles.append(Line2D([], [], color="0.45", linewidth=2.4))
    labels = [names[family] for family in STYLES] + ["stability boundary"]
    fig.legend(handles, labels, loc="outside lower center", ncols=3)
    return fig


@paper.chart(
    "combined",
    "PI design chart",
    parameters={"tau": f"normalised dead time L/T, {SHORTEST:g} to {LONGEST:g}"},
    size=SIZE,
)
def draw_chart(fig: Figure, tau: float) -> None:
    """Draw the combined chart on an empty figure."""
    combined_chart(tau, fig)


@paper.chart("design", "Design chart", parameters={"tau": "normalised dead time L/T"})
def draw_design_chart(fig: Figure, tau: float) -> None:
    """Draw one panel of Figure 6 for any dead time."""
    design_chart(fig.add_subplot(), tau, crossovers=12)


@paper.chart("gain-margin", "Gain margin chart", parameters={"tau": "normalised dead time L/T"})
def draw_gain_chart(fig: Figure, tau: float) -> None:
    """Draw one panel of Figure 7 for any dead time."""
    gain_chart(fig.add_subplot(), tau)


@paper.figure(
    "combined-chart",
    "Everything for one dead time",
    caption="Not in the paper: the loci of Figures 6 and 7 in one chart, with those of the maximum "
    "sensitivity $M_s$ (tinted: the deeper, the more robust), here for $\\tau = 0.5$. On the line $b = a$ "
    "the controller's zero cancels the pole of the process. For any other dead time: `replicate chart "
    "krajewski --tau 0.35`.",
    alt="Design chart in the a-b plane with nested curves of phase margin, gain margin and maximum "
    "sensitivity, elliptic arcs of crossover frequency and the diagonal b = a.",
    size=SIZE,
)
def draw(fig: Figure) -> None:
    """Draw the combined chart for the paper's favourite dead time."""
    combined_chart(0.5, fig)
