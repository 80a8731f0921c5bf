r"""A map of the feasible PID gains: where over the plane (k, kd) the largest feasible ki has its local maxima.

For fixed k and kd every constraint of `replicate.loops.design.nyquist_constraints` is a quadratic in ki at each
frequency, so it forbids one interval of ki, or all but one. What is left over all frequencies are gaps; inside a
connected gap stability cannot change, because the point -1 lies inside the circle. The local maxima of the gaps' upper
ends are where a search for the largest ki has to start: a start that is not chosen this way may end on a ridge far
below the optimum.

The map is coarse on purpose. It says where to look; what is found from there is polished and verified elsewhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops.design.circles import Circle
from replicate.loops.design.nyquist_constraints import Kind, LoopJet
from replicate.loops.numerics.gaps import Gaps

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# k and kd of the map, in units of a gain and of that gain over a frequency
GAINS = np.concatenate([[-1.0, -0.3, -0.1, -0.03, 0.0], np.geomspace(0.01, 0.3, 6), np.geomspace(0.4, 30.0, 16)])
DERIVATIVES = np.concatenate([[-0.3, -0.1, 0.0], np.geomspace(0.03, 0.3, 4), np.geomspace(0.42, 60.0, 16)])
EDGE = 1.0 - 1e-9
NO_GAP = 1e-9  # relative width below which a gap is none
TOGETHER = 7  # proportional gains looked at together
FREQUENCIES = 160  # of each constraint, on the map

ZOOM = np.linspace(-1.0, 1.0, 7)  # the window of an ascent, in units of its half-width
WIDEST, NARROWEST = 0.3, 1e-5  # half-width of the window, relative to the gains
MOST_WINDOWS = 80


@dataclass(frozen=True)
class Summit:
    """A local maximum of the map: the gains at the upper end of a gap, a ki inside it, and the scale of k and kd."""

    k: float
    ki: float
    kd: float
    inside: float
    reach: tuple[float, float]

    @property
    def gains(self) -> Array:
        """The gains as an array (k, ki, kd)."""
        return np.array([self.k, self.ki, self.kd])

    def on_edge(self, largest_kd: float) -> bool:
        """Whether the summit lies on the outer edge of its map, beyond which the ground may rise."""
        k, kd = self.k / self.reach[0], self.kd / self.reach[1]
        return bool(k >= EDGE * GAINS[-1] or (kd >= EDGE * DERIVATIVES[-1] and self.kd < EDGE * largest_kd))


def summits(
    jets: Sequence[tuple[Kind, LoopJet]],
    circle: Circle,
    gain: float,
    frequency: float,
    largest_kd: float = np.inf,
    density: int = 1,
) -> list[Summit]:
    """Return the local maxima of ki over (k, kd), largest ki first; stability is not looked at.

    Parameters
    ----------
    jets
        The constraints with the basis of L at the frequencies on which they are asked for.
    gain, frequency
        Scale of the map: a gain of the size of k, and the frequency that turns it into a derivative gain.
    largest_kd
        Bound on the size of kd.
    density
        Number of gains in place of each one of the coarsest map.
    """
    k, kd = gain * _denser(GAINS, density), gain / frequency * _denser(DERIVATIVES, density)
    kd = np.unique(np.clip(kd, -largest_kd, largest_kd))
    gaps = _gaps([_Quadratics.of(kind, _thinned(jet), circle) for kind, jet in jets], k, kd)
    found = [
        Summit(float(k[i]), gap.top, float(kd[j]), 0.5 * (gap.bottom + gap.top), (gain, gain / frequency))
        for (i, j), gap, _ in gaps.maxima()
    ]
    return sorted(found, key=lambda s: -s.ki)


def _denser(values: Array, density: int) -> Array:
    steps = np.arange(0.0, values.size - 1.0 + 0.5 / density, 1.0 / density)
    return np.asarray(np.interp(steps, np.arange(values.size), values))


def ascend(
    jets: Sequence[tuple[Kind, LoopJet]], circle: Circle, start: Summit, slack: float, largest_kd: float = np.inf
) -> Summit:
    """Follow a gap uphill from a summit with windows of the map that shrink where they find nothing higher.

    Slow but safe: every step stays between the constraints, where a method that follows gradients may leap over them.

    Parameters
    ----------
    slack
        Relative distance that is kept from the constraints; more than they can dip between the frequencies of ``jets``.
    """
    quadratics = [_Quadratics.of(kind, jet, circle, slack) for kind, jet in jets]
    best, width = start, WIDEST
    for _ in range(MOST_WINDOWS):
        if width <= NARROWEST:
            break
        k = best.k + width * max(abs(best.k), 0.1 * start.reach[0]) * ZOOM
        kd = best.kd + width * max(abs(best.kd), 0.1 * start.reach[1]) * ZOOM
        kd = np.clip(kd, -largest_kd, largest_kd)
        connected = [
            Summit(float(k[i]), gap.top, float(kd[j]), 0.5 * (max(gap.bottom, 0.5 * gap.top) + gap.top), start.reach)
            for (i, j), gap in _gaps(quadratics, k, kd)
            if gap.bottom < best.inside < gap.top
        ]
        highest = max(connected, key=lambda s: s.ki, default=best)
        if highest.ki > best.ki * (1.0 + 0.02 * width):
            best = highest
        else:
            width *= 0.5
    return best


def _thinned(jet: LoopJet) -> LoopJet:
    step = max(1, jet.w.size // FREQUENCIES)
    return LoopJet(jet.w[::step], jet.phi[:, :, ::step])


def _gaps(quadratics: Sequence[_Quadratics], k: Array, kd: Array) -> Gaps:
    """Return the gaps of ki at the indices (i, j) of k and kd."""
    parts = (_forbidden(quadratics, k[i : i + TOGETHER], kd) for i in range(0, k.size, TOGETHER))
    return Gaps.between(parts, rounding=NO_GAP)


@dataclass(frozen=True)
class _Quadratics:
    """A constraint a ki^2 + b ki + c >= 0 at n frequencies: a (n,), and what b (3, n) and c (6, n) are made of.

    b is linear in (1, k, kd), and c in (1, k, kd, k^2, k kd, kd^2).
    """

    a: Array
    b: Array
    c: Array

    @classmethod
    def of(cls, kind: Kind, jet: LoopJet, circle: Circle, slack: float = 0.0) -> _Quadratics:
        """Return a constraint's quadratics from its matrices, where it has to keep a distance ``slack`` from zero."""
        form = jet.forms(kind, circle)[0]
        if slack and kind == "sensitivity":
            form[0, 0] -= circle.radius**2 * slack
        elif slack:
            steep = jet.phi[1 if kind == "phase" else 2, ::2]
            form[1::2, 1::2] -= slack * jet.w * (np.conj(steep)[:, None] * steep).real
        one, k, ki, kd = form
        b = 2.0 * np.stack([one[2], k[2], kd[2]])
        c = np.stack([one[0], 2.0 * one[1], 2.0 * one[3], k[1], 2.0 * k[3], kd[3]])
        return cls(ki[2], b, c)

    def roots(self, terms: Array) -> tuple[NDArray[np.intp], Array, Array, NDArray[np.bool_]]:
        """Return the frequencies that may forbid a ki > 0, the lower and the upper root there, and where they are real.

        ``terms`` has the six terms of c. With a > 0, b >= 0 and c >= 0 no root is positive: on a fine grid that is so
        at most frequencies, whatever the gains.
        """
        b, c = terms[:, :3] @ self.b, terms @ self.c
        may = np.nonzero(~(self.a > 0.0) | ((b < 0.0) | (c < 0.0)).any(axis=0))[0]
        a, b, c = self.a[may], b.take(may, axis=1), c.take(may, axis=1)
        discriminant = b * b
        discriminant -= 4.0 * a * c
        real = discriminant > 0.0
        with np.errstate(all="ignore"):
            q = -0.5 * (b + np.copysign(np.sqrt(discriminant), b))
            first, second = q / a, c / q
        return may, np.fmin(first, second), np.fmax(first, second), real


