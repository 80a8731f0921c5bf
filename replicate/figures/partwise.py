"""Compare what is drawn part by part: which one is new or gone, looks different, moved, or lies over another."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Any

from replicate.figures.differences import Difference, FigureChange, Layer
from replicate.figures.fieldwise import field_words
from replicate.figures.grouping import NUMBERED, are_many, together, without_details
from replicate.figures.legend_words import HANDLES, LEGEND_SIZES, OUTSIDE
from replicate.figures.looks import Mark
from replicate.figures.mark_pairs import Frame, mark_words
from replicate.figures.part_names import names_of_numbered, names_of_sub_figures
from replicate.figures.showing import Part, shows

#: What is said, and whether by the net alone, of which parts, and how far each has moved.
_Sentences = dict[tuple[str, bool], dict[str, float | None]]

_PLACES = {"outline", "places", "at", "texts"}
#: Properties that every part of their kind has; records of earlier releases do not have them.
_ALWAYS = {
    "offset",
    "choice of markers",
    "shape",
    "lines",
    "clipping",
    "turning",
    "orientation",
    "side",
    "height",
    "width",
    HANDLES,
    OUTSIDE,
    *LEGEND_SIZES.values(),
}
#: What properties are called that have shorter names in the record.
_SAID = {
    "along": "place along the axis",
    "across": "horizontal place",
    "up": "vertical place",
    "columns": "number of columns",
    "effects": "path effects",
    "mode": "width",
}
_MANY = {"effects", "line breaks", "lines"}
_VERB = re.compile(r"^(\{\} (?:now |no longer )?)(is|has)\b")
_TITLES = {"title": "in the centre", "left title": "at the left", "right title": "at the right"}
_GAP = 0.01  # of the axes: boxes are rounded
_PLURALS = ("labels", "marks", "lines")


def compare_parts(
    before: Sequence[Part],
    after: Sequence[Part],
    names: Mapping[str, str],
    where: str,
    prefix: str = "",
    *,
    curves: frozenset[str] = frozenset(),
    frame: Frame | None = None,
    other_ticks: Collection[str] = (),
    moved: Collection[str] = (),
) -> list[Difference]:
    """Compare the parts of one panel, or of the figure itself.

    Parameters
    ----------
    names
        Accepted names by new names, of the parts that have another name now.
    where
        What `Difference.where` begins with.
    prefix
        What the sentences begin with, where a figure has several panels.
    curves
        Names of parts that are curves.
    frame
        How places are to be compared.
    other_ticks
        The axes that have other limits or another scale now: their ticks follow from that.
    moved
        The curves that have moved: the markers on them have moved with them.
    """
    old = {str(part["name"]): part for part in before}
    # The entries of a legend follow the names of their curves.
    entries = {f"legend entry '{name}'": f"legend entry '{was}'" for name, was in names.items()}
    frame = frame or Frame()
    earlier = names_of_sub_figures(old, after)
    was = {**entries, **names, **earlier}
    new = {was.get(str(part["name"]), str(part["name"])): part for part in after}
    numbered = names_of_numbered(old, new, lambda one, other: not any(_differ(one, other, frame, follows=False)))
    new = {numbered.get(name, name): part for name, part in new.items()}
    found = list(_come_and_gone(old, new, where, prefix, curves, other_ticks))
    sentences: _Sentences = {}
    for name, part in old.items():
        if name in new and bool(part.get("told")) == bool(new[name].get("told")):  # else it is a curve now, or none
            net = bool(part.get("net") or new[name].get("net"))
            follows = _ticks_of(name, other_ticks) or name in moved
            for words, size in _differ(part, new[name], frame, follows=follows):
                parts = sentences.setdefault((words, net), {})
                parts[name] = size if size is None else max(size, parts.get(name) or 0.0)
    for words, net, parts, others in _said_once(sentences):
        sizes = [size for size in parts.values() if size is not None]
        text = prefix + _sentence(words, list(parts), curves) + (f", and {others} others likewise" if others else "")
        layer: Layer = "net" if net else "named"
        place = f"{where} / {next(iter(parts))}"
        found.append(Difference("look", text, place, size=max(sizes, default=None), layer=layer))
    order, order_now = ([name for name in parts if name not in earlier.values()] for parts in (old, new))
    swaps = _order(order, order_now, curves, _Apart(old, new))
    found += [Difference("look", prefix + text, f"{where} / {name}") for name, text in swaps]
    return found


def _said_once(sentences: _Sentences) -> Iterator[tuple[str, bool, dict[str, float | None], int]]:
    """Yield sentences with their parts, and how many parts without a name of their own they stand for besides."""
    groups: dict[tuple[str, bool], list[tuple[str, dict[str, float | None]]]] = {}
    for (words, net), parts in sentences.items():
        common = without_details(words) if all(map(NUMBERED.fullmatch, parts)) else words
        groups.setdefault((common, net), []).append((words, parts))
    for (_, net), group in groups.items():
        if are_many(len(group)):
            words, parts = group[0]
            yield words, net, parts, sum(len(others) for _, others in group[1:])
        else:
            yield from ((words, net, parts, 0) for words, parts in group)


def _sentence(words: str, names: Sequence[str], curves: frozenset[str]) -> str:
    """Put the names of parts into a sentence, with the verb that fits their number."""
    if len(names) > 1 or _plural(names[0]):
        words = _VERB.sub(lambda match: match[1] + {"is": "are", "has": "have"}[match[2]], words)
        words = words.replace(" of its ", " of their ")
        if words.startswith("{} are "):
            words = words.replace("(was ", "(were ")
    return words.replace("{}", together([_called(name, curves) for name in names]))


def _plural(name: str) -> bool:
    what, of, _ = name.partition(" of the ")
    return (bool(of) and what.endswith(_PLURALS)) or name.startswith(("arrow heads of ", "contours"))


def _come_and_gone(
    old: Mapping[str, Part],
    new: Mapping[str, Part],
    where: str,
    prefix: str,
    curves: frozenset[str],
    other_ticks: Collection[str],
) -> Iterator[Difference]:
    sides: tuple[tuple[Mapping[str, Part], Mapping[str, Part], str, FigureChange], ...] = (
        (old, new, "gone", "removed"),
        (new, old, "new", "new"),
    )
    for parts, others, words, kind in sides:
        for name, part in parts.items():
            told = part.get("told") or not shows(part)
            if name not in others and not told and not _ticks_of(name, other_ticks):
                layer: Layer = "net" if part.get("net") else "named"
                text = f"{prefix}{_called(name, curves)} {'are' if _plural(name) else 'is'} {words}"
                yield Difference(kind, text, f"{where} / {name}", layer=layer)


def come_and_gone_by_name(
    before: Sequence[Part], after: Sequence[Part], names: Mapping[str, str], said: str
) -> Iterator[tuple[str, str]]:
    """Yield what is said by name, has come or gone, and is not mentioned in what was said.

    So does a text that is still there but no longer drawn, and a title that stands elsewhere.

    Parameters
    ----------
    names
        Accepted names by new names, of the parts that have another name now.
    said
        The differences that were found.
    """
    told = [[str(part["name"]) for part in parts if part.get("told") and shows(part)] for parts in (before, after)]
    was, now = told[0], [names.get(name, name) for name in told[1]]
    gone, fresh = ([name for name in one if name not in other] for one, other in ((was, now), (now, was)))
    if len(gone) == len(fresh) == 1 and {*gone, *fresh} <= _TITLES.keys():
        yield gone[0], f"title is now {_TITLES[fresh[0]]} (was {_TITLES[gone[0]]})"
        return
    for parts, words in ((gone, "no longer drawn"), (fresh, "drawn now")):
        yield from ((name, f"{name} is {words}") for name in parts if not _mentioned(name, said))


def _mentioned(name: str, said: str) -> bool:
    first, quote, last = name.partition("'")
    return (quote + last if quote and first in {"text ", "legend entry "} else name) in said


def _ticks_of(name: str, axes: Collection[str]) -> bool:
    return any(name.endswith(f"of the {axis} axis") for axis in axes) and not name.startswith("label")


def _differ(one: Part, other: Part, frame: Frame, *, follows: bool) -> Iterator[tuple[str, float | None]]:
    before, after = one.get("properties", {}), other.get("properties", {})
    for name in dict.fromkeys((*before, *after)):
        if name in _ALWAYS and not (name in before and name in after):
            continue  # an older record does not say
        if not _same(before.get(name), after.get(name)):
            verbs = ("are", "were") if name in _MANY else ("is", "was")
            shown = f"{verbs[0]} now {_shown(after.get(name))} ({verbs[1]} {_shown(before.get(name))})"
            yield f"{_SAID.get(name, name)} of {{}} {shown}", None
    fields = one.get("field", {}), other.get("field", {})
    yield from ((words, None) for words in field_words(*fields))
    loose = bool(one.get("loose") or other.get("loose"))
    marks = one["marks"], other["marks"]
    if follows:
        marks = _anywhere(marks[0]), _anywhere(marks[1])
    if (shows(one) or shows(other)) and all(marks):  # a legend without a frame has none
        yield from mark_words(*marks, frame, loose=loose)


def _anywhere(marks: Sequence[Mark]) -> list[Mark]:
    """Leave out where ticks are and what they read."""
    return [{name: value for name, value in mark.items() if name not in _PLACES} for mark in marks]


class _Apart:
    """Whether two parts overlap in neither state, so that nobody sees which is drawn first."""

    def __init__(self, *states: Mapping[str, Part]) -> None:
        self.states = states

    def __call__(self, one: str, other: str) -> bool:
        return all(_boxes_apart(state[one].get("box"), state[other].get("box")) for state in self.states)


def _boxes_apart(one: Sequence[float] | None, other: Sequence[float] | None) -> bool:
    """Whether boxes (left, bottom, right, top) are known and do not touch."""
    if one is None or other is None:
        return False
    return any(max(one[side], other[side]) > min(one[side + 2], other[side + 2]) + _GAP for side in (0, 1))


def _order(
    before: Sequence[str], after: Sequence[str], curves: frozenset[str], apart: Callable[[str, str], bool]
) -> Iterator[tuple[str, str]]:
    """Say what is drawn over what now, with as few words as the new order needs."""
    place = {name: i for i, name in enumerate(before)}
    common = [name for name in after if name in place]
    kept = _longest_increasing([place[name] for name in common])
    for i, name in enumerate(common):
        if i in kept:
            continue
        below = [other for other in common[:i] if place[other] > place[name] and not apart(name, other)]
        over = [other for other in common[i + 1 :] if place[other] < place[name] and not apart(name, other)]
        verb = "are" if _plural(name) else "is"
        for others, words in ((below, "over"), (over, "below")):
            if others:
                which = next((other for other in reversed(others) if other in curves), others[-1])
                yield name, f"{_called(name, curves)} {verb} drawn {words} {_called(which, curves)} now"
                break


def _longest_increasing(places: Sequence[int]) -> set[int]:
    """Return the indices of a longest increasing subsequence (Fredman, "On computing the length", 1975)."""
    ends: list[int] = []
    index: list[int] = []
    previous: list[int] = []
    for i, place in enumerate(places):
        at = bisect_left(ends, place)
        previous.append(index[at - 1] if at else -1)
        ends[at : at + 1] = [place]
        index[at : at + 1] = [i]
    kept = set()
    i = index[-1] if index else -1
    while i >= 0:
        kept.add(i)
        i = previous[i]
    return kept


def _called(name: str, curves: frozenset[str]) -> str:
    return f"curve '{name}'" if name in curves else name


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, float | int) and isinstance(other, float | int):
        return abs(one - other) <= 2e-3 * max(1.0, abs(one))
    return bool(one == other)


def _shown(value: Any) -> str:
    if value is None:
        return "automatic"
    if isinstance(value, list):
        return f"({', '.join(map(_shown, value))})"
    return f"{value:g}" if isinstance(value, float) else str(value)
