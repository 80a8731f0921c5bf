"""How the look of a part changed, in words: colour, width, dash, marker, fill, hatch, clip, text and place.

Every sentence has ``{}`` where the name of the part goes, so that parts that changed alike are named together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from replicate.figures.colours import alphas, colour_words, dash_words, same_colour
from replicate.figures.differences import percent
from replicate.figures.places import LOOSE, TOLERANCE, busiest, outlines_apart, points_apart

Mark = Mapping[str, Any]
#: A sentence, and how much something moved as a fraction of its box.
Words = tuple[str, float | None]

_SIZE = 2e-3
_SIGNS = 5e-3
_BLOCK = 0.02
_SYMBOL = 3e-3
_PICTURE = 0.015
_MOST_TEXTS = 12
_CALLED = {"path": "line", "markers": "markers", "text": "text", "image": "picture", "collection": "shapes"}


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
    """

    slack: float = 1.0
    shift: tuple[float, float] = (0.0, 0.0)
    stretch: tuple[float, float] = (1.0, 1.0)

    @property
    def zoomed(self) -> bool:
        """Whether the limits are others."""
        return self != Frame(self.slack)

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
    kinds = [mark["draws"] for mark in (*one, *other)]
    for kind in dict.fromkeys(kinds):
        first, second = ([mark for mark in marks if mark["draws"] == kind] for marks in (one, other))
        if len(first) != len(second):
            yield from _counts(kind, *_unpaired(first, second))
            continue
        for before, after in zip(first, second, strict=True):
            words = list(_look(before, after))
            yield from ((text, None) for text in words)
            moved = list(_place(before, after, tolerance))
            if moved and frame.zoomed:  # what stayed with the data has not moved, nor what stayed with the axes
                digest = any("pieces" in after.get(name, {}) for name in ("outline", "places"))
                moved = [] if digest else list(_place(before, frame.accepted(after), tolerance))
            yield from moved


def _unpaired(first: Sequence[Mark], second: Sequence[Mark]) -> tuple[list[Mark], list[Mark]]:
    """Leave out the marks that both have."""
    left, right = list(first), list(second)
    for mark in first:
        for candidate in right:
            if not list(_look(mark, candidate)) and not list(_place(mark, candidate, TOLERANCE)):
                left.remove(mark)
                right.remove(candidate)
                break
    return left, right


def _counts(kind: str, first: Sequence[Mark], second: Sequence[Mark]) -> Iterator[Words]:
    what = _CALLED.get(kind, kind)
    if not first and second:
        yield f"{{}} now has {_indefinite(what, len(second))}", None
    elif first and not second:
        yield f"{{}} no longer has {_indefinite(what, len(first))}", None
    else:
        yield f"{{}} is drawn with {len(second)} looks of its {what} where it had {len(first)}", None


def _indefinite(what: str, count: int) -> str:
    if count > 1:
        return f"{count} more {what}s".replace("ss", "s")
    return what if what.endswith("s") else f"a {what}"


def _look(one: Mark, other: Mark) -> Iterator[str]:
    yield from _colours(one, other)
    for name, words in _NUMBERS.items():
        yield from _numbers(name, words, one, other)
    before, after = one.get("dash", []), other.get("dash", [])
    if "edge" in one and "edge" in other and not _same_dash(before, after):
        dashes = [_dashes(mark) for mark in (other, one)]
        yield "dashes of {} changed" if dashes[0] == dashes[1] else "{{}} is {} now (was {})".format(*dashes)
    for name, called in _WORDS.items():
        if name in {"cap", "join"} and not (name in one and name in other):
            continue  # thin lines do not say
        if one.get(name, "") != other.get(name, ""):
            yield f"{called} is now {other.get(name) or 'normal'} (was {one.get(name) or 'normal'})"
    if not _same_clip(one.get("clip"), other.get("clip")):
        clips = [_clips(mark.get("clip")) for mark in (other, one)]
        different = f"{{}} is clipped {clips[0]} now (was {clips[1]})"
        yield "the shape to which {} is clipped changed" if clips[0] == clips[1] else different
    yield from _symbols(one, other)
    yield from _texts(one, other)
    if "image" in one and "image" in other and not _same_blocks(one["image"], other["image"]):
        yield "the picture of {} shows something else"


