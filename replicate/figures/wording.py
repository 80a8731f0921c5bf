"""How a curve moved, in words: by how much, where, and whether it was a jump that moved."""

from __future__ import annotations

import numpy as np

from replicate.figures.axes import symbol
from replicate.figures.axis_words import on_axis
from replicate.figures.differences import percent
from replicate.figures.pair import Pair
from replicate.figures.polylines import Points
from replicate.figures.sameness import Axes
from replicate.figures.scaling import finite, from_units, in_units, place_of
from replicate.figures.values import Array, ValueDifference

# Consecutive points no further apart along x than this, and further along y, are a jump.
_JUMP_WIDTH, _JUMP_HEIGHT = 1e-6, 1e-3
# A square wave that is delayed moves all its jumps.
_MOST_JUMPS = 2
# A curve that moved sideways where it is steep: the change of value exaggerates by more than this factor.
_STEEP = 5.0


def moved_words(pair: Pair, view: Array) -> tuple[str, float]:
    """Return what to say after the name of a curve that moved, and by which fraction of the axes it did.

    Parameters
    ----------
    view
        The part of the axes that was compared.
    """
    if pair.words:
        return pair.words, pair.size
    if pair.values is None:
        return _distance_words(pair)
    parts, sizes = [], []
    for words, size in (*_ends(pair, pair.values, view), *_values(pair, pair.values)):
        parts.append(words)
        sizes.append(size)
    if not parts:  # something smaller than all that has a name
        return "changed", max((part.largest for part in pair.distance), default=pair.values.largest)
    return "; ".join(parts), max(sizes)


def _distance_words(pair: Pair) -> tuple[str, float]:
    furthest = max(pair.distance, key=lambda part: part.largest)
    if not np.isfinite(furthest.largest):
        return "is no longer visible" if furthest is pair.distance[1] else "is now visible", furthest.largest
    at = _at(pair.axes, furthest.place)
    return f"moved: at most {percent(furthest.largest)} of the axes at {at}", furthest.largest


def _ends(pair: Pair, found: ValueDifference, view: Array) -> list[tuple[str, float]]:
    """Say where a curve now begins or ends, if that differs, and whether it has a new gap."""
    if not (found.alarm & (np.isnan(found.before) != np.isnan(found.after))).any():
        return []
    x = symbol(pair.axes, "x")
    parts = []
    domains = []
    for points in (pair.before, pair.after):
        units = in_units(points, pair.axes)
        along = np.clip(units[finite(units), 0], *view[0])
        domains.append((along.min(), along.max()))
    for verb, was, now in zip(("begins", "ends"), *domains, strict=True):
        if abs(now - was) > pair.tolerance:
            ends = [on_axis(from_units(float(value), pair.axes, "x"), pair.axes, "x") for value in (now, was)]
            parts.append((f"now {verb} at {x} = {ends[0]} (was {ends[1]})", abs(float(now - was))))
    inside = (found.x > max(low for low, _ in domains)) & (found.x < min(high for _, high in domains))
    for here, there, words in ((found.before, found.after, "has a gap"), (found.after, found.before, "continues")):
        gap = found.x[found.alarm & inside & ~np.isnan(here) & np.isnan(there)]
        if len(gap):
            ends = [on_axis(from_units(float(value), pair.axes, "x"), pair.axes, "x") for value in (gap[0], gap[-1])]
            parts.append((f"now {words} from {x} = {ends[0]} to {ends[1]}", float(gap[-1] - gap[0])))
    return parts


def _values(pair: Pair, found: ValueDifference) -> list[tuple[str, float]]:
    """Say which jump moved, and by how much the value changed elsewhere."""
    parts: list[tuple[str, float]] = []
    alarm = found.alarm & ~np.isnan(found.before) & ~np.isnan(found.after)
    x = symbol(pair.axes, "x")
    old, new = (_jumps(in_units(points, pair.axes)) for points in (pair.before, pair.after))
    if len(old) == len(new):
        jumps: list[tuple[str, float]] = []
        for was, now in zip(old, new, strict=True):
            low, high = min(was, now), max(was, now)
            between = (found.x >= low - pair.tolerance) & (found.x <= high + pair.tolerance)
            if high - low > pair.tolerance and (alarm & between).any():
                alarm &= ~between
                ends = [on_axis(from_units(value, pair.axes, "x"), pair.axes, "x") for value in (was, now)]
                words = f"its jump at {x} = {ends[0]} is now at {ends[1]} ({percent(high - low)} of the axis)"
                jumps.append((f"{'moved: ' if not jumps else ''}{words}", high - low))
        parts += jumps[:_MOST_JUMPS]
        if len(jumps) > _MOST_JUMPS:
            furthest = max(size for _, size in jumps)
            count = len(jumps) - _MOST_JUMPS
            words = f"and {count} more jump{'s' if count > 1 else ''}, by at most {percent(furthest)} of the axis"
            parts.append((words, furthest))
    size = np.where(alarm, np.abs(found.after - found.before), -1.0)
    worst = int(np.argmax(size))
    if size[worst] > 0.0:
        parts.append((_at_most(pair, found, worst, first=not parts), float(size[worst])))
    return parts


def _at_most(pair: Pair, found: ValueDifference, worst: int, *, first: bool) -> str:
    one, other = (from_units(float(values[worst]), pair.axes, "y") for values in (found.before, found.after))
    size = float(abs(found.after[worst] - found.before[worst]))
    how = f"a factor of {max(one, other) / min(one, other):.4g}" if _is_log(pair.axes) else f"{abs(other - one):.2g}"
    at = on_axis(from_units(float(found.x[worst]), pair.axes, "x"), pair.axes, "x")
    words = f"{'moved: ' if first else 'elsewhere '}at most {how} ({percent(size)} of the axis)"
    words += f" at {symbol(pair.axes, 'x')} = {at}"
    apart = max((part.largest for part in pair.distance), default=size)
    if first and size > _STEEP * apart:
        words += ", where it is steep"
        words += f"; the curves are {percent(apart)} of the axes apart" if apart > pair.tolerance else ""
    return words


def _is_log(axes: Axes) -> bool:
    return bool(axes.get("yscale") == "log")


def _jumps(points: Points) -> list[float]:
    """Return where a curve jumps; in fractions of the axes."""
    step = np.diff(points, axis=0)
    with np.errstate(invalid="ignore"):
        jump = (np.abs(step[:, 0]) <= _JUMP_WIDTH) & (np.abs(step[:, 1]) > _JUMP_HEIGHT)
    return [float(x) for x in points[:-1][jump, 0]]


def _at(axes: Axes, units: Points) -> str:
    """Say where a point is, in the words of its axes."""
    x, y = place_of(units.tolist(), axes)
    if axes.get("units") == "box":
        return f"({on_axis(x)}, {on_axis(y)}) of the axes"
    if "polar" in axes:
        return f"angle = {on_axis(float(np.degrees(x)))}°, radius = {on_axis(y)}"
    names = [symbol(axes, axis) for axis in "xy"]
    names = ["x", "y"] if names[0] == names[1] else names
    return f"{names[0]} = {on_axis(x, axes, 'x')}, {names[1]} = {on_axis(y, axes, 'y')}"
