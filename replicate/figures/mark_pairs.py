"""Which mark of a part in one state is which in the other, and how those that belong together differ."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from replicate.figures.grouping import are_many, without_details
from replicate.figures.looks import Mark, Words, look_words, place_words
from replicate.figures.places import LOOSE, TOLERANCE

_CALLED = {"path": "line", "markers": "markers", "text": "text", "image": "picture", "collection": "shapes"}
_PLACES = ("outline", "places", "at", "texts")


@dataclass(frozen=True)
class Frame:
    """How places of two states are to be compared.

    Attributes
    ----------
    slack
        Factor on the tolerance of places; above 1 where the whole layout follows the size of texts.
    shift, stretch
        Where the limits of the axes are others now: what lay at ``p`` of the accepted axes and stayed with the data
        lies at ``(p - shift) / stretch`` now.
    zoomed
        Whether they are.
    whole
        What places are fractions of.
    """

    slack: float = 1.0
    shift: tuple[float, float] = (0.0, 0.0)
    stretch: tuple[float, float] = (1.0, 1.0)
    whole: str = "axes"

    @property
    def zoomed(self) -> bool:
        """Whether the limits are others."""
        return (self.shift, self.stretch) != ((0.0, 0.0), (1.0, 1.0))

    def accepted(self, mark: Mark) -> Mark:
        """Return a mark of the new state where it would lie in the accepted one, had it stayed with the data."""
        moved = dict(mark)
        for name in ("outline", "places"):
            if "points" in mark.get(name, {}):
                moved[name] = {"points": [self._accepted(point) for point in mark[name]["points"]]}
        if "at" in mark:
            moved["at"] = [self._accepted(point) for point in mark["at"]]
        return moved

    def _accepted(self, point: Sequence[float] | None) -> list[float] | None:
        if point is None:
            return None
        return [shift + part * stretch for part, shift, stretch in zip(point, self.shift, self.stretch, strict=True)]


def mark_words(one: Sequence[Mark], other: Sequence[Mark], frame: Frame, *, loose: bool) -> Iterator[Words]:
    """Yield how the marks of one part differ.

    Parameters
    ----------
    loose
        Whether places follow the size of texts.
    """
    tolerance = (LOOSE if loose else TOLERANCE) * frame.slack
    for kind in dict.fromkeys(_kind(mark) for mark in (*one, *other)):
        first, second = ([mark for mark in marks if _kind(mark) == kind] for marks in (one, other))
        if len(first) != len(second):
            yield from _unlike(kind, first, second, tolerance, frame)
        else:
            yield from _pairs(first, second, tolerance, frame)


def _kind(mark: Mark) -> str:
    """Return what a mark is; one marker alone, or many of one look, come to the renderer in another way than others."""
    return "markers" if "symbol" in mark or "symbols" in mark else str(mark["draws"])


def _pairs(first: Sequence[Mark], second: Sequence[Mark], tolerance: float, frame: Frame) -> Iterator[Words]:
    """Say how marks differ: how far they moved once, and so what many say in other numbers and colours."""
    groups: dict[str, list[Words]] = {}
    for before, after in zip(first, second, strict=True):
        for words, size in _pair(before, after, tolerance, frame):
            common = words if "texts" in before else without_details(words)
            groups.setdefault(common if size is None else "moved", []).append((words, size))
    for name, group in groups.items():
        different = dict.fromkeys(words for words, _ in group)
        if name == "moved":  # by up to so much
            yield max(group, key=lambda said: said[1] or 0.0)
        elif are_many(len(different)):
            yield f"{group[0][0]}, and {len(different) - 1} others likewise", None
        else:
            yield from group


def _pair(before: Mark, after: Mark, tolerance: float, frame: Frame) -> Iterator[Words]:
    yield from ((text, None) for text in look_words(before, after))
    moved = list(place_words(before, after, tolerance, frame.whole))
    if moved and frame.zoomed:  # what stayed with the data has not moved, nor what stayed with the axes
        digest = any("pieces" in after.get(name, {}) for name in ("outline", "places"))
        moved = [] if digest else list(place_words(before, frame.accepted(after), tolerance, frame.whole))
    yield from moved


def _unlike(
    kind: str, first: Sequence[Mark], second: Sequence[Mark], tolerance: float, frame: Frame
) -> Iterator[Words]:
    """Say how marks of one kind differ that have more looks in one state than in the other."""
    if kind == "text":
        each = _each(first), _each(second)
        if [mark["texts"] for mark in each[0]] == [mark["texts"] for mark in each[1]]:
            yield from _text_by_text(*each, tolerance, frame)
            return
    left, right = _joined(first), _joined(second)
    if len(left) != len(right):
        yield from _counts(kind, first, second, *_unpaired(left, right))
        return
    yield from _pairs(left, right, tolerance, frame)


def _each(marks: Sequence[Mark]) -> list[dict[str, Any]]:
    """Return a mark for every single text."""
    found: list[dict[str, Any]] = []
    for mark in marks:
        places = mark.get("at", [])
        for i, text in enumerate(mark.get("texts", ())):
            found.append({**mark, "texts": [text], **({"at": [places[i]]} if i < len(places) else {})})
    return found


def _text_by_text(first: Sequence[Mark], second: Sequence[Mark], tolerance: float, frame: Frame) -> Iterator[Words]:
    said: dict[str, tuple[list[str], float | None]] = {}
    for before, after in zip(first, second, strict=True):
        for words, size in _pair(before, after, tolerance, frame):
            said.setdefault(words, ([], size))[0].append(repr(after["texts"][0]))
    for words, (texts, size) in said.items():
        yield (words if len(texts) == len(first) else f"{words}: {', '.join(texts)}"), size


def _joined(marks: Sequence[Mark]) -> list[Mark]:
    """Put together what has one look, though something else was drawn in between."""
    found: list[dict[str, Any]] = []
    for mark in marks:
        look = _look(mark)
        same = next((one for one in found if _look(one) == look and _can_join(one, mark)), None)
        if same is None:
            found.append(dict(mark))
            continue
        for name in ("outline", "places"):
            if name in mark:
                gap = [None] if name == "outline" else []
                same[name] = {"points": [*same[name]["points"], *gap, *mark[name]["points"]]}
        for name in ("at", "texts"):
            if name in mark:
                same[name] = [*same[name], *mark[name]]
    return list(found)


def _look(mark: Mark) -> Mapping[str, Any]:
    return {name: value for name, value in mark.items() if name not in _PLACES}


def _can_join(one: Mark, other: Mark) -> bool:
    kept = all("points" in mark[name] for mark in (one, other) for name in ("outline", "places") if name in mark)
    return kept and (one.keys() == other.keys())


def _unpaired(first: Sequence[Mark], second: Sequence[Mark]) -> tuple[list[Mark], list[Mark]]:
    """Leave out the marks that both have."""
    left, right = list(first), list(second)
    for mark in first:
        for candidate in right:
            if not list(look_words(mark, candidate)) and not list(place_words(mark, candidate, TOLERANCE)):
                left.remove(mark)
                right.remove(candidate)
                break
    return left, right


def _counts(
    kind: str, first: Sequence[Mark], second: Sequence[Mark], gone: Sequence[Mark], fresh: Sequence[Mark]
) -> Iterator[Words]:
    what = _CALLED.get(kind, kind)
    if not gone and fresh:
        yield f"{{}} now has {'more ' + _plural(what) if first else _indefinite(what, len(fresh))}", None
    elif gone and not fresh:
        yield f"{{}} no longer has {'some of its ' + _plural(what) if second else _indefinite(what, len(gone))}", None
    else:
        yield f"{{}} has {what} of {len(second)} looks now (had {len(first)})", None


def _indefinite(what: str, count: int) -> str:
    return _plural(what) if count > 1 or what.endswith("s") else f"a {what}"


def _plural(what: str) -> str:
    return what if what.endswith("s") else f"{what}s"
