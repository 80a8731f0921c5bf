"""Figures 1 to 3 of the supplement: the surface ki(k, kd), and the ellipses, vertex loci and regions behind it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.figures.curve_labels import label_curves
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2 import feasible
from replicate.papers.panagopoulos.part_2.example_controllers import CONTROLLERS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SECTIONS = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0)
SHEAR, LIFT = 0.16, 0.17  # of the oblique view, per unit of kd
COARSE = (1.6, 161)


@paper.figure(
    "IIs-fig-1",
    "The surface $k_i(k, k_d)$ of the sensitivity constraint",
    caption="$G = 1/(s+1)^4$, $M_s = 1.4$. Left: sections of constant $k_d$, each drawn a little further back; "
    "between the upper (full) and the lower surface (dashed) the loop is stable and outside the circle. Right: the "
    "upper surface along its ridge. For small $k_d$ the lower surface is zero and the top is smooth (one touching "
    "frequency); beyond the kink the top is an edge, where upper and lower surface meet.",
    alt="Left: six sections of the surface in an oblique view; those for small kd are hills with a flat top, "
    "those for large kd narrow to a wedge whose tip is the maximum. Right: the largest ki over kd, rising, smooth up "
    "to kd of about two, then with a maximum at about two and a half and falling steeply.",
    size=(7.4, 3.7),
)
def surface(fig: Figure) -> None:
    """Draw the sections and the ridge."""
    left, right = fig.subplots(1, 2)
    for n, kd in enumerate(reversed(SECTIONS)):
        k, lower, upper = feasible.region(kd, *COARSE)
        inside = ~np.isnan(upper)
        x, up, low = k[inside] + SHEAR * kd, upper[inside] + LIFT * kd, lower[inside] + LIFT * kd
        color = f"C{(len(SECTIONS) - 1 - n) % 7}"
        left.fill_between(x, low, up, color=color, alpha=0.18, linewidth=0.0)
        left.plot(x, up, color=color, linestyle="-", label=f"$k_d = {kd:g}$, upper")
        left.plot(x, low, color=color, linestyle="--", linewidth=1.1, label=f"$k_d = {kd:g}$, lower")
        left.text(x[0] - 0.03, up[0], f"{kd:g}", ha="right", va="center", fontsize=9)
    left.text(0.02, 0.97, "$k_d$ beside each section", transform=left.transAxes, va="top", fontsize=9)
    left.set_xlabel("$k$, shifted right with $k_d$")
    left.set_ylabel("$k_i$, shifted up with $k_d$")
    left.set_xlim(-0.1, 2.0)
    left.set_title("sections")
    gains = np.linspace(0.0, 3.4, 35)
    smooth, edge = np.full(gains.size, np.nan), np.full(gains.size, np.nan)
    for i, kd in enumerate(gains):
        found = feasible.best(float(kd))
        if found is not None:
            (smooth if found.smooth else edge)[i] = found.ki
    right.plot(gains, smooth, label="smooth")
    right.plot(gains, edge, label="edge", linestyle="-", color="C1")
    right.set_xlabel("$k_d$")
    right.set_ylabel("largest $k_i$")
    right.set_ylim(0.0)
    right.set_title("ridge")
    if not label_curves(right):
        right.legend(loc="lower center")


def _loci(axes: Axes, kd: float, w: np.ndarray) -> None:
    for vertex, color, label in (("L", "C1", "left"), ("R", "C3", "right"), ("B", "C0", "bottom")):
        k, ki = feasible.vertices(vertex, w, kd)  # type: ignore[arg-type]
        axes.plot(k, ki, color=color, linestyle="--", label=label)


def _shade(axes: Axes, kd: float) -> None:
    k, lower, upper = feasible.region(kd)
    inside = ~np.isnan(upper)
    if np.any(inside):
        axes.fill_between(
            k[inside], lower[inside], upper[inside], color="C2", alpha=0.35, linewidth=0.0, label="feasible"
        )


@paper.figure(
    "IIs-fig-2",
    "How the region of feasible $(k, k_i)$ arises",
    caption="$k_d = 1$. Left: the ellipses that the constraint excludes, one per frequency, with the loci of "
    "their left, right and bottom vertices. Right: what is left free (shaded) is bounded by the ellipses, not quite by "
    "the vertices.",
    alt="Left: a family of ellipses in the plane of k and ki that rises from left to right, with dashed curves through "
    "their left, right and bottom vertices. Right: the shaded region below all ellipses, close to the dashed curves "
    "near its top and below them at its left end.",
    size=(7.4, 3.6),
)
def ellipses(fig: Figure) -> None:
    """Draw ellipses, vertex loci and the region for kd = 1."""
    kd, w = 1.0, np.geomspace(0.05, 2.0, 400)
    left, right = fig.subplots(1, 2, sharex=True, sharey=True)
    for n, frequency in enumerate(np.geomspace(0.15, 1.1, 15)):
        k, ki = feasible.ellipse(float(frequency), kd)
        left.plot(k, ki, color="C6", linewidth=0.8, linestyle="-", label="ellipses" if n == 0 else None)
    _loci(left, kd, w)
    _shade(right, kd)
    _loci(right, kd, w)
    for axes, title in ((left, "ellipses and vertices"), (right, "region")):
        axes.set_xlim(0.0, 2.0)
        axes.set_ylim(0.0, 1.5)
        axes.set_xlabel("$k$")
        axes.set_title(title)
        axes.legend(loc="upper left", fontsize=9)
    left.set_ylabel("$k_i$")


@paper.figure(
    "IIs-fig-3",
    "Vertex loci and true regions for $k_d$ = 1 to 4",
    caption="$G = 1/(s+1)^4$, $C = 1$, $R = 1/1.4$. Shaded: where the loop is stable and the constraint holds. "
    "Dashed: the loci of the vertices, from which the supplement reads the region. Crosses: the controllers it "
    "chooses, both outside the region. For $k_d = 4$ nothing is left.",
    alt="Four panels of ki over k. For kd = 1 the shaded hill nearly fills the space below the vertex loci, for "
    "kd = 2 it ends at an edge on the right, for kd = 3 it is a small wedge far below the crossing of the loci, for kd "
    "= 4 it is empty.",
    size=(7.0, 6.2),
)
def regions(fig: Figure) -> None:
    """Draw the four regions."""
    w = np.geomspace(0.05, 2.5, 500)
    panels = fig.subplots(2, 2, sharex=True, sharey=True)
    for kd, axes in zip((1.0, 2.0, 3.0, 4.0), panels.flat, strict=True):
        _shade(axes, kd)
        _loci(axes, kd, w)
        for controller in CONTROLLERS.values():
            if controller.kd == kd:
                axes.plot(
                    [controller.k], [controller.ki], marker="x", linestyle="", color="C4", markersize=8, label="chosen"
                )
        axes.set_xlim(0.0, 2.0)
        axes.set_ylim(0.0, 1.5)
        axes.set_title(f"$k_d = {kd:g}$")
    for axes in panels[1]:
        axes.set_xlabel("$k$")
    for axes in panels[:, 0]:
        axes.set_ylabel("$k_i$")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside upper center", ncols=5)
