"""Draw loops on axes that the caller has made: responses, Nyquist, Bode, and the plane of the gains.

Every function draws on given matplotlib axes and returns them; nothing is saved or shown. matplotlib is imported only
here, and only when something is drawn. What is not matplotlib axes, a loop or a signal is refused with a LoopError that
names the argument.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.design.circles import Circle
from replicate.loops.design.gain_plane import GainPlane, gain_plane
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.time_domain.signal import Signal

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot_bode", "plot_gain_plane", "plot_load", "plot_nyquist", "plot_signal", "plot_step"]

Array = NDArray[np.float64]

POINTS = 800
LEVELS = (1.2, 1.4, 1.6, 2.0)


def plot_signal(ax: Axes, signal: Signal, label: str = "", *, until: float | None = None) -> Axes:
    """Draw a response with every kink and jump at its place.

    Parameters
    ----------
    ax
        Axes to draw on.
    signal
        The response.
    label
        Its name in a legend.
    until
        End of the time axis; by default the horizon.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from replicate.loops import PI
    >>> loop = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(0.5))  # L = e^{-s}/(2 s)
    >>> ax = plot_signal(Figure().add_subplot(), loop.load_step(until=2.0), "load")
    >>> ax.lines[0].get_label(), float(ax.lines[0].get_xdata()[-1])
    ('load', 2.0)
    """
    _check_axes(ax)
    checks.instance("the signal", signal, Signal, "a Signal")
    end = signal.horizon if until is None else min(checks.positive("until", until), signal.horizon)
    breaks = signal.breaks[(signal.breaks > 0.0) & (signal.breaks < end)]
    before = np.nextafter(breaks, -np.inf)  # the value on the left of a jump
    t = np.unique(np.concatenate([np.linspace(0.0, end, POINTS), breaks, before]))
    ax.plot(t, signal(t), label=label or None)
    ax.set_xlabel("t")
    return ax


def plot_step(ax: Axes, loop: Loop, label: str = "", *, until: float | None = None) -> Axes:
    """Draw the output after a unit step of the set-point, and the set-point as a thin line.

    Parameters
    ----------
    ax
        Axes to draw on.
    loop
        The loop.
    label
        Its name in a legend.
    until
        Horizon; by default until the loop has settled within 0.1 %.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from replicate.loops import PI
    >>> loop = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(0.5))  # L = e^{-s}/(2 s)
    >>> ax = plot_step(Figure().add_subplot(), loop, until=5.0)
    >>> len(ax.lines), ax.get_ylabel()  # the set-point, and the output
    (2, 'y')
    """
    _check(ax, loop)
    output = loop.step(until=until)
    ax.axhline(1.0, color="0.7", linewidth=0.8)
    return _plot_output(ax, output, label, until)


def plot_load(ax: Axes, loop: Loop, label: str = "", *, until: float | None = None) -> Axes:
    """Draw the output after a unit step of the load at the plant input.

    Parameters
    ----------
    ax
        Axes to draw on.
    loop
        The loop.
    label
        Its name in a legend.
    until
        Horizon; by default until the loop has settled within 0.1 %.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from replicate.loops import PI
    >>> loop = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(0.5))  # L = e^{-s}/(2 s)
    >>> ax = plot_load(Figure().add_subplot(), loop, until=5.0)
    >>> len(ax.lines), ax.get_xlabel()
    (1, 't')
    """
    _check(ax, loop)
    return _plot_output(ax, loop.load_step(until=until), label, until)


def _plot_output(ax: Axes, output: Signal, label: str, until: float | None) -> Axes:
    plot_signal(ax, _settled(output, until), label)
    ax.set_ylabel("y")
    return ax


def _settled(signal: Signal, until: float | None) -> Signal:
    """Return a response up to a little after it has settled, unless a horizon was asked for."""
    if until is not None:
        return signal
    largest = max(abs(signal.peak().value - signal.final), abs(signal.trough().value - signal.final))
    reference = abs(signal.final) or 1.0
    end = 1.1 * signal.settling_time(min(0.5, 1e-3 * largest / reference)) or signal.horizon
    mesh = np.array([0.0, min(end, signal.horizon)])
    return signal + Signal(mesh, np.zeros((1, 2)), final=0.0)


def plot_nyquist(ax: Axes, loop: Loop, label: str = "", *, ms: float | None = None) -> Axes:
    """Draw the Nyquist curve, the point -1, and the circle that the curve must stay outside for a given Ms.

    Parameters
    ----------
    ax
        Axes to draw on.
    loop
        The loop.
    label
        Its name in a legend.
    ms
        Bound on the sensitivity; by default the loop's own Ms, whose circle touches the curve.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from replicate.loops import PI
    >>> loop = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(0.5))  # L = e^{-s}/(2 s)
    >>> ax = plot_nyquist(Figure().add_subplot(), loop, "integrator", ms=2.0)
    >>> [line.get_label() for line in ax.lines[:2]]
    ['integrator', 'Ms = 2']
    """
    _check(ax, loop)
    bound = loop.sensitivity_peak().value if ms is None else 1.0 / Circle.of(ms=ms).radius
    value = loop.nyquist(_frequencies(loop))
    near = np.abs(value) < 4.0
    ax.plot(value.real[near], value.imag[near], label=label or None)
    if bound > 1.0:
        circle = Circle.of(ms=bound)
        angle = np.linspace(0.0, 2.0 * np.pi, 361)
        x, y = -circle.center + circle.radius * np.cos(angle), circle.radius * np.sin(angle)
        ax.plot(x, y, color="0.5", linestyle="--", linewidth=0.9, label=f"Ms = {bound:.3g}")
    ax.plot([-1.0], [0.0], marker="+", color="black", linestyle="none")
    ax.set_aspect("equal")
    ax.set_xlim(-2.5, 1.0)
    ax.set_ylim(-2.0, 1.0)
    ax.set_xlabel("Re L(iω)")
    ax.set_ylabel("Im L(iω)")
    return ax


def plot_bode(axes: Sequence[Axes], loop: Loop, label: str = "", *, w: ArrayLike | None = None) -> Sequence[Axes]:
    """Draw magnitude and phase of L, with the gain and phase margin as vertical lines at their crossovers.

    Parameters
    ----------
    axes
        Two axes: for the magnitude and for the phase in degrees.
    loop
        A stable loop.
    label
        Its name in a legend.
    w : array
        Frequencies; by default three decades about the crossovers.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from replicate.loops import PI
    >>> loop = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(0.5))  # L = e^{-s}/(2 s)
    >>> above, below = plot_bode(Figure().subplots(2), loop, w=[0.1, 0.5, 1.0])
    >>> above.lines[0].get_ydata().round(12).tolist()  # 1/(2 w)
    [5.0, 1.0, 0.5]
    """
    pair = checks.several("the axes of a Bode plot", axes, "two matplotlib axes")
    above, below = checks.exactly(2, "the axes of a Bode plot", pair, "two matplotlib axes")
    _check(above, loop)
    _check_axes(below)
    bode = loop.bode(_frequencies(loop) if w is None else w)
    above.loglog(bode.frequency, bode.magnitude, label=label or None)
    below.semilogx(bode.frequency, bode.phase, label=label or None)
    above.axhline(1.0, color="0.7", linewidth=0.8)
    below.axhline(-180.0, color="0.7", linewidth=0.8)
    margins = loop.margins()
    if np.isfinite(margins.phase_crossover) and margins.phase_crossover > 0.0:
        above.vlines(margins.phase_crossover, 1.0 / margins.gain, 1.0, color="C3", label=f"Am = {margins.gain:.3g}")
    if np.isfinite(margins.gain_crossover):
        phase = float(loop.bode([margins.gain_crossover]).phase[0])
        below.vlines(
            margins.gain_crossover, phase, phase - margins.phase, color="C3", label=f"φm = {margins.phase:.3g}°"
        )
    above.set_ylabel("|L(iω)|")
    below.set_ylabel("arg L(iω) / °")
    below.set_xlabel("ω")
    return axes


def _check(ax: Axes, loop: Loop) -> None:
    _check_axes(ax)
    checks.instance("the loop", loop, Loop, "a Loop")


def _check_axes(ax: Axes) -> None:
    from matplotlib.axes import Axes

    checks.instance("the axes to draw on", ax, Axes, "matplotlib axes")


def _frequencies(loop: Loop) -> Array:
    """Return frequencies about the peak of |S| and the crossovers, from a hundredth to thirty times of them."""
    margins = loop.margins()
    marks = [loop.sensitivity_peak().frequency, margins.phase_crossover, margins.gain_crossover]
    inside = [w for w in marks if np.isfinite(w) and w > 0.0] or [1.0 / (loop.plant.dead_time or 1.0)]
    return np.geomspace(0.01 * min(inside), 30.0 * max(inside), POINTS)


def plot_gain_plane(
    ax: Axes, plant: Plant, k: ArrayLike, ki: ArrayLike, *, levels: Sequence[float] = LEVELS
) -> GainPlane:
    """Draw the plane of the PI gains: the stable region, and in it the contours of constant Ms.

    Parameters
    ----------
    ax
        Axes to draw on, k to the right and ki upwards.
    plant
        The plant.
    k, ki : array
        Gains, ascending, on whose grid Ms is computed.
    levels
        Values of Ms to draw.

    Returns
    -------
    GainPlane
        What was drawn: the gains, and Ms at each of them, ``nan`` where the loop is unstable.

    Examples
    --------
    The gain alone is at the limit of stability at pi/2:

    >>> from matplotlib.figure import Figure
    >>> integrator = Plant([1.0], [1.0, 0.0], dead_time=1.0)
    >>> plane = plot_gain_plane(Figure().add_subplot(), integrator, k=[0.5, 1.5, 1.6], ki=[0.0, 0.01])
    >>> np.isnan(plane.ms[0]).tolist()
    [False, False, True]
    """
    _check_axes(ax)
    levels = [checks.positive("each level of Ms", level) for level in checks.several("levels", levels, "a list of Ms")]
    plane = gain_plane(plant, k, ki)
    stable = np.isfinite(plane.ms)
    ax.contourf(plane.k, plane.ki, stable.astype(float), levels=[0.5, 1.5], colors=["0.93"])
    known = plane.ms[stable]
    if known.size and any(known.min() < level < known.max() for level in levels):
        inside = np.where(stable, plane.ms, np.inf)
        lines = ax.contour(plane.k, plane.ki, np.minimum(inside, 10.0 * max(levels)), levels=sorted(levels))
        ax.clabel(lines, fmt="%.3g")
    ax.set_xlabel("k")
    ax.set_ylabel("ki")
    return plane
