"""How the figures draw the responses of the examples: the proposed controller against one competitor.

Every figure has the pair twice: all in the printed form (2), and with the competitor in the parallel form. Control
signals after a set-point step begin with a kick that is an order of magnitude above the rest and over in a fraction of
the dead time; a narrow panel shows it on its own scales, and the wide panel beside it is cut off and says so.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Literal

import numpy as np

from replicate.loops import Signal
from replicate.papers.ali.examples import loop
from replicate.papers.ali.structures import Settings

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Kind = Literal["setpoint", "load"]

SAMPLES = 3000
PROPOSED = {"color": "C0", "linewidth": 2.0, "zorder": 3}
COMPETITOR = {"color": "C1", "linewidth": 1.1}
PANELS = {"series": "both in the printed form (2)", "ideal": "competitor in the parallel form"}


@dataclass(frozen=True)
class Comparison:
    """The proposed controller (always in form (2)) and one competitor, on the plant with dead time theta."""

    theta: Fraction
    proposed: Settings
    competitor: Settings
    name: str
    kind: Kind
    until: float


def _signals(comparison: Comparison, structure: str, until: float) -> dict[str, tuple[Signal, Signal]]:
    """Return output and control signal of both controllers, by label."""
    found = {}
    for label, settings, form in (
        ("(a) proposed", comparison.proposed, "series"),
        (f"(b) {comparison.name}", comparison.competitor, structure),
    ):
        controlled = loop(comparison.theta, form, settings)
        setpoint, load = (1.0, 0.0) if comparison.kind == "setpoint" else (0.0, 1.0)
        response = controlled.respond(setpoint=setpoint, load=load, until=until)
        found[label if controlled.is_stable() else f"{label}, unstable"] = (response.output, response.control)
    return found


def _draw(axes: Axes, signals: dict[str, Signal], until: float) -> None:
    times = np.linspace(0.0, until, SAMPLES + 1)
    for (label, signal), style in zip(signals.items(), (PROPOSED, COMPETITOR), strict=True):
        axes.plot(times, signal(times), label=label, **style)  # type: ignore[arg-type]
    axes.set_xlim(0.0, until)


def draw_outputs(fig: Figure, comparison: Comparison, limits: tuple[float, float]) -> None:
    """Draw the outputs, one panel per structure of the competitor."""
    both = fig.subplots(1, len(PANELS), sharey=True)
    target = 1.0 if comparison.kind == "setpoint" else 0.0
    for axes, (structure, title) in zip(both, PANELS.items(), strict=True):
        axes.axhline(target, color="0.5", linewidth=0.9, zorder=0)
        signals = _signals(comparison, structure, comparison.until)
        _draw(axes, {label: output for label, (output, _) in signals.items()}, comparison.until)
        axes.set_ylim(*limits)
        axes.set_title(title)
        axes.set_xlabel("time $t$")
        axes.legend(loc="upper right")
    both[0].set_ylabel("output $y(t)$")


def draw_load_controls(fig: Figure, comparison: Comparison, limits: tuple[float, float]) -> None:
    """Draw the control signals after a load step, which have no kick: one panel per structure of the competitor."""
    both = fig.subplots(1, len(PANELS), sharey=True)
    for axes, (structure, title) in zip(both, PANELS.items(), strict=True):
        axes.axhline(-1.0, color="0.5", linewidth=0.9, zorder=0)
        signals = _signals(comparison, structure, comparison.until)
        _draw(axes, {label: control for label, (_, control) in signals.items()}, comparison.until)
        axes.set_ylim(*limits)
        axes.set_title(title)
        axes.set_xlabel("time $t$")
        axes.legend(loc="upper right")
    both[0].set_ylabel("control signal $u(t)$")


def draw_setpoint_controls(
    fig: Figure, comparison: Comparison, limits: tuple[float, float], kick_until: float, kick_top: float
) -> None:
    """Draw the control signals after a set-point step: the kick, and the rest on axes cut off below it."""
    grid = fig.subplots(len(PANELS), 2, width_ratios=[1.0, 3.2])
    for (left, right), (structure, title) in zip(grid, PANELS.items(), strict=True):
        signals = _signals(comparison, structure, comparison.until)
        controls = {label: control for label, (_, control) in signals.items()}
        _draw(left, controls, kick_until)
        left.set_ylim(0.0, kick_top)
        left.set_title("the kick")
        left.set_ylabel("control signal $u(t)$")
        _draw(right, controls, comparison.until)
        right.set_ylim(*limits)
        right.set_title(title)
        right.legend(loc="lower right", ncols=2)
        kicks = " and ".join(f"{float(control(0.0)):.1f} ({label[1]})" for label, control in controls.items())
        right.annotate(
            f"cut off: the kick at $t = 0$ reaches {kicks}",
            xy=(0.0, 1.0), xycoords="axes fraction", xytext=(14.0, -12.0), textcoords="offset points",
            arrowprops={"arrowstyle": "->", "color": "0.4"}, va="center", fontsize=9.5,
        )  # fmt: skip
    for axes in grid[-1]:
        axes.set_xlabel("time $t$")
