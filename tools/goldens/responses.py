"""Responses and metrics: the finite dead-time series early, the sum of residues at the poles late."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import mpmath as mp
import numpy as np
from case import Case, bracketed_root, evaluate
from poles import Pole, functions

POINTS = 48
MOST_ZEROS = 60
ENOUGH = 46  # exp(-46) = 1e-20: what the poles that are left out contribute from then on


class Output:
    """The output after a unit step of the set-point ("F") or of the load at the plant input ("G")."""

    def __init__(self, case: Case, poles: list[Pole], kind: str) -> None:
        self.case = case
        self.poles = poles
        self.kind = kind

    @cached_property
    def late(self) -> float:
        """From here on the poles in the list say everything."""
        if not self.case.dead_time:
            return 0.0
        return float(max(ENOUGH / -self.poles[-1].value.real, 3 * self.case.dead_time))

    @cached_property
    def final(self) -> mp.mpf:
        """The value at rest."""
        poly = self.case.polynomials
        return poly[self.kind][-1] / (poly["A"][-1] + poly["B"][-1])

    def __call__(self, t: float | mp.mpf, integrals: int = 0) -> mp.mpf:
        """Return the value, or with ``integrals=1`` the integral of ``y - final`` from 0 (load: of y)."""
        if t >= self.late:
            value = mp.fsum(
                mp.fsum(2 * mp.re(w * mp.exp(s * t) / s ** max(integrals, -1)) for s, w in self._nodes(index))
                for index in range(len(self.poles))
            )
            return value + (self.final if integrals == 0 else self.total if integrals == 1 else 0)
        value = self.early(mp.mpf(t), integrals)
        return value - self.final * t if integrals == 1 else value

    def early(self, t: mp.mpf, integrals: int = 0) -> mp.mpf:
        """Return the value by the dead-time series, of which only the terms that have started count.

        Its terms are inverted all at once on a circle around the open-loop poles; where these are real and far apart, a
        circle is too large, and each is inverted on Talbot's contour.
        """
        if not self.case.record.get("far_apart"):
            signal = "y" if self.kind == "F" else "load_y"
            return self.case.reference(t, signal, integrals=integrals)
        poly, delay = self.case.polynomials, mp.mpf(self.case.dead_time)
        total = mp.mpf(0)
        for n in range(int(t / delay) if t > delay else 0):
            left = t - (n + 1) * delay
            if left > 0:
                total += mp.invertlaplace(
                    lambda s, n=n: (
                        evaluate(poly[self.kind], s)
                        / evaluate(poly["A"], s)
                        * (-evaluate(poly["B"], s) / evaluate(poly["A"], s)) ** n
                        / s ** (1 + integrals)
                    ),
                    left,
                    method="talbot",
                    degree=40,
                )
        return total

    @cached_property
    def total(self) -> mp.mpf:
        """The integral of y - final over all time: -(the derivative of (Y s - final)/s's numerator at 0)."""
        poly = self.case.polynomials
        delay = mp.mpf(self.case.dead_time)

        def closed(s: mp.mpc) -> mp.mpc:
            late = mp.exp(-s * delay)
            return evaluate(poly[self.kind], s) * late / (evaluate(poly["A"], s) + evaluate(poly["B"], s) * late)

        radius = min(abs(pole.value) for pole in self.poles) / 4
        points = [radius * mp.expjpi(2 * mp.mpf(j) / 128) for j in range(128)]
        return mp.re(mp.fsum(closed(s) / s for s in points) / 128)

    def _nodes(self, index: int) -> list[tuple[mp.mpc, mp.mpc]]:
        return self._all_nodes[index]

    @cached_property
    def _all_nodes(self) -> list[list[tuple[mp.mpc, mp.mpc]]]:
        """Return (s, weight) such that the sum of 2 Re(weight e^{st}) is the residue of a pole and its conjugate."""
        f, slope = functions(self.case)
        top, delay = self.case.polynomials[self.kind], mp.mpf(self.case.dead_time)
        found = []
        for pole in self.poles:
            p = pole.value
            half = mp.mpf(1) / 2 if not p.imag else 1
            if pole.multiplicity == 1:
                found.append([(p, half * evaluate(top, p) * mp.exp(-p * delay) / (p * slope(p)))])
                continue
            radius = abs(p) / 1000
            ring = []
            for j in range(POINTS):
                turn = mp.expjpi(2 * mp.mpf(j) / POINTS)
                s = p + radius * turn
                ring.append((s, half * evaluate(top, s) * mp.exp(-s * delay) / (s * f(s)) * radius * turn / POINTS))
            found.append(ring)
        return found

    # ---- where things happen ----------------------------------------------------------------------------------------

    @cached_property
    def samples(self) -> tuple[np.ndarray, np.ndarray]:
        """Return times dense enough to see every extremum and crossing, and the deviation from the final value."""
        visible = [
            pole.value for pole, nodes in zip(self.poles, self._all_nodes, strict=True) if abs(nodes[0][1]) > 1e-25
        ]
        slow = float(-max(p.real for p in visible))
        ring = max([float(p.imag) for p in visible if -p.real < 2 * slow], default=0.0)
        delay = self.case.dead_time
        step = min([0.25 / slow, *([0.5 / ring] if ring else [])])
        early = delay + max(self.late - delay, 0.0) * np.linspace(0.0, 1.0, 60) ** 1.5
        start = delay + np.geomspace(1e-3 * step, step, 12)
        breaks = delay * np.arange(1, 8)
        t = np.unique(np.concatenate([early, start, breaks, delay + np.arange(1, int(40.0 / slow / step)) * step]))
        late = t >= self.late
        before = [float(self(mp.mpf(float(x))) - self.final) for x in t[~late]]
        return t, np.concatenate([before, self._late_samples(t[late])])

    def _late_samples(self, t: np.ndarray) -> np.ndarray:
        if any(pole.multiplicity > 1 for pole in self.poles):  # the ring of a multiple pole cancels digits
            return np.array([float(self(mp.mpf(float(x))) - self.final) for x in t])
        s, weights = (np.array([complex(pair[i]) for (pair,) in self._all_nodes]) for i in (0, 1))
        return np.array(2.0 * (np.exp(np.outer(t, s)) @ weights).real)

    def extreme(self, sign: int) -> tuple[mp.mpf, mp.mpf] | None:
        """Return value and time of the largest (sign 1) or smallest (-1) stationary value, if there is one."""
        t, y = self.samples
        inner = np.nonzero((sign * y[1:-1] > sign * y[:-2]) & (sign * y[1:-1] >= sign * y[2:]))[0] + 1
        if not inner.size:
            return None
        i = max(inner, key=lambda j: sign * y[j])
        for n in range(2, 8):  # a plateau that ends in a kink at a multiple of the dead time
            kink = n * mp.mpf(self.case.dead_time)
            if 0 < kink < t[-1] and sign * (self(kink) - self.final) >= sign * y[i] and self._is_kink(kink):
                return self(kink), kink
        for j in sorted(inner, key=lambda j: -sign * y[j])[:8]:
            slopes = [self(mp.mpf(x), -1) for x in (t[j - 1], t[j + 1])]
            if slopes[0] * slopes[1] < 0:  # else the samples turn by rounding only
                at = bracketed_root(lambda x: self(x, -1), t[j - 1], t[j + 1])
                return self(at), at
        return None

    def _is_kink(self, at: mp.mpf) -> bool:
        before, after = (self(at * (1 + e * mp.mpf(10) ** -9), -1) for e in (-1, 1))
        return before * after < 0

    def first_reach(self, level: mp.mpf) -> mp.mpf:
        """Return when the response first reaches a level, coming from zero."""
        t, y = self.samples
        sign = 1 if self.final > 0 else -1
        beyond = np.nonzero(sign * y >= sign * float(level - self.final))[0][0]
        return bracketed_root(lambda x: self(x) - level, t[beyond - 1], t[beyond])

    def last_exit(self, band: float) -> mp.mpf:
        """Return when the response is last further from its final value than a fraction of it."""
        t, y = self.samples
        width = mp.mpf(band) * abs(self.final)
        outside = np.nonzero(np.abs(y) > float(width))[0][-1]
        level = self.final + width if y[outside] > 0 else self.final - width
        return bracketed_root(lambda x: self(x) - level, t[outside], t[outside + 1])

    def absolute_area(self) -> mp.mpf | None:
        """Return the integral of |y - final| over all time; None if too many zeros would have to be found."""
        t, error = self.samples
        clear = np.abs(error) > 1e-17 * np.abs(error).max()
        last = np.nonzero(clear)[0][-1]
        changes = [i for i in range(1, last) if error[i] * error[i + 1] < 0]
        if len(changes) > MOST_ZEROS:
            return None

        def deviation(x: mp.mpf) -> mp.mpf:
            return self(mp.mpf(x)) - self.final

        # what changes sign in doubles only is rounding
        zeros = [
            bracketed_root(deviation, t[i], t[i + 1]) for i in changes if deviation(t[i]) * deviation(t[i + 1]) < 0
        ]
        levels = [mp.mpf(0), *(self(z, 1) for z in zeros), self.total]
        return mp.fsum(abs(b - a) for a, b in pairwise(levels))


def metrics(case: Case, poles: list[Pole]) -> dict[str, mp.mpf | None]:
    """Return the metrics of the set-point and the load response (a loop whose output does not jump)."""
    y, d = Output(case, poles, "F"), Output(case, poles, "G")
    peak = y.extreme(1 if y.final > 0 else -1)
    over = peak is not None and abs(peak[0]) > abs(y.final) * (1 + mp.mpf(10) ** -13)
    load = max((e for e in (d.extreme(1), d.extreme(-1)) if e is not None), key=lambda e: abs(e[0]), default=None)
    return {
        "overshoot": peak[0] / y.final - 1 if over and peak else mp.mpf(0),
        "peak_time": peak[1] if over and peak else None,
        "rise_time": y.first_reach(y.final * mp.mpf(0.9)) - y.first_reach(y.final * mp.mpf(0.1)),
        "settling_time": y.last_exit(0.02),
        "load_peak": load[0] if load else None,
        "load_peak_time": load[1] if load else None,
        "load_ie": d.total,
        "load_iae": d.absolute_area(),
    }