def _forbidden(quadratics: Sequence[_Quadratics], k: Array, kd: Array) -> tuple[Array, Array, NDArray[np.intp]]:
    """Return lower and upper ends of the forbidden intervals of ki > 0, shape (len(k), len(kd), intervals)."""
    both = np.repeat(k, kd.size), np.tile(kd, k.size)
    terms = np.stack([np.ones(both[0].size), *both, both[0] ** 2, both[0] * both[1], both[1] ** 2], axis=1)
    low, high, names = [], [], []
    first = 0
    for quadratic in quadratics:
        may, left, right, real = quadratic.roots(terms)
        # a > 0: forbidden between the roots
        up = quadratic.a[may] > 0.0
        kinds = 1 if up.all() else 3
        names += [first + kind * quadratic.a.size + may for kind in range(kinds)]
        first += kinds * quadratic.a.size
        low.append(np.where(up & real & (right > 0.0), left, np.inf))
        high.append(np.where(up & real, right, -np.inf))
        if kinds > 1:  # a < 0: below the lower and above the upper one, or everywhere
            low += [np.where(up, np.inf, np.zeros_like(left)), np.where(real & ~up, np.maximum(right, 0.0), np.inf)]
            high += [np.where(up, -np.inf, np.where(real, left, np.inf)), np.where(real & ~up, np.inf, -np.inf)]
    shape = (k.size, kd.size, -1)
    lows, highs = np.concatenate(low, axis=1), np.concatenate(high, axis=1)
    seen = np.nonzero(lows.min(axis=0) < np.inf)[0]
    return lows[:, seen].reshape(shape), highs[:, seen].reshape(shape), np.concatenate(names)[seen]
