r"""What is certain of all loops whose gains lie in a box: bounds on error integrals and peaks, where no peak is.

A controller's transfer function is linear in k, ki, kd, and so is the loop transfer function. Two statements hold for
every point of a box of gains, with no search.

*Error integrals.* Let y be the response to a load step for the gains in the middle of the box, and
:math:`\Delta C = \Delta k + \Delta k_i/s + \Delta k_d s` what is added to the controller. The response for the new
gains satisfies :math:`y' = y - h * y'` with :math:`h` the impulse response of :math:`P S F \Delta C`, a property of the
middle loop. So with :math:`\varepsilon = \|h\|_1 < 1` the loop is stable (small gain), and

.. math::

    \frac{\|y\|_1}{1 + \varepsilon} \le \|y'\|_1 \le \frac{\|y\|_1}{1 - \varepsilon}, \qquad
    \varepsilon \le |\Delta k| \, \|\dot y\|_1 + |\Delta k_i| \, \|y\|_1 + |\Delta k_d| \, \|\ddot y\|_1 ,

since y is the step response of :math:`P S`, and a measurement filter F of n equal lags makes none of the norms larger.
Where the lag is an interval as well, F becomes :math:`F (1 + E)` with
:math:`\|E\| \le \eta = (1 + 2 |\Delta T|/T)^n - 1`, and :math:`\varepsilon` becomes
:math:`\varepsilon (1 + \eta) + \eta \|P C S\|_1`.

*The peak of the sensitivity.* It is where :math:`|1 + L|^2` is smallest, so that the derivative
:math:`2 \operatorname{Re} \overline{(1 + L)} L'` vanishes. Where interval arithmetic shows that it does not, for all
gains of the box and all frequencies of an interval, the peak is not there. The complementary sensitivity has its peak
where :math:`|1 + 1/L|` is smallest.

References
----------
C. A. Desoer and M. Vidyasagar, *Feedback Systems: Input-Output Properties*, Academic Press, 1975, ch. III (small gain).
R. E. Moore, *Interval Analysis*, Prentice-Hall, 1966.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise, product

import numpy as np
from numpy.polynomial import chebyshev as cheb

from replicate.loops.bounds import intervals
from replicate.loops.bounds.axis_jets import AxisJet
from replicate.loops.bounds.intervals import Interval
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.time_domain.piecewise import Piecewise
from replicate.loops.time_domain.total_variation import total_variation

_OWN_ERROR = 1e-8  # relative, more than the error of a computed response and its integrals
_PARTS = 32  # of an interval of frequencies


NOTHING, _ONE = intervals.exactly(0.0), intervals.exactly(1.0)


@dataclass(frozen=True)
class GainBox:
    """All PID controllers with gains in three intervals.

    Attributes
    ----------
    k, ki, kd
        The gains of the parallel form.
    lag, order
        Time constant of the measurement filter, and how often it stands there; 0: no filter.
    """

    k: Interval
    ki: Interval
    kd: Interval = NOTHING
    lag: Interval = NOTHING
    order: int = 0

    @classmethod
    def of_times(
        cls, k: Interval, integral: Interval, derivative: Interval = NOTHING, lag: Interval = NOTHING, order: int = 0
    ) -> GainBox:
        """Return the smallest box that holds all controllers with gain, integral and derivative time in intervals."""
        return cls(k, k / integral, k * derivative, lag, order)

    @property
    def middle(self) -> PID:
        """The controller in the middle; its derivative acts on the set point, too."""
        filter_ = {"measurement_filter": self.lag.middle, "measurement_filter_order": self.order} if self.order else {}
        return PID(self.k.middle, self.ki.middle, self.kd.middle, b=1.0, c=1.0, **filter_)  # type: ignore[arg-type]


def iae_bounds(plant: Plant, box: GainBox) -> Interval:
    """Return an interval that holds the IAE of a unit load step for all controllers of a box.

    Parameters
    ----------
    plant
        Any plant; the load enters before it.
    box
        The controllers.

    Returns
    -------
    Interval
        From 0 to infinity where the box is too large to tell.

    Examples
    --------
    >>> plant = Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0])
    >>> found = iae_bounds(plant, GainBox(Interval(0.999, 1.001), Interval(0.499, 0.501), Interval(0.999, 1.001)))
    >>> found.high - found.low < 0.05, found.holds(Loop(plant, PID(1.0, 0.5, 1.0)).load_step().iae())
    (True, True)
    """
    norms = _norms(plant, box.middle, bent=box.kd != NOTHING)
    if norms is None:
        return Interval(0.0, np.inf)
    area, slope, bend, follows = norms
    other = (1.0 + 2.0 * box.lag.reach / box.lag.low) ** box.order - 1.0 if box.order else 0.0
    spread = box.k.reach * slope + box.ki.reach * area + box.kd.reach * bend
    spread = (spread * (1.0 + other) + other * follows) * (1.0 + _OWN_ERROR)
    high = area / (1.0 - spread) * (1.0 + _OWN_ERROR) if spread < 1.0 else np.inf
    return Interval(area / (1.0 + spread) * (1.0 - _OWN_ERROR) if spread < 1.0 else 0.0, high)


@lru_cache(maxsize=4096)
def _norms(plant: Plant, controller: PID, *, bent: bool) -> tuple[float, float, float, float] | None:
    """Return the integrals of ``|y|``, ``|y'|`` and ``|y''|`` of a load response, and the variation of a set-point one.

    ``None`` if the loop is unstable; of y'' only if asked for, else 0.
    """
    loop = Loop(plant, controller)
    try:
        y = loop.load_step()
        area = y.iae()
        follows = total_variation(loop.step()) if controller.measurement_filter else 0.0
    except LoopError:
        return None
    if not bent:
        return area, total_variation(y), 0.0, follows
    half = 0.5 * np.diff(y.breaks)[:, None]
    slope = Piecewise(y.breaks, np.asarray(cheb.chebder(y.coefficients, axis=1)) / half)
    return area, total_variation(y), total_variation(slope), follows


def sensitivity_at_least(plant: Plant, box: GainBox, frequency: float) -> float:
    """Return a number below which the sensitivity peak is for no controller of a box without filter.

    At one frequency 1 + L is linear in the gains, so that its distance from zero is largest at a corner of the box, and
    no peak is lower than the sensitivity there.

    Parameters
    ----------
    frequency
        Any; best one near the peaks, in radians per unit of time.

    Raises
    ------
    ValueError
        If the box has a filter.

    Examples
    --------
    >>> plant = Plant([1.0], [1.0, 3.0, 3.0, 1.0])
    >>> box = GainBox(Interval(0.861, 0.863), Interval(0.46, 0.462))
    >>> peak = Loop(plant, PID(0.862, 0.461)).sensitivity_peak()
    >>> 0.99 * peak.value < sensitivity_at_least(plant, box, peak.frequency) < peak.value
    True
    """
    if box.order:
        msg = "the box has a measurement filter; allowed: none"
        raise ValueError(msg)
    s = 1j * frequency
    sides = ((side.low, side.high) for side in (box.k, box.ki, box.kd))
    farthest = max(abs(1.0 + (k + ki / s + kd * s) * complex(plant(s))) for k, ki, kd in product(*sides))
    return (1.0 - _OWN_ERROR) / farthest


def complementary_at_least(plant: Plant, box: GainBox, frequency: float) -> float:
    """Return a number below which the peak of the complementary sensitivity is for no controller of a box.

    Parameters
    ----------
    frequency
        Any; best one near the peaks, in radians per unit of time. At rest T is 1 under integral action.

    Raises
    ------
    ValueError
        If the box has a filter.

    Examples
    --------
    >>> plant = Plant([1.0], [1.0, 3.0, 3.0, 1.0])
    >>> box = GainBox(Interval(0.861, 0.863), Interval(0.46, 0.462))
    >>> peak = Loop(plant, PID(0.862, 0.461)).complementary_peak()
    >>> 0.99 * peak.value < complementary_at_least(plant, box, peak.frequency) <= peak.value
    True
    """
    if not frequency:
        return 1.0 if box.ki.low > 0.0 else 0.0
    w = intervals.exactly(frequency)
    square = box.k.square() + (box.kd * w - box.ki / w).square()  # of |C|
    return (
        float(np.sqrt(square.low)) * abs(complex(plant(1j * frequency))) * sensitivity_at_least(plant, box, frequency)
    )


def no_peak_between(
    plant: Plant, box: GainBox, low: float, high: float, *, complementary: bool = False, parts: int = _PARTS
) -> bool:
    """Say whether, for all controllers of a box, the sensitivity certainly has no peak from `low` to `high`.

    Parameters
    ----------
    plant
        Rational times a dead time.
    low, high
        Frequencies, in radians per unit of time.
    complementary
        Whether the complementary sensitivity is meant.
    parts
        Of the interval of frequencies, each of which is judged by itself.

    Raises
    ------
    ValueError
        If the plant is of another kind.

    Examples
    --------
    >>> plant = Plant([1.0], [1.0, 3.0, 3.0, 1.0])
    >>> box = GainBox(Interval(0.861, 0.863), Interval(0.46, 0.462))
    >>> w0 = Loop(plant, PID(0.862, 0.461)).sensitivity_peak().frequency
    >>> no_peak_between(plant, box, 1.02 * w0, 1.03 * w0), no_peak_between(plant, box, 0.99 * w0, 1.01 * w0)
    (True, False)
    """
    if not plant.is_rational:
        msg = "the plant is not rational; allowed: numerator, denominator and a dead time"
        raise ValueError(msg)
    ends = np.linspace(low, high, parts + 1)
    return all(_keeps_sign(plant, box, Interval(float(a), float(b)), complementary) for a, b in pairwise(ends))


def _keeps_sign(plant: Plant, box: GainBox, w: Interval, complementary: bool) -> bool:
    """Say whether the derivative of ``|1 + L|^2`` (of ``|1 + 1/L|^2``) certainly does not vanish in an interval.

    With L = n/d it is -2 Im(a conj(b)) / |d|^4, a = n' d - n d', b = (n + d) d; for 1/L, where n and d are exchanged,
    b = (n + d) n, and a has the other sign. The imaginary part is bounded by its value at the middle of the box and
    its derivatives with respect to the gains and the lag, which loses less than intervals in their places do.
    """
    num, den = _exact(plant.num), [*_exact(plant.den), NOTHING]

    def denominator(lag: Interval) -> AxisJet:
        return AxisJet.polynomial(_lagged(den, lag, box.order), w)

    def numerator(*descending: Interval) -> AxisJet:
        found = AxisJet.polynomial(intervals.product(num, descending), w)
        return found.delayed(plant.dead_time, w) if plant.dead_time else found

    sides = (box.kd, box.k, box.ki)
    n = numerator(*(intervals.exactly(side.middle) for side in sides))
    d = denominator(intervals.exactly(box.lag.middle))
    found = n.wronskian(d).cross((n.value + d.value) * (n if complementary else d).value)
    n, d = numerator(*sides), denominator(box.lag) if box.order else d
    last, both = (n if complementary else d).value, n.value + d.value
    a, b = n.wronskian(d), both * last

    for side, power in ((box.ki, 0), (box.k, 1), (box.kd, 2)):
        dn = numerator(_ONE, *[NOTHING] * power)
        db = dn.value * (last + both if complementary else last)
        found += (dn.wronskian(d).cross(b) + a.cross(db)) * side.around
    if box.order:
        dd = AxisJet.polynomial(intervals.product(_lagged(den, box.lag, box.order - 1), (_ONE, NOTHING)), w)
        db = dd.value * (last if complementary else last + both)
        times = box.lag.around * intervals.exactly(float(box.order))
        found += (n.wronskian(dd).cross(b) + a.cross(db)) * times
    return not found.holds(0.0)


def _lagged(den: Sequence[Interval], lag: Interval, order: int) -> list[Interval]:
    """Return a denominator times (lag s + 1)^order."""
    found = list(den)
    for _ in range(order):
        found = intervals.product(found, [lag, _ONE])
    return found


def _exact(coefficients: Sequence[float] | np.ndarray) -> list[Interval]:
    return [intervals.exactly(float(c)) for c in coefficients]
