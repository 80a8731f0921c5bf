"""How paper I draws: Nyquist curves with their circle, and an experiment with output above control signal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from replicate.loops import Circle, Loop, Signal

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STYLES = {1.4: "--", 1.6: "-.", 2.0: "-"}  # the paper: Ms = 1.4 dashed, 2.0 full
POINTS = 1200


def curve(axes: Axes, loop: Loop, w: np.ndarray, reach: float = 6.0, **style: Any) -> None:
    """Draw the Nyquist curve for w > 0, where it is within reach of the picture."""
    value = loop(1j * w)
    inside = np.abs(value) <= reach
    axes.plot(np.where(inside, value.real, np.nan), np.where(inside, value.imag, np.nan), **style)


def draw_circle(axes: Axes, circle: Circle, **style: Any) -> None:
    """Draw a circle that the Nyquist curve must not enter."""
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    defaults: dict[str, Any] = {"color": "0.55", "linewidth": 1.0, "linestyle": "-"}
    axes.plot(-circle.center + circle.radius * np.cos(angle), circle.radius * np.sin(angle), **{**defaults, **style})


def nyquist_axes(axes: Axes, window: tuple[float, float, float, float] = (-2.0, 1.0, -2.0, 1.0)) -> None:
    """Set window (left, right, bottom, top), mark the point -1, label the axes."""
    left, right, bottom, top = window
    axes.plot([-1.0], [0.0], marker="+", markersize=7.0, color="0.4", linestyle="none")
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    axes.set_aspect("equal")
    axes.set_xlabel("$\\mathrm{Re}\\,L$")
    axes.set_ylabel("$\\mathrm{Im}\\,L$")


def experiment(axes: Sequence[Axes], loop: Loop, until: float, load_at: float, load: float = 1.0, **style: Any) -> None:
    """Draw output and control signal: a set-point step at 0, a load step later; jumps are drawn as jumps."""
    response = loop.respond(load=load, load_at=load_at, until=until)
    for part, signal in zip(axes, (response.output, response.control), strict=False):
        times = _times(signal, until)
        part.plot(times, signal(times), **style)


def _times(signal: Signal, until: float) -> np.ndarray:
    """Return equally spaced times, and the two sides of every jump."""
    times = np.linspace(0.0, until, POINTS + 1)
    inner = signal.breaks[(signal.breaks > 0.0) & (signal.breaks < until)]
    before, after = inner * (1.0 - 1e-12), inner
    jumps = np.abs(signal(after) - signal(before)) > 1e-6
    return np.unique(np.concatenate([times, before[jumps], after[jumps]]))


def time_axes(axes: Sequence[Axes], until: float) -> None:
    """Label output above control signal over one time axis."""
    for part, name in zip(axes, ("$y$", "$u$"), strict=False):
        part.set_xlim(0.0, until)
        part.set_ylabel(name, rotation=0, labelpad=8)
    axes[0].axhline(1.0, color="0.55", linewidth=0.8)
    for part in axes[:-1]:
        part.tick_params(labelbottom=False)
    axes[-1].set_xlabel("time $t$")
