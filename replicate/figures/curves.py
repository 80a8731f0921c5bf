"""Compare the curves of a figure: which one moved, where and by how much, which was renamed, is gone or new.

Curves are matched by panel and label. Functions of x are compared by value (`replicate.figures.values`), all
others by distance (`replicate.figures.distance`).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from replicate.figures.contours import interrupted_words
from replicate.figures.differences import Difference, FigureChange, percent
from replicate.figures.distance import Distances, distances, point_counts, point_distances
from replicate.figures.envelope import compare_envelopes
from replicate.figures.grouping import NUMBERED, grouped
from replicate.figures.pair import Pair
from replicate.figures.panel_pairs import matched_panels
from replicate.figures.places import points_apart
from replicate.figures.polylines import THINNING, Points
from replicate.figures.sameness import Axes
from replicate.figures.scaling import TOLERANCE, finite, in_units, rounding
from replicate.figures.showing import hidden_names
from replicate.figures.streams import field_words, heads_words
from replicate.figures.values import WINDOW, Array, compare_values, is_function
from replicate.figures.wording import moved_words

# A function of x that moved by less than this needs no second measure that says whether it moved sideways.
_LITTLE = 10.0 * TOLERANCE
# The error of thinning follows the last digits of a curve, but not by more than this factor.
_SLACK = 2.0
# Earlier versions closed the gaps that labels cut into contours.
_LOOSE = 0.02

#: By panel and name, in data coordinates.
Curves = Mapping[tuple[str, str], Points]


@dataclass
class CurveComparison:
    """All curves of a figure.

    Attributes
    ----------
    renamed
        The accepted name by panel and new name of those that changed it.
    fresh
        New curves by panel and name, of which the name is that of another curve in the accepted state.
    """

    changes: list[Difference] = field(default_factory=list)
    pairs: list[Pair] = field(default_factory=list)
    renamed: dict[tuple[str, str], str] = field(default_factory=dict)
    fresh: set[tuple[str, str]] = field(default_factory=set)


def compare_curves(before: tuple[Curves, Sequence[Axes]], after: tuple[Curves, Sequence[Axes]]) -> CurveComparison:
    """Compare the curves of a figure.

    Parameters
    ----------
    before, after
        Curves and descriptions of the axes; distances are fractions of the accepted axes.
    """
    found = CurveComparison()
    several = len(before[1]) > 1
    for old, new in matched_panels(before[1], after[1]):
        if old is not None and new is not None:
            panel = _Panel(old, new, f" in '{old['panel']}'" if several else "")
            one, other = (
                {name: points for (owner, name), points in curves.items() if owner == axes["panel"]}
                for curves, axes in ((before[0], old), (after[0], new))
            )
            panel.compare(one, other, found)
    return found


class _Panel:
    """One panel in both states."""

    def __init__(self, old: Axes, new: Axes, suffix: str) -> None:
        self.old, self.new = old, new
        self.suffix = suffix
        self.view = _view(old, new)

    def compare(self, one: dict[str, Points], other: dict[str, Points], found: CurveComparison) -> None:
        own = CurveComparison()
        self.say_all(one, other, own)
        found.changes += grouped(own.changes, self.suffix)
        found.pairs += own.pairs
        found.renamed |= own.renamed
        found.fresh |= own.fresh

    def say_all(self, one: dict[str, Points], other: dict[str, Points], found: CurveComparison) -> None:
        pairs = {name: self.pair(name, name, one[name], other[name]) for name in one if name in other}
        found.pairs += pairs.values()
        for name in pairs:
            self.slack(name, found)
        differ = [name for name, pair in pairs.items() if pair.moved]
        gone = [name for name in one if name not in other and name not in hidden_names(self.old)]
        fresh = [name for name in other if name not in one and name not in hidden_names(self.new)]
        was = self.same_elsewhere(
            {name: one[name] for name in (*differ, *gone)}, {name: other[name] for name in (*differ, *fresh)}
        )  # new name -> the accepted name of the same curve
        done = self.numbered_anew(was, one, other, found)
        for name in (*differ, *fresh):
            origin = was.get(name)
            if origin is None or name in done:
                continue
            if was.get(origin) == name:
                self.say(found, "curve", f"the labels of curves '{name}' and '{origin}' are swapped", name, origin)
                done |= {name, origin}
                self.rename(found, name, origin)
                self.rename(found, origin, name)
            elif origin in gone:
                self.say(found, "curve", f"curve '{origin}' is now called '{name}'", name, origin)
                done |= {name, origin}
                self.rename(found, name, origin)
            else:
                self.say(found, "curve", f"curve '{name}' now lies where '{origin}' lay", name, origin)
                done.add(name)
        for name in gone:
            if name not in done:
                self.say(found, "removed", f"curve '{name}' is missing", name)
        for name in fresh:
            if name not in done:
                self.say(found, "new", f"curve '{name}' is new", name)
        for name in differ:
            if name not in done:
                words, size = moved_words(pairs[name], self.view)
                self.say(found, "curve", f"curve '{name}'{self.suffix} {words}", name, size=size, suffix="")

    def numbered_anew(
        self, was: Mapping[str, str], one: Collection[str], other: Collection[str], found: CurveComparison
    ) -> set[str]:
        """Rename curves that have numbers for names, and return the names that are settled: nobody sees a number."""
        numbers = {name: origin for name, origin in was.items() if all(map(NUMBERED.fullmatch, (name, origin)))}
        as_many = len(one) == len(other)  # then a curve whose name another one has now has moved, and is not new
        while as_many and not all(origin in numbers or origin not in other for origin in numbers.values()):
            numbers = {name: origin for name, origin in numbers.items() if origin in numbers or origin not in other}
        for name, origin in numbers.items():
            self.rename(found, name, origin)
        origins = set(numbers.values())
        for name in sorted(numbers.keys() & set(one) - origins):
            self.say(found, "removed", f"curve '{name}' is missing", name)
        for name in sorted(origins & set(other) - numbers.keys()):  # the curve that had its name has another one now
            self.say(found, "new", f"curve '{name}' is new", name)
            found.fresh.add((str(self.old["panel"]), name))
        return numbers.keys() | origins

    def rename(self, found: CurveComparison, name: str, origin: str) -> None:
        found.renamed[str(self.old["panel"]), name] = origin

    def say(
        self,
        found: CurveComparison,
        kind: FigureChange,
        text: str,
        name: str,
        before: str = "",
        *,
        size: float | None = None,
        suffix: str | None = None,
    ) -> None:
        where = f"{self.old['panel']} / {name}"
        text += self.suffix if suffix is None else suffix
        after = name if before else ""
        found.changes.append(Difference(kind, text, where, before, after, size))

    def pair(self, old_name: str, new_name: str, one: Points, other: Points) -> Pair:
        """Compare two curves, which need not have the same name."""
        kinds = [
            next((kind for kind in ("points", "areas") if name in axes.get(kind, ())), "line")
            for name, axes in ((old_name, self.old), (new_name, self.new))
        ]
        # What an accepted file allows counts only as far as the figure itself needs it.
        needed = self.thinned(new_name, self.new)
        coarse = sum(
            max(0.0, error - THINNING) for error in (needed, min(self.thinned(old_name, self.old), _SLACK * needed))
        )
        tolerance = TOLERANCE + coarse + rounding(self.old, "y")
        labels = [
            ellipse for name, axes in ((old_name, self.old), (new_name, self.new)) for ellipse in _labels(axes, name)
        ]
        if labels and old_name in self.old.get("loose", ()):
            tolerance = _LOOSE
        told = None if labels and needed <= _LOOSE else self.dense(old_name, new_name)
        if told is not None:
            words, size = told
            return Pair(self.old, new_name, one, other, bool(words), tolerance, words=words, size=size)
        before, after = in_units(one, self.old), in_units(other, self.old)
        same = before.shape == after.shape and bool(
            np.allclose(before, after, rtol=0.0, atol=TOLERANCE / 100.0, equal_nan=True)
        )
        if same:
            return Pair(self.old, new_name, one, other, moved=False, tolerance=tolerance)
        if kinds == ["line", "line"] and not labels and is_function(before) and is_function(after):
            window = WINDOW + coarse + rounding(self.old, "x")
            values = compare_values(before, after, tolerance, window, self.view)
            far = bool(values.alarm.any())
            apart = self.apart(before, after, tolerance) if far and values.largest > _LITTLE else ()
            return Pair(self.old, new_name, one, other, far, tolerance, values, apart)
        way = field_words(before, after) if self.are_streams(old_name, new_name) else None
        if way is not None:
            return Pair(self.old, new_name, one, other, bool(way), tolerance, words=way, size=float(bool(way)))
        if kinds == ["points", "points"]:
            apart = (point_distances(after, before, self.view), point_distances(before, after, self.view))
            size = max(part.largest for part in apart)
            counts = point_counts(before, after, self.view)
            words = f"now has {counts[1]} points (was {counts[0]})" if counts[0] != counts[1] else ""
            far = bool(words) or size > tolerance
            return Pair(self.old, new_name, one, other, far, tolerance, None, apart, words, size)
        apart = self.apart(before, after, tolerance, labels)
        far = max(part.largest for part in apart) > tolerance
        return Pair(self.old, new_name, one, other, far, tolerance, None, apart)

    @staticmethod
    def thinned(name: str, axes: Axes) -> float:
        """Return how far a thinned curve may lie from the one that was drawn, as a fraction of its axes."""
        return max(THINNING, float(axes.get("thinned", {}).get(name, 0.0)))

    def slack(self, name: str, found: CurveComparison) -> None:
        """Say where an accepted record lets a curve move further than the figure needs: nothing may hide there."""
        allowed, needed = self.thinned(name, self.old), self.thinned(name, self.new)
        alike = (name in self.old.get("streams", {})) == (name in self.new.get("streams", {}))  # else as many points
        if alike and not needed / _SLACK <= allowed <= needed * _SLACK:
            detail = "more" if needed > allowed else "less"
            kept = f"the record follows it within {percent(needed)} of the axes (was {percent(allowed)})"
            text = f"curve '{name}' has {detail} fine detail now: {kept}"
            self.say(found, "axes", text, name)
        heads = [axes["streams"][name] for axes in (self.old, self.new)] if self.are_streams(name, name) else [0, 0]
        for words in filter(None, (interrupted_words(self.old, self.new, name), heads_words(*heads))):
            self.say(found, "axes", f"curve '{name}' {words}", name)

    def are_streams(self, *names: str) -> bool:
        return all(name in axes.get("streams", {}) for name, axes in zip(names, (self.old, self.new), strict=True))

    def dense(self, old_name: str, new_name: str) -> tuple[str, float] | None:
        """Compare two curves, or clouds of points, of which only a digest is kept; ``None`` if all points are."""
        one, other = (axes.get("dense", {}).get(name) for axes, name in ((self.old, old_name), (self.new, new_name)))
        if one is not None and other is not None:
            return compare_envelopes(one, other) or ("", 0.0)
        one, other = (axes.get("clouds", {}).get(name) for axes, name in ((self.old, old_name), (self.new, new_name)))
        if one is None or other is None:
            return None
        counts = [cloud["pieces"] for cloud in (one, other)]
        if counts[0] != counts[1]:
            return f"now has {counts[1]} points (was {counts[0]})", 1.0
        size = points_apart(one, other, TOLERANCE)
        return (f"moved: its {counts[0]} points lie elsewhere", size) if size else ("", 0.0)

    def apart(
        self, before: Points, after: Points, tolerance: float, covered: Sequence[Sequence[float]] = ()
    ) -> tuple[Distances, Distances]:
        both = ((after, before), (before, after))
        one, other = (distances(*pair, tolerance, self.view, covered) for pair in both)
        return one, other

    def same_elsewhere(self, one: dict[str, Points], other: dict[str, Points]) -> dict[str, str]:
        """Return, by new name, the accepted curve of another name that is the same, each at most once."""
        was: dict[str, str] = {}
        boxes = {name: _box(in_units(points, self.old)) for name, points in one.items()}
        for name, points in other.items():
            box = _box(in_units(points, self.old))
            for origin, accepted in one.items():
                near = bool(np.all(np.abs(boxes[origin] - box) <= 10.0 * TOLERANCE))
                if (
                    origin != name
                    and origin not in was.values()
                    and near
                    and not self.pair(origin, name, accepted, points).moved
                ):
                    was[name] = origin
                    break
        return was


def _labels(axes: Axes, name: str) -> Sequence[Sequence[float]]:
    """Return what labels cover of a contour."""
    found: Sequence[Sequence[float]] = axes.get("labels", {}).get(name, ())
    return found


def _box(points: Points) -> Points:
    """Return the corners of the part of a curve that is in view; far away if it has none."""
    there = points[finite(points)]
    if not len(there):
        return np.full((2, 2), 1e9)
    return np.asarray(np.clip(np.vstack([there.min(axis=0), there.max(axis=0)]), 0.0, 1.0))


def _view(old: Axes, new: Axes) -> Array:
    """Return the part of the accepted axes that both states show, as ``[[left, right], [bottom, top]]``."""
    if "polar" in old or old.get("units") == "box":
        return np.array([[0.0, 1.0], [0.0, 1.0]])
    limits = np.column_stack([np.asarray(new[f"{axis}lim"], dtype=float) for axis in "xy"])
    low, high = np.sort(in_units(limits, old), axis=0)
    view = np.column_stack([np.fmax(low, 0.0), np.fmin(high, 1.0)])
    return view if np.all(view[:, 1] > view[:, 0]) else np.array([[0.0, 1.0], [0.0, 1.0]])
