"""What the eye sees of a curve that is too dense to keep: for each column of pixels its ends, its mean and its travel.

None of the numbers depends on how a curve was sampled, as long as it was sampled well: a segment is cut where a column
ends, the mean is an integral, and the travel is how far the curve goes up and down within the column. Noise with
another seed has other ends and means; a fast oscillation of another frequency travels further.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.figures.differences import percent
from replicate.figures.digests import Array, line_waves, rounded
from replicate.figures.polylines import Points
from replicate.figures.scaling import finite

COLUMNS = 400

#: Ends and means are the same up to this fraction of the axes, a third of a pixel ...
TOLERANCE = 1e-3
#: ... and the travel up to this fraction of itself.
_TRAVEL = 0.02
_TOTAL = 5e-3

_EDGE = 1e-6
_UNIT = 1e-5
_NOTHING = -(10**9)  # an empty column, in records of earlier releases
_MARGIN = 0.5
_FIELDS = ("low", "high", "mean", "travel")


def envelope(points: Points, *, function: bool) -> dict[str, Any]:
    """Return the envelope of a curve.

    Parameters
    ----------
    points
        Shape (n, 2) in box units, a row that is not finite is a break.
    function
        Whether the columns tell all. Otherwise rows of pixels join them.
    """
    there = finite(points)
    both = there[:-1] & there[1:]
    starts, ends = points[:-1][both], points[1:][both]
    kept: dict[str, Any] = {"columns": _columns(starts, ends)}
    if not function:
        kept["rows"] = _columns(starts[:, ::-1], ends[:, ::-1])
    near = (np.abs(np.hstack([starts, ends]) - 0.5) <= 1.0).all(axis=1)
    kept["points"] = int(there.sum())
    kept["waves"] = rounded(line_waves(starts[near], ends[near]), 9)
    return kept


def _columns(starts: Points, ends: Points) -> dict[str, list[int | None]]:
    """Return the four numbers of every column, as whole multiples of 1e-5 of the axes; none where nothing is."""
    starts, ends = _cut(starts, ends)
    # What runs along the edge of a column, as an area's border along the axes does, always counts to the next one.
    column = np.floor((starts[:, 0] + ends[:, 0]) / 2.0 * COLUMNS + _EDGE).astype(int)
    seen = (column >= 0) & (column < COLUMNS)
    column, starts, ends = column[seen], starts[seen], ends[seen]
    one, other = (np.clip(part[:, 1], -_MARGIN, 1.0 + _MARGIN) for part in (starts, ends))
    width = np.abs(ends[:, 0] - starts[:, 0])
    low, high = np.full(COLUMNS, np.inf), np.full(COLUMNS, -np.inf)
    np.minimum.at(low, column, np.minimum(one, other))
    np.maximum.at(high, column, np.maximum(one, other))
    total = np.bincount(column, width, COLUMNS)
    area = np.bincount(column, width * (one + other) / 2.0, COLUMNS)
    empty = ~np.isfinite(low)
    low, high = np.where(empty, 0.0, low), np.where(empty, 0.0, high)
    mean = np.where(total > 1e-3 / COLUMNS, area / np.where(total > 0.0, total, 1.0), (low + high) / 2.0)
    travel = np.bincount(column, np.abs(other - one), COLUMNS)
    numbers = {"low": low, "high": high, "mean": mean, "travel": travel}
    return {
        name: [None if nothing else int(value) for value, nothing in zip(np.round(values / _UNIT), empty, strict=True)]
        for name, values in numbers.items()
    }


def _cut(starts: Points, ends: Points) -> tuple[Points, Points]:
    """Cut segments where a column ends."""
    margin = 2.0 / COLUMNS
    seen = (np.maximum(starts[:, 0], ends[:, 0]) > -margin) & (np.minimum(starts[:, 0], ends[:, 0]) < 1.0 + margin)
    starts, ends = starts[seen], ends[seen]
    first, last = (np.clip(part[:, 0] * COLUMNS, -1.0, COLUMNS + 1.0) for part in (starts, ends))
    low, high = np.minimum(first, last), np.maximum(first, last)
    begin = np.floor(low) + 1.0
    count = np.maximum(np.ceil(high) - begin, 0.0).astype(int)
    segment = np.repeat(np.arange(len(starts)), count)
    order = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)
    at = (begin[segment] + order) / COLUMNS
    along = ends[segment, 0] - starts[segment, 0]
    share = np.clip((at - starts[segment, 0]) / np.where(along == 0.0, 1.0, along), 0.0, 1.0)
    # The cuts of a segment, from its start to its end, between its two ends.
    index = np.concatenate([np.arange(len(starts)), segment, np.arange(len(starts))])
    place = np.concatenate([np.full(len(starts), -1.0), share, np.full(len(starts), 2.0)])
    order = np.lexsort((place, index))
    index, place = index[order], np.clip(place[order], 0.0, 1.0)
    cuts = starts[index] + place[:, None] * (ends - starts)[index]
    same = index[:-1] == index[1:]
    return cuts[:-1][same], cuts[1:][same]


def compare_envelopes(before: Mapping[str, Any], after: Mapping[str, Any]) -> tuple[str, float] | None:
    """Return how the later of two envelopes differs, in words and as a fraction of the axes; ``None`` if it does not.

    Where in the words is a fraction of the axes from the left (``at``), to be put in the axis' own units.
    """
    for side in ("columns", "rows"):
        if (side in before) != (side in after):
            return "has another course", 1.0
        if side not in before:
            continue
        one, other = ({name: _array(kept[side][name]) for name in _FIELDS} for kept in (before, after))
        found = _worst(one, other)
        if found is not None:
            words, size, place = found
            return f"{words} {place:.0%} of the way {'from left to right' if side == 'columns' else 'up'}", size
    one_waves, other_waves = (np.asarray(kept["waves"], dtype=float) for kept in (before, after))
    apart = float(np.abs(other_waves - one_waves).max())
    if apart > _TOTAL * max(one_waves[0], 1.0):
        return "has another course, too fine to show", apart / max(one_waves[0], 1.0)
    return None


def _worst(one: Mapping[str, Array], other: Mapping[str, Array]) -> tuple[str, float, float] | None:
    gone = np.isnan(one["low"]) != np.isnan(other["low"])
    # A curve may end where a column does.
    if _runs(gone) > 1:
        return "is now elsewhere,", 1.0, float(np.argmax(gone)) / COLUMNS
    found = _moved(one, other, (("low", "its lower end moved"), ("high", "its upper end moved")))
    if found is not None:
        return found
    travel = np.nan_to_num(np.abs(other["travel"] - one["travel"]))
    allowed = _TRAVEL * np.nan_to_num(one["travel"]) + 4.0 * TOLERANCE
    worst = int(np.argmax(travel - allowed))
    if travel[worst] > allowed[worst]:
        change = other["travel"][worst] / max(one["travel"][worst], _UNIT)
        return f"oscillates {change:.3g} times as much,", float(travel[worst]), worst / COLUMNS
    return _moved(one, other, (("mean", "its mean moved"),))


def _moved(
    one: Mapping[str, Array], other: Mapping[str, Array], parts: Sequence[tuple[str, str]]
) -> tuple[str, float, float] | None:
    best: tuple[str, float, float] | None = None
    for name, words in parts:
        apart = np.nan_to_num(np.abs(other[name] - one[name]))
        worst = int(np.argmax(apart))
        if apart[worst] > TOLERANCE and (best is None or apart[worst] > best[1]):
            best = (
                f"{words} by at most {percent(float(apart[worst]))} of the axis,",
                float(apart[worst]),
                worst / COLUMNS,
            )
    return best


def _runs(flags: NDArray[np.bool_]) -> int:
    """Return the length of the longest run of true values."""
    edges = np.flatnonzero(np.diff(np.r_[False, flags, False].astype(int)))
    return int((edges[1::2] - edges[::2]).max(initial=0))


def _array(values: Sequence[int | None]) -> Array:
    numbers = np.asarray(values, dtype=float)
    return np.where(numbers == _NOTHING, np.nan, numbers * _UNIT)
