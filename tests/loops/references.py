"""Reference values for control loops with dead time, in mpmath, from formulas of their own.

Nothing here imports the package under test. `ReferenceLoop` sums the *finite* dead-time series: with the
rational loop transfer function ``Q = P C`` every signal is ``sum_n (-1)^n A Q^n e^{-(n+m) s L}``, only
the terms with ``(n + m) L <= t`` are not zero yet at time ``t``, and their sum is inverted by one contour
integral around the open-loop poles (trapezoidal rule on a circle). De Hoog inversion, the argument
principle for stability and quadrature by Parseval's theorem complete the set. ``test_references.py``
checks all of it against `closed_forms`.

Time is counted from the step and includes the dead time; frequencies are in rad per unit time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import NamedTuple

import mpmath as mp
import numpy as np

Transform = Callable[[mp.mpc], mp.mpc]

DIGITS = 40
_FEWEST = 12  # intervals on half of a circle


def _poly(coefficients: Iterable[float], s: mp.mpc) -> mp.mpc:
    # Horner's rule serves mpmath numbers and numpy arrays alike
    value = 0 * s
    for coefficient in coefficients:
        value = value * s + coefficient
    return value


def _exp(s: mp.mpc) -> mp.mpc:
    return np.exp(s) if isinstance(s, np.ndarray) else mp.exp(s)


# ------------------------------------------------------------------------------------------------------------
# the dead-time series, inverted on a circle around the open-loop poles


@dataclass(frozen=True)
class ReferenceLoop:
    """Plant ``num/den e^{-s L}`` under ``u = F r - C y``; set-point step or load step at the plant input.

    ``C = (k + ki/s + kd s/(1 + s derivative_filter)) / (1 + s measurement_filter)^order`` and
    ``F = (b k + ki/s + c kd s/(1 + s derivative_filter)) / (1 + s setpoint_filter)``.
    Coefficients are floats and are used as the exact binary numbers that they are.
    """

    num: tuple[float, ...]
    den: tuple[float, ...]
    dead_time: float
    k: float
    ki: float = 0.0
    kd: float = 0.0
    b: float = 1.0
    c: float = 0.0
    derivative_filter: float = 0.0
    measurement_filter: float = 0.0
    measurement_filter_order: int = 1
    setpoint_filter: float = 0.0

    def plant(self, s: mp.mpc) -> mp.mpc:
        """Rational part of the plant, without the dead time."""
        return _poly(self.num, s) / _poly(self.den, s)

    def controller(self, s: mp.mpc) -> mp.mpc:
        """Feedback controller, from the measurement to the control signal (without the minus sign)."""
        lag = (1 + s * self.measurement_filter) ** self.measurement_filter_order
        return (self.k + self._integral(s) + self._derivative(s)) / lag

    def feedforward(self, s: mp.mpc) -> mp.mpc:
        """From the set point to the control signal."""
        parts = self.b * mp.mpf(self.k) + self._integral(s) + self.c * self._derivative(s)
        return parts / (1 + s * self.setpoint_filter)

    def _integral(self, s: mp.mpc) -> mp.mpc:
        return self.ki / s if self.ki else 0

    def _derivative(self, s: mp.mpc) -> mp.mpc:
        return self.kd * s / (1 + s * self.derivative_filter)

    def loop_transfer(self, s: mp.mpc) -> mp.mpc:
        """``P C`` with the dead time."""
        return self.plant(s) * self.controller(s) * _exp(-s * self.dead_time)

    def transform(self, signal: str, integrals: int = 0) -> Transform:
        """Laplace transform of a signal of the closed loop, exact dead time."""
        return lambda s: (at := self._at(s)).first_term(signal, integrals) / (1 + at.loop_transfer)

    def __call__(self, t: float, signal: str = "y", *, integrals: int = 0, left: bool = False) -> mp.mpf:
        """Value at ``t`` of ``y`` or ``u`` (set-point step), ``load_y`` or ``load_u`` (load step).

        ``integrals`` integrates the signal that many times from 0; -1 differentiates it between its jumps.
        ``left`` takes the limit from the left where ``t`` is a multiple of the dead time; the value there is the
        limit from the right otherwise.
        """
        t = mp.mpf(t)
        if not self.dead_time:
            return _contour(self, signal, integrals, t)
        dead_time = mp.mpf(self.dead_time)
        delays = int(mp.ceil(t / dead_time)) - 1 if left else int(mp.floor(t / dead_time))
        terms = delays + 1 if signal == "u" else delays
        return _contour(self, signal, integrals, t, terms=terms) if terms > 0 else mp.mpf(0)

    def _at(self, s: mp.mpc) -> _Point:
        plant, controller, delay = self.plant(s), self.controller(s), mp.exp(-s * mp.mpf(self.dead_time))
        return _Point(s, plant * delay, controller, self.feedforward(s), plant * controller * delay)


class _Point(NamedTuple):
    """A value of ``s``, and what the transforms of all signals are made of there."""

    s: mp.mpc
    plant: mp.mpc
    controller: mp.mpc
    feedforward: mp.mpc
    loop_transfer: mp.mpc

    def first_term(self, signal: str, integrals: int) -> mp.mpc:
        """The signal before anything has gone around the loop."""
        first = {
            "y": lambda: self.plant * self.feedforward,
            "u": lambda: self.feedforward,
            "load_y": lambda: self.plant,
            "load_u": lambda: -self.loop_transfer,
        }[signal]()
        return first / self.s ** (1 + integrals) if integrals != -1 else first


@cache
def _circle(loop: ReferenceLoop, closed_loop: bool) -> tuple[mp.mpc, mp.mpf, mp.mpf]:
    """Centre of all poles, their largest distance from it, and the radius of a circle with room to spare.

    The roots that numpy finds are exact enough for that. The term with n delays falls like ``|s|^{-n relative
    degree}`` and grows like ``e^{(t - n L) s}``, so that least cancels where ``|s|`` is about the relative degree
    over the dead time.
    """
    open_loop, feedback = _polynomials(loop)
    lags = [lag for lag in (loop.derivative_filter, loop.measurement_filter, loop.setpoint_filter) if lag]
    poles = [0.0, *np.roots(open_loop), *(-1 / lag for lag in lags)]
    if closed_loop:
        poles += list(np.roots(np.polyadd(open_loop, feedback)))
    z = np.asarray(poles, complex)
    centre = (z.real.min() + z.real.max()) / 2
    reach = float(np.abs(z - centre).max())
    relative_degree = len(open_loop) - len(np.trim_zeros(feedback, "f"))
    room = max(0.5 * reach + 0.02, 0.7 * relative_degree / loop.dead_time if loop.dead_time else 0.0)
    return mp.mpf(centre), mp.mpf(reach), mp.mpf(reach + room)


def _polynomials(loop: ReferenceLoop) -> tuple[np.ndarray, np.ndarray]:
    """Return the polynomials D and N of the characteristic equation ``D + N e^{-sL} = 0``."""
    lag = np.array([loop.derivative_filter, 1.0]) if loop.derivative_filter else np.array([1.0])
    integral = np.array([1.0, 0.0]) if loop.ki else np.array([1.0])
    pid = np.polymul([loop.k, loop.ki] if loop.ki else [loop.k], lag)
    pid = np.polyadd(pid, np.polymul([loop.kd, 0.0], integral))
    open_loop = np.polymul(np.polymul(loop.den, integral), lag)
    if loop.measurement_filter:
        for _ in range(loop.measurement_filter_order):
            open_loop = np.polymul(open_loop, [loop.measurement_filter, 1.0])
    return open_loop, np.polymul(loop.num, pid)


@cache
def _nodes(loop: ReferenceLoop, closed_loop: bool, count: int, digits: int) -> list[tuple[_Point, mp.mpc]]:
    """Points on the upper half of the circle with their weights, shared by all signals and times of a loop.

    They are those that a trapezoidal rule of ``count`` intervals has and one of half as many has not.
    """
    centre, _, radius = _circle(loop, closed_loop)
    every, start = (1, 0) if count == _FEWEST else (2, 1)
    with mp.workdps(digits):
        arms = [(j, radius * mp.expjpi(mp.mpf(j) / count)) for j in range(start, count + 1, every)]
        return [(loop._at(centre + arm), arm / 2 if j in (0, count) else arm) for j, arm in arms]


@lru_cache(maxsize=100)
def _weighted(loop: ReferenceLoop, count: int, digits: int, t: mp.mpf, terms: int) -> list[tuple[_Point, mp.mpc]]:
    """Nodes, and what the first term of a signal times ``s`` is multiplied by there for its share of the integral."""
    found = []
    with mp.workdps(digits):
        for at, weight in _nodes(loop, not terms, count, digits):
            sum_of_terms = 1 - (-at.loop_transfer) ** terms if terms else 1  # over 1 + Q
            found.append((at, weight * mp.exp(at.s * t) * sum_of_terms / ((1 + at.loop_transfer) * at.s)))
    return found


def _contour(loop: ReferenceLoop, signal: str, integrals: int, t: mp.mpf, *, terms: int = 0) -> mp.mpf:
    """``1/(2 pi i)`` times the integral around the poles of a signal's transform times ``e^{st}``, by trapezia.

    The signal has gone around the loop less than ``terms`` times; without ``terms`` for ever, and the poles are those
    of the closed loop. The integrand is real on the real axis, so that half of the circle gives the whole integral. The
    error is squared by each doubling of the points, so a change of 1e-14 leaves an error far below it; this holds as
    soon as there are more points than the order of the poles and than ``radius t``.
    """
    _, reach, radius = _circle(loop, not terms)

    def parts(count: int, digits: int) -> Iterator[mp.mpf]:
        for at, factor in _weighted(loop, count, digits, t, terms):
            yield mp.re(at.first_term(signal, integrals - 1) * factor)

    largest = max(abs(part) for part in parts(_FEWEST, 15))
    digits = DIGITS + 10 * int(mp.log10(largest + 1) / 10)  # what cancels, in tens so that nodes are shared
    order = (terms + 1) * (len(_polynomials(loop)[0]) + 1)
    enough = 8 + 0.5 * max(float(radius * t), order * max(1.0, float(reach / (radius - reach))))
    count, total, value = _FEWEST, mp.mpf(0), mp.inf
    with mp.workdps(digits):
        while count < 50000:
            total += mp.fsum(parts(count, digits))
            change, value = abs(total / count - value), total / count
            if count >= 2 * enough and change <= mp.mpf(10) ** -14 * max(1, abs(value)):
                return +value
            count *= 2
    msg = f"the contour integral did not converge at t = {t}"
    raise ArithmeticError(msg)


# ------------------------------------------------------------------------------------------------------------
# poles and stability


def characteristic(loop: ReferenceLoop) -> Callable[[np.ndarray], np.ndarray]:
    """Return ``D + N e^{-sL}``, whose zeros are the closed-loop poles; for mpmath or numpy arguments."""
    open_loop, feedback = _polynomials(loop)
    return lambda s: _poly(open_loop, s) + _poly(feedback, s) * _exp(-s * loop.dead_time)


def zeros_right_of(function: Callable[[np.ndarray], np.ndarray], abscissa: float, radius: float = 300.0) -> int:
    """Count the zeros with ``abscissa < Re s`` and ``|s| < radius`` (argument principle).

    The contour's mesh is halved wherever the phase turns by more than half a radian between two points.
    """
    angle = float(np.arccos(abscissa / radius))

    def contour(x: np.ndarray) -> np.ndarray:
        # the arc from below to above for 0 <= x <= 1, then down the line for 1 <= x <= 2
        line = abscissa + 1j * radius * np.sin(angle) * (3 - 2 * x)
        return np.where(x < 1, radius * np.exp(1j * angle * (2 * x - 1)), line)

    # the line's mesh is dense around the real axis, so that no turn is skipped where poles crowd together
    fan = np.geomspace(1e-9, 0.5, 2000)
    x = np.unique(np.concatenate([np.linspace(0, 2, 4001), 1.5 + fan, 1.5 - fan]))
    for _ in range(40):
        values = function(contour(x))
        turns = np.angle(values[1:] / values[:-1])
        coarse = np.abs(turns) > 0.5
        if not coarse.any():
            return round(float(turns.sum()) / (2 * np.pi))
        x = np.sort(np.concatenate([x, (x[:-1][coarse] + x[1:][coarse]) / 2]))
    msg = "a zero lies on the contour"
    raise ArithmeticError(msg)


def polished_root(function: Transform, guess: complex) -> mp.mpc:
    """The root next to ``guess``, to 40 digits."""
    with mp.workdps(DIGITS):
        return mp.findroot(function, mp.mpc(guess))


# ------------------------------------------------------------------------------------------------------------
# frequency domain


def peak_modulus(
    function: Transform, low: float = 1e-4, high: float = 1e4, points: int = 20001
) -> tuple[mp.mpf, mp.mpf]:
    """Largest ``|function(i w)|`` and its frequency: a dense grid, then a root of the derivative."""
    grid = np.geomspace(low, high, points)
    best = int(np.argmax(np.abs(function(1j * grid))))
    with mp.workdps(DIGITS):

        def slope(w: mp.mpf) -> mp.mpf:
            return mp.diff(lambda x: abs(function(mp.mpc(0, x))) ** 2, w)

        w = crossing(slope, grid[best - 1], grid[best + 1])
        return abs(function(mp.mpc(0, w))), w


def crossing(function: Callable[[mp.mpf], mp.mpf], low: float, high: float) -> mp.mpf:
    """The root of a real function between two points where it has opposite signs, to 20 digits."""
    with mp.workdps(25):
        return mp.findroot(function, (mp.mpf(low), mp.mpf(high)), solver="anderson", tol=mp.mpf(10) ** -20)


def de_hoog(transform: Transform, t: float, degree: int = 60) -> mp.mpf:
    """Value at ``t`` of the inverse transform; for responses that are smooth (kinks ruin its convergence)."""
    with mp.workdps(DIGITS):
        return mp.invertlaplace(transform, mp.mpf(t), method="dehoog", degree=degree)


@cache
def _talbot(degree: int) -> list[tuple[mp.mpc, mp.mpc]]:
    """Nodes and weights of `talbot` for the time 1."""
    r = mp.mpf(2 * degree) / 5
    contour = [(mp.mpf(r), mp.exp(r) / 2)]
    for k in range(1, degree):
        angle = k * mp.pi / degree
        cot = mp.cot(angle)
        node = r * angle * mp.mpc(cot, 1)
        contour.append((node, mp.exp(node) * mp.mpc(1, angle * (1 + cot**2) - cot)))
    return [(node, mp.mpf(2) / 5 * weight) for node, weight in contour]


def talbot(transform: Transform, t: float, degree: int = 60) -> mp.mpf:
    """Value at ``t`` of the inverse transform on Talbot's contour (Abate and Valko 2004), to 0.6 ``degree`` digits.

    It is ``mp.invertlaplace`` of the same name and degree, but nodes and weights are shared by all times.
    """
    with mp.workdps(degree):
        t = mp.mpf(t)
        return mp.fsum(mp.re(weight * transform(node / t)) for node, weight in _talbot(degree)) / t


def bromwich(transform: Transform, t: float, top: float, depth: float = 90.0) -> mp.mpf:
    """Value at ``t`` by quadrature up the line Re s = 1/t and then to the left at Im s = ``top``.

    For ringing responses: de Hoog and Talbot, whose abscissas scale with 1/t, lose lightly damped poles at large t
    without any sign of it. ``top`` must lie above all poles that matter; exp(-depth) is neglected.
    """
    with mp.workdps(25):
        start, shift = mp.mpf(1) / t, mp.mpf(depth) / t
        periods = max(10, int(top * t / 6))

        def integrand(s: mp.mpc) -> mp.mpc:
            return transform(s) * mp.exp(s * t)

        up = mp.quadgl(lambda w: integrand(mp.mpc(start, w)) * 1j, mp.linspace(0, top, periods))
        left = mp.quadgl(lambda x: -integrand(mp.mpc(start - x, top)), mp.linspace(0, shift, 10))
        return mp.im(up + left) / mp.pi


def parseval(transform: Transform, breaks: Sequence[float]) -> mp.mpf:
    """Integral of the squared signal over all time, by quadrature of its transform along ``breaks``.

    The tail beyond the last break is left out: it is the caller's to bound.
    """
    with mp.workdps(20):
        return mp.quad(lambda w: abs(transform(mp.mpc(0, w))) ** 2, [mp.mpf(w) for w in breaks]) / mp.pi