_NUMBERS = {
    "width": ("line of {} is", "pt wide"),
    "size": ("{} has a size of", "pt"),
    "angle": ("{} is turned by", "°"),
}
_WORDS = {
    "hatch": "hatch of {}",
    "weight": "weight of {}",
    "slant": "slant of {}",
    "align": "alignment of {}",
    "cap": "end of the lines of {}",
    "join": "corner of the lines of {}",
    "sketch": "sketch style of {}",
}


def _colours(one: Mark, other: Mark) -> Iterator[str]:
    """Say how colours changed: once if line and fill changed alike."""
    said: dict[str, str] = {}
    for name in ("edge", "face"):
        words = _colour(name, one, other)
        if words:
            said[name] = words
    if len(set(said.values())) == 1 and len(said) == 2:
        yield said["edge"].replace("?", "colour")
        return
    both = all("edge" in mark and "face" in mark for mark in (one, other))
    for name, words in said.items():
        yield words.replace("?", ("fill colour" if name == "face" else "line colour") if both else "colour")


def _colour(name: str, one: Mark, other: Mark) -> str:
    """Return how the colour of a line or of a fill changed, with ``?`` for which of them it is."""
    before, after = one.get(name), other.get(name)
    if (before is None) != (after is None):
        return f"{{}} has {'no' if after is None else 'a'} {'line' if name == 'edge' else 'fill'} now"
    if isinstance(before, str) and isinstance(after, str):
        return _one_colour(before, after)
    if isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        differ = [place for place, (a, b) in enumerate(zip(before, after, strict=True)) if not same_colour(a, b)]
        if not differ:
            return ""
        names = colour_words(before[differ[0]], after[differ[0]])
        count = f"{len(differ)} of {len(before)} colours" if len(differ) > 1 else "one colour"
        return f"{count} of {{}} changed, number {differ[0] + 1} from {names[0]} to {names[1]}"
    same = before is after or (
        isinstance(before, dict) and isinstance(after, dict) and not _digests_differ(before, after)
    )
    return "" if same else "?s of {} changed"


def _one_colour(before: str, after: str) -> str:
    if same_colour(before, after):
        return ""
    opacity = alphas(before, after)
    if opacity is not None:
        return f"opacity of {{}} is now {opacity[1]:g} (was {opacity[0]:g})"
    names = colour_words(before, after)
    return f"? of {{}} changed from {names[0]} to {names[1]}"


def _digests_differ(one: Mapping[str, Any], other: Mapping[str, Any], relative: float = 1.0) -> bool:
    if one["n"] != other["n"]:
        return True
    means = np.abs(np.asarray(other["means"]) - np.asarray(one["means"])).max()
    signs = np.abs(np.asarray(other["signs"]) - np.asarray(one["signs"])).max()
    return bool(means > _SIGNS * relative or signs > _SIGNS * relative)


def _numbers(name: str, words: tuple[str, str], one: Mark, other: Mark) -> Iterator[str]:
    before, after = one.get(name, 0.0), other.get(name, 0.0)
    if name == "width" and not ("edge" in one and "edge" in other):
        return
    if isinstance(before, dict) and isinstance(after, dict):
        if _digests_differ(before, after, relative=max(np.max(before["means"]), 1e-9)):
            yield f"{name}s of {{}} changed"
        return
    if isinstance(before, list) or isinstance(after, list) or isinstance(before, dict) or isinstance(after, dict):
        if before != after and not _close(before, after):
            yield f"{name}s of {{}} changed"
        return
    if not _close(before, after):
        yield f"{words[0]} {after:g} {words[1]} now (was {before:g})"


def _close(one: Any, other: Any) -> bool:
    try:
        first, second = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
    except (TypeError, ValueError):
        return False
    return first.shape == second.shape and bool(np.allclose(first, second, rtol=_SIZE, atol=_SIZE))


def _same_dash(one: Any, other: Any) -> bool:
    return bool(one == other) or (len(one) == len(other) and _close(one, other))


