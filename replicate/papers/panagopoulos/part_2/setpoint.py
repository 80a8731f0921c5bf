r"""Set-point weight and set-point filter: formulas (13) to (16) of the supplement, as printed and put right.

All of them want :math:`|G_{sp}| = 1` at the frequency w_mp where :math:`|T|` has its peak M_p, with

.. math::

    |G_{sp}| = \frac{|k_i + i b k w|}{|k_i + i k w - k_d w^2|} \, |T| \, |F_{sp}|, \qquad A = k^2 w^2 + (k_i -
    w^2 k_d)^2.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf, sqrt

import numpy as np

from replicate.loops import PID, Loop
from replicate.papers.panagopoulos.part_2.load_experiment import loop_of
from replicate.papers.panagopoulos.part_2.processes import split

COARSE_GRID = np.logspace(-2.0, 2.0, 50)  # rad/s; 50 points is what Matlab's logspace(-2, 2) makes
GRIDS_TRIED = {
    "points of the grid": (50, 100, 200, 500),
    "its first decade": (-3, -2, -1),
    "its last decade": (1, 2, 3),
}


@dataclass(frozen=True)
class Resonance:
    """Where the complementary sensitivity has its peak: frequency w_mp and value M_p."""

    frequency: float
    value: float

    @classmethod
    def of(cls, loop: Loop) -> Resonance:
        """Return the peak of a loop, from the exact frequency response."""
        peak = loop.complementary_peak()
        return cls(peak.frequency, peak.value)

    @classmethod
    def on_coarse_grid(cls, loop: Loop) -> Resonance:
        """Return the largest |T| on `COARSE_GRID`."""
        return cls.on_grid(loop, COARSE_GRID)

    @classmethod
    def on_grid(cls, loop: Loop, frequencies: np.ndarray) -> Resonance:
        """Return the largest |T| on a grid."""
        value = loop(1j * frequencies)
        size = np.abs(value / (1.0 + value))
        i = int(np.argmax(size))
        return cls(float(frequencies[i]), float(size[i]))

    @property
    def at_rest(self) -> bool:
        """Whether the supremum of |T| is its value 1 at rest, so that there is nothing to bring down."""
        return self.frequency == 0.0 or self.value <= 1.0


def squared_denominator(c: PID, w: float) -> float:
    """Return A of (13)."""
    return (c.k * w) ** 2 + (c.ki - w**2 * c.kd) ** 2


def weight_from_peak(c: PID, peak: Resonance) -> float:
    """Return b of (13); without limit where the peak is at rest, since (13) is 0/0 there."""
    if peak.at_rest:
        return inf
    inside = squared_denominator(c, peak.frequency) - (c.ki * peak.value) ** 2
    return sqrt(inside) / (c.k * peak.frequency * peak.value) if inside > 0.0 else 0.0


def weight_limit(c: PID) -> float:
    """Return the limit (15) on b, as printed."""
    ratio = c.derivative_time / c.integral_time
    if ratio >= 0.25:
        return sqrt(ratio)
    return 2.0 * ratio / (1.0 - sqrt(1.0 - 4.0 * ratio)) if ratio > 0.0 else 1.0


def exact_weight_limit(c: PID) -> float:
    """Return the largest b that satisfies (14) at all frequencies; ``nan`` where none does.

    (14) is ``(b k w)^2 <= (k^2 - 2 ki kd) w^2 + kd^2 w^4``; for w -> 0 this asks for ``b^2 <= 1 - 2 Td/Ti``, which is
    enough for all w.
    """
    inside = 1.0 - 2.0 * c.derivative_time / c.integral_time
    return sqrt(inside) if inside >= 0.0 else float("nan")


def weight(c: PID, peak: Resonance) -> float:
    """Return the set-point weight of the text: (13), restricted by (15)."""
    return min(weight_from_peak(c, peak), weight_limit(c))


def filter_as_printed(c: PID, peak: Resonance) -> float:
    """Return T_sp of (16) as printed, over the square of w_mp; 0 where b of (13) does the work."""
    return filter_corrected(c, peak) / peak.frequency if filter_corrected(c, peak) else 0.0


def filter_corrected(c: PID, peak: Resonance) -> float:
    """Return T_sp that makes ``|F_sp G_sp| = 1`` at w_mp with b = 0: (16) over w_mp itself."""
    if weight_from_peak(c, peak) > 0.0:
        return 0.0
    excess = (c.ki * peak.value) ** 2 / squared_denominator(c, peak.frequency) - 1.0
    return sqrt(excess) / peak.frequency


def full_weight_filter_as_printed(c: PID, peak: Resonance) -> float:
    """Return T_sp for b = 1 as printed, PID case; 0 where the printed condition says so."""
    if peak.at_rest:
        return 0.0
    w, a = peak.frequency, squared_denominator(c, peak.frequency)
    inside = (c.ki**2 - (c.k * w) ** 2) * peak.value**2 - a
    return sqrt(inside) / (w * a**2) if inside > 0.0 else 0.0


def full_weight_filter_corrected(c: PID, peak: Resonance) -> float:
    """Return T_sp for b = 1 that makes ``|F_sp G_sp| = 1`` at w_mp."""
    if peak.at_rest:
        return 0.0
    w, a = peak.frequency, squared_denominator(c, peak.frequency)
    inside = (c.ki**2 + (c.k * w) ** 2) * peak.value**2 - a
    return sqrt(inside / a) / w if inside > 0.0 else 0.0


def setpoint_gain(c: PID, peak: Resonance, b: float, filter_time: float) -> float:
    """Return ``|F_sp G_sp|`` at w_mp; 1 at rest."""
    if peak.at_rest:
        return 1.0
    w = peak.frequency
    gain = hypot(c.ki, b * c.k * w) / sqrt(squared_denominator(c, w)) * peak.value
    return gain / hypot(1.0, w * filter_time)


def with_setpoint(row: str, controller: PID) -> PID:
    """Return a controller with the weight and, where the weight is zero, the filter that bring |G_sp| to one."""
    peak = Resonance.of(loop_of(split(row)[0], controller))
    return PID(
        controller.k,
        controller.ki,
        controller.kd,
        b=weight(controller, peak),
        setpoint_filter=filter_corrected(controller, peak),
    )
