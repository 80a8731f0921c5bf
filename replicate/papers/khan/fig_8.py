"""Figure 8: responses of the tuning rules to set-point and load, and the robustness of the proposed rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.khan import paper
from replicate.papers.khan.processes import LOAD_AT, NAMES, RESTORED, loop
from replicate.papers.khan.robustness import robustness
from replicate.papers.khan.tables import RULES_1, RULES_2

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ALT = "Output against time: the responses of the tuning rules to a set-point step at zero and a load step half way."


def _responses(axes: Axes, rules: tuple[str, ...], h: float, end: float) -> None:
    t = np.linspace(0.0, end, 1201)
    for rule in rules:
        y = loop(rule, 1.0, h, RESTORED).respond(load=1.0, load_at=LOAD_AT[h], until=end).output
        width = 2.2 if rule == "Proposed" else 1.1
        axes.plot(t, y(t), lw=width, label=NAMES.get(rule, rule))
    axes.axhline(1.0, color="0.6", lw=0.7, ls=":")
    axes.set(xlabel="$t$ (s)", ylabel="$y$", xlim=(0, end))
    axes.legend(ncols=2)


@paper.figure(
    "fig-8a",
    "Responses for $ph = 10$",
    caption="$p = 1$, $h = 10$; the load enters at $t = 100$.",
    alt=ALT,
    size=(7.2, 3.8),
)
def large(fig: Figure) -> None:
    """Draw the responses for the largest dead time."""
    axes = fig.subplots()
    _responses(axes, RULES_1, 10.0, 200.0)
    axes.set_ylim(0.0, 2.2)


@paper.figure(
    "fig-8b", "Responses for $ph = 1$", caption="$p = h = 1$; the load enters at $t = 25$.", alt=ALT, size=(7.2, 3.8)
)
def medium(fig: Figure) -> None:
    """Draw the responses for a medium dead time."""
    axes = fig.subplots()
    _responses(axes, RULES_2, 1.0, 50.0)
    axes.set_ylim(0.0, 2.0)


@paper.figure(
    "fig-8c", "Responses for $ph = 0.1$", caption="$p = 1$, $h = 0.1$; the load enters at $t = 5$. (7a) with its zeros "
    "restored.", alt=ALT, size=(7.2, 3.8)
)  # fmt: skip
def small(fig: Figure) -> None:
    """Draw the responses for a small dead time."""
    axes = fig.subplots()
    _responses(axes, RULES_2, 0.1, 10.0)
    axes.set_ylim(0.0, 2.0)


@paper.figure(
    "fig-8d",
    "Gain margin, phase margin and $M_s$ of the proposed rule",
    caption="The phase margin is in radians, as in the paper. (7a) with its zeros restored.",
    alt="Three curves against ph from 0.01 to 20, logarithmic axis: gain margin falling from four to 2.6, M_s "
    "rising from 1.4 to 1.7, phase margin nearly constant above one radian.",
    size=(7.2, 3.8),
)
def margins(fig: Figure) -> None:
    """Draw margins and sensitivity over ph."""
    axes = fig.subplots()
    ph, gain, phase, ms = robustness(RESTORED)
    for values, label in ((gain, "$G_m$"), (ms, "$M_s$"), (phase, "$\\phi_m$ (rad)")):
        axes.plot(ph, values, label=label)
    axes.axhline(2.5, color="0.6", lw=0.7, ls=":")
    axes.set(xscale="log", xlabel="$ph$", xlim=(0.01, 20), ylim=(0, 4.5))
    axes.legend()