def _dashes(mark: Mark) -> str:
    dash, width = mark.get("dash", []), mark.get("width", 1.0)
    if dash and isinstance(dash[0], list):
        return "dashed in many ways"
    return dash_words(dash, width if isinstance(width, float | int) else 1.0)


def _same_clip(one: Any, other: Any) -> bool:
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return outlines_apart(one, other, 5.0 * TOLERANCE) == 0.0
    return bool(one == other)


def _clips(clip: Any) -> str:
    if clip is None:
        return "to its axes"
    return "nowhere" if clip == "none" else "to a shape of its own"


def _symbols(one: Mark, other: Mark) -> Iterator[str]:
    before, after = one.get("symbol"), other.get("symbol")
    if before is None or after is None:
        return
    extents = [_extent(symbol) for symbol in (before, after)]
    ratio = (extents[1] / extents[0] if extents[0] else 1.0) or 1.0
    if outlines_apart(before, _scaled(after, 1.0 / ratio), _SYMBOL):
        yield "markers of {} have another shape now"
    elif abs(ratio - 1.0) > 0.01:
        yield f"markers of {{}} are {ratio:.3g} times as large now"
    scales = one.get("scale", 1.0), other.get("scale", 1.0)
    if isinstance(scales[0], float | int) and isinstance(scales[1], float | int):
        if not _close(*scales):
            yield f"markers of {{}} are {scales[1] / (scales[0] or 1.0):.3g} times as large now"
    elif isinstance(scales[0], dict) and isinstance(scales[1], dict):
        if _digests_differ(*scales, relative=max(np.max(scales[0]["means"]), 1e-9)):
            yield "sizes of the markers of {} changed"
    elif not _close(*scales):
        yield "sizes of the markers of {} changed"


def _extent(symbol: Mapping[str, Any]) -> float:
    points = [point for point in symbol.get("points", ()) if point is not None]
    return float(np.abs(np.asarray(points)).max()) if points else 0.0


def _scaled(symbol: Mapping[str, Any], factor: float) -> Mapping[str, Any]:
    if "points" not in symbol:
        return symbol
    return {"points": [None if p is None else [p[0] * factor, p[1] * factor] for p in symbol["points"]]}


def _texts(one: Mark, other: Mark) -> Iterator[str]:
    before, after = one.get("texts"), other.get("texts")
    if before is None or after is None or before == after:
        return
    shown = [
        ", ".join(repr(text) if len(texts) == 1 else text for text in texts[:_MOST_TEXTS])
        + (", …" if len(texts) > _MOST_TEXTS else "")
        for texts in (after, before)
    ]
    if len(before) == len(after) == 1:
        yield f"{{}} now reads {shown[0]} (was {shown[1]})"
    else:
        yield f"{{}} are now {shown[0]} (were {shown[1]})"


def _same_blocks(one: Any, other: Any) -> bool:
    first, second = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
    return first.shape == second.shape and bool(np.abs(second - first).max() <= _BLOCK)


def _place(one: Mark, other: Mark, tolerance: float) -> Iterator[Words]:
    apart, where = 0.0, None
    if "outline" in one and "outline" in other:
        apart = outlines_apart(one["outline"], other["outline"], tolerance)
        where = busiest(one["outline"], other["outline"])
    elif "places" in one and "places" in other:
        apart = points_apart(one["places"], other["places"], tolerance)
        where = busiest(one["places"], other["places"])
    elif "at" in one and "at" in other and len(one["at"]) == len(other["at"]):
        apart = float(np.abs(np.asarray(other["at"]) - np.asarray(one["at"])).max(initial=0.0))
        apart = apart if apart > (max(tolerance, _PICTURE) if one["draws"] == "image" else 2.0 * tolerance) else 0.0
    if not apart:
        return
    around = "" if where is None else f", mostly around ({where[0]:.2g}, {where[1]:.2g}) of the axes"
    if np.isfinite(apart):
        yield f"{{}} moved by up to {percent(apart)} of the axes{around}", apart
    else:
        yield f"{{}} is drawn in other places{around}", 1.0
