"""III, Figures 3 to 6: the circles, the weight, the gamma contours and the circle that encloses one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.figures.curve_labels import label_curves
from replicate.loops import Circle
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.iii_examples import smallest_weight
from replicate.papers.panagopoulos.parts_3_to_6.loop_shaping import (
    CONTOURS,
    PRINTED,
    M,
    combined_circle,
    contour,
    contour_points,
    favourable_weight,
    gamma_of_m,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TURN = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 401))


def _plane(axes: Axes, left: float, right: float, half_height: float) -> None:
    axes.axhline(0.0, color="0.6", linewidth=0.7, zorder=0)
    axes.axvline(0.0, color="0.6", linewidth=0.7, zorder=0)
    axes.plot([-1.0], [0.0], marker="+", markersize=8, color=axes.xaxis.label.get_color(), linestyle="none")
    axes.set_xlim(left, right)
    axes.set_ylim(-half_height, half_height)
    axes.set_aspect("equal")
    axes.set_xlabel("$\\mathrm{Re}\\,L$")


def _circle(axes: Axes, circle: Circle, **style: object) -> None:
    points = -circle.center + circle.radius * TURN
    axes.plot(points.real, points.imag, **style)  # type: ignore[arg-type]


@paper.figure(
    "III-fig-3",
    "The $M_s$, $M_p$ and combined circles for $M_s = M_p = 2$",
    caption="A Nyquist curve outside the combined circle satisfies both bounds. The circle is the smallest on "
    "the real axis that contains the other two.",
    alt="Three circles around the point minus one: the Ms circle reaches from -1.5 to -0.5, the Mp circle from -2 to "
    "-0.67, the combined circle from -2 to -0.5 and contains both.",
    size=(6.4, 4.2),
)
def circles(fig: Figure) -> None:
    """Draw Figure 3."""
    axes = fig.subplots()
    _circle(axes, Circle.of(ms=M), label="$M_s$ circle", linestyle="--")
    _circle(axes, Circle.of(mp=M), label="$M_p$ circle", linestyle=":", linewidth=2.0)
    _circle(axes, combined_circle(M), label="combined circle", linewidth=2.0)
    _plane(axes, -2.3, 0.5, 0.9)
    axes.set_ylabel("$\\mathrm{Im}\\,L$")
    if not label_curves(axes):
        axes.legend(loc="upper right")


@paper.figure(
    "III-fig-4",
    "The weight $|W(i\\omega)|$ of Example 1",
    caption="$|W| = \\sqrt{|G_c|/|G|}$ for $G(s) = 1/(s+1)^4$ with $k = 0.76$, $k_i = 0.36$, with its asymptotes "
    "$\\sqrt{k_i/\\omega}$ and $\\sqrt{k}\\,\\omega^2$ (dashed).",
    alt="Magnitude of the weight over frequency, both logarithmic: it falls with slope -1/2 to a minimum a little "
    "above one and rises with slope 2 beyond.",
    size=(6.4, 3.6),
)
def weight(fig: Figure) -> None:
    """Draw Figure 4."""
    axes = fig.subplots()
    w = np.geomspace(0.01, 100.0, 601)
    axes.loglog(w, favourable_weight().magnitude(w), linewidth=2.0, label="$|W(i\\omega)|$")
    low, high = w[w < 1.0], w[w > 0.5]
    axes.loglog(low, np.sqrt(PRINTED.ki / low), "--", linewidth=1.0, color="0.5", label="asymptotes")
    axes.loglog(high, np.sqrt(PRINTED.k) * high**2, "--", linewidth=1.0, color="0.5")
    smallest, frequency = smallest_weight()
    axes.plot([frequency], [smallest], "o", markersize=5, label=f"minimum {smallest:.3f}")
    axes.set_xlim(0.01, 100.0)
    axes.set_ylim(0.3, 2e4)
    axes.set_xlabel("frequency $\\omega$")
    axes.set_ylabel("$|W(i\\omega)|$")
    axes.legend(loc="upper left")


@paper.figure(
    "III-fig-5",
    "The $\\gamma$ contours and their marked points",
    caption="Left: contours $(1+|L|)/|1+L| = \\gamma$. Right: the contour of $\\gamma = 2.3$ with the points of "
    "the text; $A$ lies on the unit circle (dotted), $C$ is the centre of the circle through $A$, here the "
    "combined circle $M(\\gamma)$ (dashed).",
    alt="Left: eight nested closed curves around the point minus one, the larger gamma the smaller. Right: one "
    "contour with the points O, A, B, C and D.",
    size=(6.8, 3.6),
)
def contours(fig: Figure) -> None:
    """Draw Figure 5."""
    left, right = fig.subplots(1, 2)
    for index, gamma in enumerate(CONTOURS):
        curve = contour(gamma)
        left.plot(curve.real, curve.imag, color=f"C{index}", label=f"{gamma:g}")
    _plane(left, -3.2, 0.2, 1.9)
    left.set_ylabel("$\\mathrm{Im}\\,L$")
    fig.legend(title="$\\gamma$ of the left panel", loc="outside lower center", ncols=8, fontsize="small")

    gamma = CONTOURS[1]
    curve, points = contour(gamma), contour_points(gamma)
    ink = right.xaxis.label.get_color()
    right.plot(curve.real, curve.imag, linewidth=2.0, label="contour")
    right.plot(TURN.real, TURN.imag, ":", linewidth=1.0, color="0.5", label="unit circle")
    _circle(right, Circle(-points.oc, points.ac), linestyle="--", linewidth=1.0, label="circle")
    a = np.exp(1j * points.phase_of_a)
    marked = {"O": 0j, "A": a, "B": points.ob + 0j, "C": points.oc + 0j, "D": points.od + 0j}
    shifts = {"O": (0.1, 0.12), "A": (0.08, 0.14), "B": (0.12, 0.14), "C": (0.0, -0.24), "D": (-0.14, 0.14)}
    right.plot([0.0, a.real, points.oc], [0.0, a.imag, 0.0], color=ink, linestyle="-", linewidth=0.8)
    for name, point in marked.items():
        right.plot([point.real], [point.imag], "o", markersize=4, color=ink)
        dx, dy = shifts[name]
        right.text(point.real + dx, point.imag + dy, f"${name}$", ha="center", va="center")
    _plane(right, -3.2, 0.4, 1.9)


@paper.figure(
    "III-fig-6",
    "The $\\gamma$ curve inside the combined circle",
    caption="The contour of $\\gamma(M)$, (14), and the combined $M$-circle that encloses it; they touch at the "
    "two points on the unit circle (dots). The paper's caption names the rounded values $\\gamma = 2.06$ and 3.16.",
    alt="Two panels. In each the gamma contour lies inside the dashed combined circle and touches it at two conjugate "
    "points; the gap on the real axis is larger for M = 1.4 than for M = 2.",
    size=(6.8, 3.6),
)
def enclosure(fig: Figure) -> None:
    """Draw Figure 6."""
    for axes, m, left, half in zip(fig.subplots(1, 2), (1.4, 2.0), (-3.7, -2.3), (2.6, 1.65), strict=True):
        gamma = float(gamma_of_m(m))
        curve, points = contour(gamma), contour_points(gamma)
        axes.plot(curve.real, curve.imag, linewidth=2.0, label=f"$\\gamma = {gamma:.2f}$")
        _circle(axes, combined_circle(m), linestyle="--", label=f"$M = {m:.2f}$")
        touch = np.exp(1j * points.phase_of_a * np.array([1.0, -1.0]))
        axes.plot(touch.real, touch.imag, "o", markersize=5, color=axes.xaxis.label.get_color(), linestyle="none")
        _plane(axes, left, 0.2, half)
        axes.set_title(f"$M = {m:.1f}$")
        if not label_curves(axes):
            axes.legend(loc="upper left", fontsize="small")
    fig.axes[0].set_ylabel("$\\mathrm{Im}\\,L$")
