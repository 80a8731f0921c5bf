r"""Where to look for the largest integral gain of a PI controller: local maxima over the proportional gain.

For a fixed k each frequency forbids an interval of ki, the chord of an ellipse. What is left are gaps; the maxima of
their upper ends over k are the candidates of `replicate.loops.design.design_pi`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops.design.circles import Circle
from replicate.loops.numerics.gaps import Gaps

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

GAIN_POINTS = 96
LINEAR = 0.01  # of the typical vertex: gains below it are spread evenly, larger ones by their logarithm,
FARTHEST = 1e8  # up to this many times as much
TOGETHER = 44  # gains looked at together
NO_GAP = 1e-12  # relative width below which a gap is none


@dataclass(frozen=True)
class Maximum:
    """The upper end ``ki`` of a gap at ``k`` that no connected gap exceeds; ``inside`` is a ki in the gap."""

    k: float
    ki: float
    inside: float
    frequency: float
    neighbours: tuple[float, ...]  # frequencies of the bounds at k and at the neighbouring gains
    open_end: tuple[float, float] | None  # (k, ki) in a connected gap without upper end: ki may grow on there


def local_maxima(value: ComplexArray, circle: Circle, w: Array) -> list[Maximum]:
    """Return the local maxima of ki over k for a plant's values at frequencies ``w``; stability is not looked at."""
    r, phase = np.abs(value), np.angle(value)
    c, s = circle.center * np.cos(phase), circle.center * np.sin(phase)
    gains = _gain_grid(np.concatenate([-c / r, (-c - circle.radius) / r, (-c + circle.radius) / r]), r)
    # the forbidden interval of ki at each (k, w): (r ki / w + C sin phi)^2 < R^2 - (r k + C cos phi)^2
    first, last = (-c - circle.radius) / r, (-c + circle.radius) / r  # gains that the ellipse of a frequency spans

    def forbidden(some: Array) -> tuple[Array, Array, NDArray[np.intp]]:
        seen = np.nonzero((first < some[-1]) & (last > some[0]))[0]
        across = some[:, None] * r[seen] + c[seen]
        return *_forbidden(across, s[seen], w[seen] / r[seen], circle.radius), seen

    parts = (forbidden(gains[i : i + TOGETHER]) for i in range(0, gains.size, TOGETHER))
    gaps = Gaps.between(parts, rounding=NO_GAP)
    found = []
    for (i,), gap, connected in gaps.maxima():
        middle = 0.5 * (max([gap.bottom, *(g.bottom for g in connected)]) + gap.top)
        neighbours = tuple(float(w[g.bound]) for g in (gap, *connected))
        opened = [j for j in (i - 1, i + 1) if 0 <= j < gains.size and gap.top > gaps.uppermost[j]]
        open_end = (float(gains[opened[-1]]), 2.0 * gap.top) if opened else None
        if i == gains.size - 1 and connected:  # the end of the gain grid is not a maximum either
            open_end = (float(gains[i]), middle)
        found.append(Maximum(float(gains[i]), gap.top, middle, float(w[gap.bound]), neighbours, open_end))
    return found


def _forbidden(across: Array, s: Array, scale: Array, radius: float) -> tuple[Array, Array]:
    """Return the ends of the forbidden intervals of ki, (+-sqrt(R^2 - across^2) - s) scale; inf, -inf where none is."""
    squares = radius**2 - across * across
    half = np.sqrt(np.maximum(squares, 0.0))
    high, low = (half - s) * scale, (-half - s) * scale
    high[squares <= 0.0] = -np.inf
    low[high <= 0.0] = np.inf
    return low, high


def _gain_grid(loci: Array, r: Array) -> Array:
    """Return gains dense where the vertices of the ellipses are, on an asinh scale."""
    half = r[: max(1, r.size // 2)]
    unit = LINEAR / float(np.sort(half)[half.size // 2])
    finite = loci[np.isfinite(loci) & (np.abs(loci) < FARTHEST * unit)]
    mapped = np.unique(np.arcsinh(finite / unit))
    even = np.linspace(mapped[0], mapped[-1], GAIN_POINTS // 2)
    quantiles = mapped[np.linspace(0, mapped.size - 1, GAIN_POINTS // 2).astype(int)]
    return np.asarray(np.unique(np.sinh(np.concatenate([even, quantiles, [0.0]])) * unit))
