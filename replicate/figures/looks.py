"""How the look of a part changed, in words: colour, width, dash, marker, fill, hatch, clip, text and place.

Every sentence has ``{}`` where the name of the part goes, so that parts that changed alike are named together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from replicate.figures.colours import alphas, colour_words, dash_words, same_colour
from replicate.figures.differences import percent
from replicate.figures.places import TOLERANCE, busiest, outlines_apart, points_apart

Mark = Mapping[str, Any]
#: A sentence, and how much something moved as a fraction of its box.
Words = tuple[str, float | None]

_SIZE = 2e-3
_SIGNS = 5e-3
_BLOCK = 0.02
_SYMBOL = 3e-3
# Points; a picture has whole pixels, of which matplotlib has one more or less since 3.10.
_INSIDE, _PIXEL = 0.05, 1.0
_LARGER = 5e-3
_PICTURE = 0.015
_MOST_TEXTS = 12


def look_words(one: Mark, other: Mark) -> Iterator[str]:
    """Yield how two marks differ, wherever they are."""
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
            shown = [mark.get(name) or _USUAL.get(name, "normal") for mark in (other, one)]
            yield f"{called} is now {shown[0]} (was {shown[1]})"
    if not _same_clip(one.get("clip"), other.get("clip")):
        clips = [_clips(mark.get("clip")) for mark in (other, one)]
        different = f"{{}} is clipped {clips[0]} now (was {clips[1]})"
        yield "the shape to which {} is clipped changed" if clips[0] == clips[1] else different
    yield from _symbols(one, other)
    yield from _texts(one, other)
    if "inside" in one and "inside" in other and not _same_box(one, other):
        yield "the drawing of {} has another size or place"
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
_USUAL = {"align": "left baseline", "hatch": "none", "sketch": "none"}


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
    yield from _shapes(one, other)
    scales = one.get("scale", 1.0), other.get("scale", 1.0)
    if {"symbol", "symbols"} & one.keys() != {"symbol", "symbols"} & other.keys():
        return  # said already, or kept in another way by an earlier version
    if isinstance(scales[0], float | int) and isinstance(scales[1], float | int):
        ratio = _reach(other) / _reach(one)
        if abs(ratio - 1.0) > _LARGER:
            yield f"markers of {{}} are {ratio:.3g} times as large now"
        return
    if isinstance(scales[0], dict) and isinstance(scales[1], dict):
        same = not _digests_differ(*scales, relative=max(np.max(scales[0]["means"]), 1e-9))
    else:
        same = _close(*scales)
    if not same or abs(_reach(other) / _reach(one) - 1.0) > _LARGER:
        yield "sizes of the markers of {} changed"


def _shapes(one: Mark, other: Mark) -> Iterator[str]:
    """Say whether markers have another shape, whatever their size is."""
    if "symbols" in one or "symbols" in other:
        kept = [{"symbol", "symbols"} & mark.keys() for mark in (one, other)]
        different = kept[0] != kept[1] or _digests_differ(one["symbols"], other["symbols"])
        if all(kept) and different:
            yield "markers of {} have other shapes now"
    elif "symbol" in one and "symbol" in other:
        reach = _reach(one)
        first, second = (_scaled(mark["symbol"], reach / (_extent(mark["symbol"]) or 1.0)) for mark in (one, other))
        if outlines_apart(first, second, _SYMBOL):
            yield "markers of {} have another shape now"


def _reach(mark: Mark) -> float:
    """Return how far a marker reaches from its place, the largest of them if they have many sizes."""
    scale = mark.get("scale", 1.0)
    largest = np.max(scale["means"]) if isinstance(scale, dict) else np.max(scale)
    return (_extent(mark.get("symbol", {})) or 1.0) * (float(largest) or 1.0)


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
        ", ".join(f"'{text}'" if len(texts) == 1 else text for text in texts[:_MOST_TEXTS])
        + (", …" if len(texts) > _MOST_TEXTS else "")
        for texts in (after, before)
    ]
    if len(before) == len(after) == 1:
        yield f"{{}} now reads {shown[0]} (was {shown[1]})"
    else:
        yield f"{{}} are now {shown[0]} (were {shown[1]})"


def _same_box(one: Mark, other: Mark) -> bool:
    apart = float(np.abs(np.subtract(one["inside"], other["inside"])).max())
    return apart <= (_PIXEL if one["draws"] == "image" else _INSIDE)


def _same_blocks(one: Any, other: Any) -> bool:
    first, second = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
    return first.shape == second.shape and bool(np.abs(second - first).max() <= _BLOCK)


def place_words(one: Mark, other: Mark, tolerance: float, whole: str = "axes") -> Iterator[Words]:
    """Yield how far apart two marks lie, if further than the tolerance, as fractions of the axes or of the figure."""
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
    around = "" if where is None else f", mostly around ({where[0]:.2g}, {where[1]:.2g}) of the {whole}"
    if np.isfinite(apart):
        yield f"{{}} moved by up to {percent(apart)} of the {whole}{around}", apart
    else:
        yield f"{{}} is drawn in other places{around}", 1.0
