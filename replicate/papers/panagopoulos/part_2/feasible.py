r"""The geometry of the sensitivity constraint in the (k, ki) plane at fixed kd, section 1 of the supplement.

At each frequency the constraint forbids the interior of an ellipse with axes along the coordinates (3). Its vertices
trace loci; the supplement approximates the envelope of the ellipses by the loci of the vertices. Here both are
computed:
the loci by the formulas, the region itself by taking, for every k, what the ellipses leave free and the loop stable.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from replicate.loops import PID, Circle, Loop, Plant
from replicate.loops.design.nyquist_constraints import LoopJet
from replicate.loops.sweep.stability_counts import polynomial_roots
from replicate.papers.panagopoulos.part_2.processes import G4

Array = NDArray[np.float64]

CIRCLE = Circle.of(1.4)  # C = 1, R = 1/1.4
W = np.geomspace(2e-3, 8.0, 3000)

Vertex = Literal["L", "R", "B"]


def vertices(vertex: Vertex, w: Array, kd: float, plant: Plant = G4) -> tuple[Array, Array]:
    """Return (k, ki) of the left, right or bottom vertex of the ellipse at each frequency."""
    g = plant(1j * w)
    r = np.abs(g)
    k = -CIRCLE.center * g.real / r**2
    ki = -CIRCLE.center * w * g.imag / r**2 + w**2 * kd
    if vertex == "B":
        return k, ki - w * CIRCLE.radius / r
    return k + (-1.0 if vertex == "L" else 1.0) * CIRCLE.radius / r, ki


def ellipse(w: float, kd: float, plant: Plant = G4) -> tuple[Array, Array]:
    """Return the ellipse (3) of one frequency, as a closed curve (k, ki)."""
    g = complex(plant(1j * w))
    r, turn = abs(g), np.linspace(0.0, 2.0 * np.pi, 181)
    k = -CIRCLE.center * g.real / r**2 + CIRCLE.radius / r * np.cos(turn)
    ki = -CIRCLE.center * w * g.imag / r**2 + w**2 * kd + w * CIRCLE.radius / r * np.sin(turn)
    return k, ki


@cache
def _of_ellipses() -> tuple[Array, ...]:
    """Return, at each frequency, |G| and what else the ellipses (3) of all gains share."""
    g = G4(1j * W)
    r = np.abs(g)
    return r, CIRCLE.center * g.real / r, -CIRCLE.center * W * g.imag / r**2, W / r, W**2


def ki_ranges(k: Array, kd: float) -> Array:
    """Return, for each k, the ends of the ki that keep a stable loop outside the circle; ``nan`` where there are none.

    Of several gaps between the ellipses the highest stable one counts.
    """
    gaps = [_gaps(float(x), kd) for x in k]
    owners = np.repeat(np.arange(k.size), [len(ends) for ends in gaps])
    ends = np.concatenate(gaps)
    stable = _stable(k[owners], ends.mean(axis=1), kd)
    found = np.full((k.size, 2), np.nan)
    found[owners[stable]] = ends[stable]  # of those of one k the last stays, the highest
    return np.asarray(found)


def _gaps(k: float, kd: float) -> Array:
    """Return the ends of the positive ki between the ellipses, below the highest one, ascending, shape (gaps, 2)."""
    r, offset, level, slope, square = _of_ellipses()
    inside = CIRCLE.radius**2 - (r * k + offset) ** 2
    blocked = np.nonzero(inside > 0.0)[0]
    middle = level[blocked] + square[blocked] * kd
    half = slope[blocked] * np.sqrt(inside[blocked])
    low, high = middle - half, middle + half
    order = np.argsort(low)
    low, high = low[order], np.maximum.accumulate(high[order])
    floor = np.maximum(np.concatenate([[0.0], high[:-1]]), 0.0)
    return np.asarray(np.column_stack([floor, low])[low > floor])


def _stable(k: Array, ki: Array, kd: float) -> NDArray[np.bool_]:
    """Say of each loop whether it is stable, from plain roots: the plant has no dead time and no delicate poles."""
    characteristic = np.repeat(np.append(G4.den, 0.0)[:, None], k.size, axis=1)
    characteristic[-3:] += float(G4.num[-1]) * np.stack([np.full(k.size, kd), k, ki])
    return np.asarray(polynomial_roots(characteristic)[0].real.max(axis=0) < 0.0)


@cache
def region(kd: float, highest: float = 1.6, points: int = 161) -> tuple[Array, Array, Array]:
    """Return k, and the lower and upper end of ki over it."""
    k = np.linspace(0.0, highest, points)
    return k, *ki_ranges(k, kd).T


@cache
def _plant_on_grid() -> LoopJet:
    return LoopJet.of(G4, W)


@dataclass(frozen=True)
class Best:
    """The largest ki at a fixed kd: smooth (one frequency touches) or at an edge (two do)."""

    k: float
    ki: float
    frequencies: tuple[float, ...]

    @property
    def smooth(self) -> bool:
        """Whether the boundary has a horizontal tangent there."""
        return len(self.frequencies) == 1


@cache
def best(kd: float) -> Best | None:
    """Return the largest ki at a fixed kd, polished by Newton's method and verified; None if nothing is feasible."""
    k, _, upper = region(kd)
    if np.all(np.isnan(upper)):
        return None
    i = int(np.nanargmax(upper))
    fine = np.linspace(k[max(i - 1, 0)], k[min(i + 1, k.size - 1)], 41)
    tops = ki_ranges(fine, kd)[:, 1]
    i = int(np.nanargmax(tops))
    gains = np.array([fine[i], tops[i], kd])
    value, _ = _plant_on_grid().values("sensitivity", CIRCLE, gains)
    dips = np.nonzero((value[1:-1] <= value[:-2]) & (value[1:-1] <= value[2:]))[0] + 1
    touching = [float(W[j]) for j in dips[np.argsort(value[dips])]]
    for count in (1, 2):
        found = _polish(gains, tuple(touching[:count]))
        if found is not None:
            return found
    return None


def _polish(gains: Array, touching: tuple[float, ...]) -> Best | None:
    """Solve for tangency at each frequency and, with a single one, for a horizontal boundary."""

    def equations(x: Array) -> list[float]:
        now = np.array([x[0], x[1], gains[2]])
        jet = LoopJet.of(G4, x[2:], order=1)
        values, gradients = jet.values("sensitivity", CIRCLE, now)
        result = [*values.tolist(), *jet.slopes("sensitivity", CIRCLE, now).tolist()]
        return [*result, float(gradients[0, 0])] if len(touching) == 1 else result

    solution = root(equations, [gains[0], gains[1], *touching], options={"xtol": 1e-14})
    if np.max(np.abs(solution.fun)) > 1e-9 or abs(solution.x[1] / gains[1] - 1.0) > 0.02:
        return None
    k, ki, *frequencies = (float(v) for v in solution.x)
    loop = Loop(G4, PID(k, ki, float(gains[2])))
    if not loop.is_stable() or loop.sensitivity_peak() * CIRCLE.radius > 1.0 + 1e-9:
        return None
    return Best(k, ki, tuple(sorted(frequencies)))
