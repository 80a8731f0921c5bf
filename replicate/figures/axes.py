"""Compare the descriptions of axes: limits, scales, labels, legend and texts, said as a person would."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from replicate.figures.axis_words import on_axis
from replicate.figures.differences import Difference
from replicate.figures.panel_pairs import matched_panels
from replicate.figures.sameness import Axes, close, same, same_value
from replicate.figures.scaling import TOLERANCE, in_units

Text = Mapping[str, Any]

#: Said elsewhere, by what is compared curve by curve or part by part, or by the tick labels.
_SILENT = {
    "xunit",
    "yunit",
    "panel",
    "parts",
    "dense",
    "clouds",
    "labels",
    "loose",
    "streams",
    "thinned",
    "units",
    "curves",
    "fitted",
    "over",
}
_FIRST = {
    *("title", "xlabel", "ylabel", "xscale", "yscale", "xlim", "ylim", "legend", "texts", "aspect", "hidden"),
    *("points", "areas", "figure_title", "figure_texts", "figure_legend"),
}
#: What is kept with the first panel, but said of the figure.
_WHOLE = "figure_"
_CALLED = {
    "depth": "projection in space",
    "view": "view (elevation, azimuth, roll)",
    "xcategories": "categories of the x axis",
    "ycategories": "categories of the y axis",
    "xkind": "kind of the x axis",
    "ykind": "kind of the y axis",
    "titles": "titles (left, centre, right)",
    "proportions": "proportions of the box",
}
_MANY = {"xcategories", "ycategories", "titles", "proportions"}


def compare_axes(before: Sequence[Axes], after: Sequence[Axes]) -> list[Difference]:
    """Compare the panels of a figure.

    Parameters
    ----------
    before, after
        Descriptions as in `replicate.figures.readback.read_panel`.
    """
    several = len(before) > 1 or len(after) > 1
    changes = []
    # What the first version of the records did not know cannot have changed.
    known = None if any("parts" in panel for panel in before) else _FIRST
    matched = matched_panels(before, after)
    # Where a panel comes or goes the others make room for it.
    silent = _SILENT if all(old and new for old, new in matched) else _SILENT | {"position"}
    names = [[str(panel["panel"]) for panel in panels] for panels in (before, after)]
    # In what order they were made shows where they are only in the first version of the records.
    moved = any(old and new and not ("position" in old and same(old, new, "position")) for old, new in matched)
    if moved and names[0] != names[1] and sorted(names[0]) == sorted(names[1]):
        shown = [", ".join(f"'{name}'" for name in order) for order in names]
        changes.append(Difference("axes", f"the panels now stand in the order {shown[1]} (was {shown[0]})", "panels"))
    for first, now in zip(before[:1], after[:1], strict=False):
        changes += _compare(first, now, [name for name in _names(first, now, known) if name.startswith(_WHOLE)])
    for old, new in matched:
        panel = str((old or new or {})["panel"])
        if old is None or new is None:
            what, kind = ("gone", "removed") if new is None else ("new", "new")
            changes.append(Difference("axes", f"panel '{panel}' is {what}", panel, kind))
            continue
        said = silent | ({"yscale"} if "polar" in old and "polar" in new else set())  # with the radius
        own = [name for name in _names(old, new, known) if name not in said and not name.startswith(_WHOLE)]
        changes += _compare(old, new, own, f"'{panel}': " if several else "")
    return changes


def _names(old: Axes, new: Axes, known: Collection[str] | None) -> list[str]:
    return [name for name in dict.fromkeys((*old, *new)) if known is None or name in known]


def _compare(old: Axes, new: Axes, names: Sequence[str], prefix: str = "") -> Iterator[Difference]:
    """Yield what differs of the properties with these names."""
    for name in names:
        if not same(old, new, name):
            shown = _shown(old.get(name)), _shown(new.get(name))
            for text in _words(name, old, new):
                yield Difference("axes", prefix + text, f"{old['panel']} / {name}", *shown)


def symbol(axes: Axes, axis: str) -> str:
    r"""Return a short name of the quantity on an axis, for sentences in plain text.

    Examples
    --------
    >>> symbol({"xlabel": "proportional gain $K_h$"}, "x"), symbol({"xlabel": "time (s)"}, "x")
    ('Kh', 'time')
    >>> symbol({"ylabel": ""}, "y"), symbol({"ylabel": r"$\omega_0 / \pi$"}, "y")
    ('y', 'omega0 / pi')
    """
    label = str(axes.get(f"{axis}label", ""))
    math = re.search(r"\$(.+?)\$", label)
    # Commands that only set type, as \mathrm, go; those that name a letter, as \omega, stay as its name.
    text = re.sub(r"\\(mathrm|mathit|text|left|right|[,;! ])", "", math[1]) if math else label
    text = re.sub(r"[\\{}$_^]", "", text)
    text = " ".join(re.sub(r"\([^)]*\)|\[[^]]*\]", "", text).split() if not math else text.split())
    return text if 0 < len(text) <= _LONGEST_SYMBOL else axis


_LONGEST_SYMBOL = 20


def _words(name: str, before: Axes, after: Axes) -> Iterator[str]:
    one, other = before.get(name), after.get(name)
    if name in {"xlim", "ylim", "zlim"}:
        yield from _limits(name[0], before, after)
    elif name in {"xlabel", "ylabel", "zlabel", "xscale", "yscale"}:
        yield f"{name[1:]} of the {name[0]} axis is now {_shown(other)} (was {_shown(one)})"
    elif name in {"legend", "figure_legend"}:
        yield from _entries("legend entry", one or [], other or [])
    elif name == "figure_texts":
        yield from _entries("text", one or [], other or [])
    elif name == "texts":
        yield from _texts(one or [], other or [], before)
    elif name in {"points", "areas"}:
        both = _names_in_both(before, after)
        yield from (f"'{curve}' is drawn as {name} now" for curve in other or [] if curve in both - {*(one or [])})
        yield from (f"'{curve}' was drawn as {name}" for curve in one or [] if curve in both - {*(other or [])})
    elif name == "position":
        yield f"the panel is now at {_shown(other)} (was at {_shown(one)}): left, bottom, width, height of the figure"
    elif name in {"xtable", "ytable"}:
        yield f"the {name[0]} axis is scaled differently now"
    elif name == "polar":
        yield from _polar(one or {}, other or {})
    elif name == "aspect":
        yield f"aspect is now {_shown(other or 'auto')} (was {_shown(one or 'auto')})"
    elif name == "hidden":
        yield f"axes are now {'hidden' if other else 'visible'}"
    else:
        now, was = ("are now", "were") if name in _MANY else ("is now", "was")
        yield f"{_CALLED.get(name, name.replace('_', ' '))} {now} {_shown(other)} ({was} {_shown(one)})"


def _names_in_both(before: Axes, after: Axes) -> set[str]:
    """Return the names of parts that both states have; the curves among them have neither come nor gone."""
    names = ({str(part["name"]) for part in axes.get("parts", [])} for axes in (before, after))
    return next(names) & next(names)


def _polar(one: Mapping[str, Any], other: Mapping[str, Any]) -> Iterator[str]:
    words = {"offset": "zero of the angle", "direction": "direction of the angle", "rscale": "scale of the radius"}
    for name, called in words.items():
        if not same_value(one.get(name), other.get(name)):
            yield f"{called} is now {_shown(other.get(name))} (was {_shown(one.get(name))})"
    if not _same_radii(one, other):
        yield f"radius now runs over {_shown(other.get('rlim'))} (ran over {_shown(one.get('rlim'))})"
    if not close(one.get("matrix", []), other.get("matrix", [])):
        yield "the axes show another part of the circle"


def _same_radii(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    return close(one.get("rlim", [0.0, 1.0]), other.get("rlim", [0.0, 1.0]))


def _limits(axis: str, before: Axes, after: Axes) -> Iterator[str]:
    polar = "polar" in before and "polar" in after
    if polar and axis == "y" and not _same_radii(before["polar"], after["polar"]):
        return  # said of the radius
    one, other = before[f"{axis}lim"], after[f"{axis}lim"]
    called = {"x": "angle", "y": "radius"}[axis] if polar else f"{axis} axis"
    if same_value(list(one), list(reversed(other))):
        ends = [_end(value, axis, after) for value in other]
        yield f"{called} now runs from {ends[0]} to {ends[1]}, the other way round"
        return
    for verb, was, now in zip(("begins", "ends"), one, other, strict=True):
        if not same_value(was, now):
            shown = _end(now, axis, after), _end(was, axis, before)
            if shown[0] == shown[1]:  # dates within one second
                shown = _shown(now), _shown(was)
            yield f"{called} now {verb} at {shown[0]} (was {shown[1]})"


def _end(value: float, axis: str, axes: Axes) -> str:
    if axis == "x" and "polar" in axes:
        return f"{math.degrees(value):.6g}°"
    return on_axis(value, axes, axis) if axes.get(f"{axis}kind") == "date" else _shown(value)


def _entries(what: str, one: Sequence[str], other: Sequence[str]) -> Iterator[str]:
    """Tell renamed, reordered, missing and new entries apart."""
    if sorted(one) == sorted(other):
        differ = [(was, now) for was, now in zip(one, other, strict=True) if was != now]
        if len(differ) == 2:
            yield f"{what.replace('entry', 'entries')} {_shown(differ[0][0])} and {_shown(differ[0][1])} are swapped"
        else:
            entries = ", ".join(map(_shown, other))
            yield f"{what.replace('entry', 'entries')} in another order: {entries}"
        return
    gone = [entry for entry in one if entry not in other]
    fresh = [entry for entry in other if entry not in one]
    if len(one) == len(other) and len(gone) == len(fresh):
        verb = "now reads" if what == "text" else "renamed"
        yield from (f"{what} {_shown(was)} {verb} {_shown(now)}" for was, now in zip(gone, fresh, strict=True))
        return
    yield from (f"{what} {_shown(entry)} is gone" for entry in gone)
    yield from (f"{what} {_shown(entry)} is new" for entry in fresh)
    if not gone and not fresh:  # the same entries, some of them more or less often
        yield f"now {len(other)} of {_shown(what)} (was {len(one)})"


def _texts(one: Sequence[Text], other: Sequence[Text], axes: Axes) -> Iterator[str]:
    """Match texts by what they say and where they are, then by what they say, then by where they are."""
    left, right = list(one), list(other)
    for words_count, place_counts in ((True, True), (True, False), (False, True)):
        for old in list(left):
            for new in right:
                same_words = old["text"] == new["text"]
                if (same_words or not words_count) and (not place_counts or _near(old, new, axes)):
                    left.remove(old)
                    right.remove(new)
                    if not place_counts:
                        changed = old.get("in") != new.get("in")  # other coordinates
                        places = [_place(text) + (_coordinates(text) if changed else "") for text in (old, new)]
                        yield f"text {_shown(old['text'])} moved from {places[0]} to {places[1]}"
                    elif not words_count:
                        yield f"text {_shown(old['text'])} now reads {_shown(new['text'])}"
                    break
    yield from (f"text {_shown(text['text'])} at {_place(text)} is gone" for text in left)
    yield from (f"text {_shown(text['text'])} at {_place(text)} is new" for text in right)


def _near(one: Text, other: Text, axes: Axes) -> bool:
    if one.get("in") != other.get("in"):
        return False
    places = [(text.get("x"), text.get("y")) for text in (one, other)]
    if not all(isinstance(value, float) for place in places for value in place):
        return places[0] == places[1]
    points = np.array(places, dtype=float)
    if "in" not in one:
        points = in_units(points, axes)
    return bool(np.all(np.abs(points[1] - points[0]) <= TOLERANCE)) or places[0] == places[1]


def _place(text: Text) -> str:
    return f"({_shown(text.get('x'))}, {_shown(text.get('y'))})"


def _coordinates(text: Text) -> str:
    return " of the axes" if text.get("in") else " of the data"


def _shown(value: object) -> str:
    if value is None or value == "":
        return "nothing"
    if isinstance(value, list):
        return f"[{', '.join(map(_shown, value))}]"
    if isinstance(value, float):
        return f"{value:.9g}"
    return f"'{value}'" if isinstance(value, str) else str(value)
