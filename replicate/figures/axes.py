"""Compare the descriptions of axes: limits, scales, labels, legend and texts, said as a person would."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from replicate.figures.differences import Difference, same_number
from replicate.figures.scaling import TOLERANCE, in_units

Axes = Mapping[str, Any]
Text = Mapping[str, Any]


def compare_axes(before: Sequence[Axes], after: Sequence[Axes]) -> list[Difference]:
    """Compare the panels of a figure, matched by name.

    Parameters
    ----------
    before, after
        Descriptions as in `replicate.figures.readback.read_panel`.
    """
    several = len(before) > 1 or len(after) > 1
    changes = []
    for old, new in matched_panels(before, after):
        panel = str((old or new or {})["panel"])
        if old is None or new is None:
            what, kind = ("gone", "removed") if new is None else ("new", "new")
            changes.append(Difference("axes", f"panel '{panel}' is {what}", panel, kind))
            continue
        prefix = f"'{panel}': " if several else ""
        for name in dict.fromkeys((*old, *new)):
            one, other = old.get(name), new.get(name)
            if name != "panel" and not _same(one, other) and not _as_drawn(name, old, new):
                changes += [
                    Difference("axes", prefix + text, f"{panel} / {name}", _shown(one), _shown(other))
                    for text in _words(name, old, new)
                ]
    return changes


def matched_panels(
    before: Sequence[Axes], after: Sequence[Axes]
) -> list[tuple[Axes, Axes] | tuple[Axes, None] | tuple[None, Axes]]:
    """Match panels by name; where as many are left on both sides, they were renamed and keep their order."""
    old, new = ({str(axes["panel"]): axes for axes in panels} for panels in (before, after))
    gone = [panel for panel in old if panel not in new]
    fresh = [panel for panel in new if panel not in old]
    renamed = dict(zip(gone, fresh, strict=True)) if len(gone) == len(fresh) else {}
    matched: list[tuple[Axes, Axes] | tuple[Axes, None] | tuple[None, Axes]] = []
    for panel, axes in old.items():
        other = new.get(renamed.get(panel, panel))
        matched.append((axes, other) if other is not None else (axes, None))
    matched += [(None, new[panel]) for panel in fresh if panel not in renamed.values()]
    return matched


def _as_drawn(name: str, one: Axes, other: Axes) -> bool:
    """Whether limits that follow the data differ by less than one could see."""
    if name not in {"xlim", "ylim"}:
        return False
    ends = [np.column_stack([axes["xlim"], axes["ylim"]]) for axes in (one, other)]
    return bool(np.all(np.abs(in_units(ends[1], one) - in_units(ends[0], one))[:, "xy".index(name[0])] <= TOLERANCE))


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
    if name in {"xlim", "ylim"}:
        yield from _limits(name[0], before, after)
    elif name in {"xlabel", "ylabel", "xscale", "yscale"}:
        yield f"{name[1:]} of the {name[0]} axis is now {_shown(other)} (was {_shown(one)})"
    elif name in {"legend", "figure_legend"}:
        yield from _entries("legend entry", one or [], other or [])
    elif name == "figure_texts":
        yield from _entries("text", one or [], other or [])
    elif name == "texts":
        yield from _texts(one or [], other or [], before)
    elif name in {"points", "areas"}:
        yield from (f"'{curve}' is drawn as {name} now" for curve in other or [] if curve not in (one or []))
        yield from (f"'{curve}' was drawn as {name}" for curve in one or [] if curve not in (other or []))
    elif name == "hidden":
        yield f"axes are now {'hidden' if other else 'visible'}"
    elif name != "thinned":  # says how exact the stored curves are, nothing about the figure
        yield f"{name.replace('_', ' ')} is now {_shown(other)} (was {_shown(one)})"


def _limits(axis: str, before: Axes, after: Axes) -> Iterator[str]:
    one, other = before[f"{axis}lim"], after[f"{axis}lim"]
    if _same(list(one), list(reversed(other))):
        yield f"{axis} axis now runs from {_shown(other[0])} to {_shown(other[1])}, the other way round"
        return
    for verb, was, now in zip(("begins", "ends"), one, other, strict=True):
        if not _same(was, now):
            yield f"{axis} axis now {verb} at {_shown(now)} (was {_shown(was)})"


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
        yield from (f"{what} {_shown(was)} renamed {_shown(now)}" for was, now in zip(gone, fresh, strict=True))
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
                        yield f"text {_shown(old['text'])} moved from {_place(old)} to {_place(new)}"
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


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, int | float) and isinstance(other, int | float):
        return same_number(repr(float(one)), repr(float(other)))
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    return bool(one == other)


def _shown(value: object) -> str:
    if value is None or value == "":
        return "nothing"
    if isinstance(value, list):
        return f"[{', '.join(map(_shown, value))}]"
    if isinstance(value, float):
        return f"{value:.9g}"
    return f"'{value}'" if isinstance(value, str) else str(value)
