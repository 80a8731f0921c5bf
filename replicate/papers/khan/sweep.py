r"""Exact overshoot and rise time under proportional control, for many gains at once, time scaled to h = 1.

The loop of Figure 2 then has two parameters, the normalised dead time ph and the gain Kh:
:math:`\dot y(t) = -ph\,y(t) + Kh\,[1 - y(t-1)]`, with final value Kh/(Kh + ph). All gains of one ph are one sweep of
`replicate.loops`; only the first peak, where a later one may be higher, is looked for here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import lambertw

from replicate.loops import PI, Loop, Plant
from replicate.loops import sweep as sweep_of_loops
from replicate.loops.time_domain.responses import responses
from replicate.papers.khan.peaks import ROUNDING, Responses

Array = NDArray[np.float64]

HORIZON = 30.0  # dead times; the highest peak comes long before, which `sweep` checks
ENOUGH = 20.0  # for gains up to 0.99 of the stability limit

# The dense grid: finer in ph where the curves change most, with the edges of the paper's cases on it.
PH = np.round(np.concatenate([np.arange(0.0, 0.5, 0.025), np.arange(0.5, 3.0, 0.05), np.arange(3.0, 10.1, 0.2)]), 3)
SHARES = np.arange(1, 100) / 100.0  # of the stability limit


@dataclass(frozen=True)
class Sweep:
    """Stable loops; every array has shape (loops,).

    Attributes
    ----------
    ph, kh
        Normalised dead time and gain.
    overshoot
        Largest value of the output beyond its final value, in per cent of that: the paper's definition.
    rise_time
        From 10 % to 90 % of the final value, in dead times.
    share
        The gain as a fraction of the stability limit.
    peak_time
        When the output is highest, in dead times; of no meaning without overshoot.
    """

    ph: Array
    kh: Array
    overshoot: Array
    rise_time: Array
    share: Array
    peak_time: Array

    @cached_property
    def first_peak(self) -> Array:
        """The overshoot of the first local maximum; close to the stability limit a later peak can be higher."""
        found = np.zeros_like(self.kh)
        for ph in np.unique(self.ph):
            mine = (self.ph == ph) & (self.overshoot > 0.0)
            if mine.any():
                until = np.ceil(self.peak_time[mine].max()) + 1.0  # the first peak is no later than the highest
                found[mine] = first_peak(float(ph), self.kh[mine], min(float(until), HORIZON))
        return found

    def where(self, mask: NDArray[np.bool_]) -> Sweep:
        """Return the loops that the mask selects."""
        return Sweep(*(part[mask] for part in self.parts()))

    def parts(self) -> tuple[Array, ...]:
        """Return all arrays in the order of the fields."""
        return self.ph, self.kh, self.overshoot, self.rise_time, self.share, self.peak_time


@cache
def stability_limit(ph: float) -> float:
    """Return the largest stable Kh: cos w = -ph/Kh, sin w = w/Kh with w in (0, pi)."""
    if ph == 0.0:
        return 0.5 * np.pi
    w = brentq(lambda w: w * np.cos(w) + ph * np.sin(w), 0.5 * np.pi, np.pi, xtol=1e-300, rtol=8.9e-16)
    return float(np.hypot(w, ph))


def sweep(ph: float, kh: Array, horizon: float = HORIZON) -> Sweep:
    """Return exact overshoot and rise time of loops with one ph, as seen over at least a horizon in dead times.

    Raises
    ------
    ValueError
        If a gain is not in (0, stability limit), or the highest peak comes late in the horizon.
    """
    kh = _stable(ph, kh)
    # below the breakpoint one real pole, s = W(-Kh e^ph) - ph, may be slow: the horizon must still hold the rise
    slow = kh < np.exp(-1.0 - ph)
    decay = ph - lambertw(-kh[slow] * np.exp(ph)).real
    until = float(np.ceil(max(horizon, 2.0 + 3.5 / decay.min(initial=1.0))))
    gains = np.column_stack([kh, np.zeros_like(kh)])
    found = sweep_of_loops(_plant(ph), gains, ("overshoot", "peak_time", "rise_time"), until)
    highest, at, rise_time = (found[name][0] for name in found.metrics)
    _require_early(ph, highest, at, until)
    return Sweep(np.full(kh.size, ph), kh, 100.0 * highest, rise_time, kh / stability_limit(ph), at)


def overshoot(ph: float, kh: float) -> float:
    """Return the overshoot of one loop, in per cent of the final value, without the rest that `sweep` returns."""
    y = Loop(_plant(ph), PI(kh)).step(until=HORIZON)
    found = y.overshoot()
    _require_early(ph, np.array(found), np.array(y.peak().time), HORIZON)
    return 100.0 * found


def _require_early(ph: float, excess: Array, at: Array, until: float) -> None:
    if np.any((excess > 0.001) & (at > 0.7 * until)):
        msg = f"ph = {ph:g}: the highest peak comes late; {until:g} dead times are too few"
        raise ValueError(msg)


def first_peak(ph: float, kh: Array, until: float = HORIZON) -> Array:
    """Return how far the first local maximum exceeds the final value, in per cent of that; 0 where it does not.

    Parameters
    ----------
    until
        A whole number of dead times, by which there has been a maximum, if there is one.

    Raises
    ------
    ValueError
        If a gain is not in (0, stability limit).
    """
    kh = _stable(ph, kh)
    found = responses(_plant(ph), [PI(float(k)) for k in kh], until, setpoint=1.0, load=0.0)
    length = float(found[0][0][1])  # all pieces are equal: the horizon is a whole number of dead times
    final = kh / (kh + ph)
    excess = Responses(np.array([y for _, y, _ in found]), length, final).first_maximum() / final - 1.0
    return np.where(excess > ROUNDING, 100.0 * excess, 0.0)


def _plant(ph: float) -> Plant:
    return Plant([1.0], [1.0, ph], dead_time=1.0)


def _stable(ph: float, kh: Array) -> Array:
    """Return gains that are all inside the stability limit."""
    kh = np.asarray(kh, dtype=float)
    limit = stability_limit(ph)
    if not np.all((kh > 0.0) & (kh < limit)):
        msg = f"ph = {ph:g}: stable gains are 0 < Kh < {limit:.6g}, not {kh.min():.6g} to {kh.max():.6g}"
        raise ValueError(msg)
    return kh


@cache
def dense() -> Sweep:
    """Return the dense grid of more than 10,000 stable loops, 0 <= ph <= 10, up to 0.99 of the stability limit."""
    parts = [sweep(float(ph), SHARES * stability_limit(float(ph)), ENOUGH).parts() for ph in PH]
    return Sweep(*(np.concatenate(column) for column in zip(*parts, strict=True)))
