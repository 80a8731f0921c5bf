"""Compare the values of images and meshes: by how much of the colour range they differ, and where mostly."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from replicate.figures.colours import colour_words
from replicate.figures.differences import percent
from replicate.figures.digests import Array

#: Values and means of blocks are the same up to this fraction of the range of the colours ...
TOLERANCE = 5e-4
#: ... and the sums of all values, over the square root of their number, up to this.
_SIGNS = 2e-5

_LIMITS = 1e-6
_ENDS = ("values below the range", "values above the range", "missing values")
_MISSING = -9.0  # stands for a value that is not shown
_STEP = 2e-3  # of the range of the colours
Field = Mapping[str, Any]


def field_words(one: Field, other: Field) -> Iterator[str]:
    """Yield what differs, each a sentence in which ``{}`` stands for the name."""
    if not one or not other:
        if one or other:
            yield f"{{}} {'no longer shows' if one else 'now shows'} values in colours"
        return
    yield from _simple(one, other)
    if one["shape"] != other["shape"]:
        sizes = ["×".join(map(str, side["shape"])) for side in (other, one)]
        yield f"{{}} now has {sizes[0]} values (had {sizes[1]})"
        return
    first, second, spans = _values(one), _values(other), _limits(one)
    if first.shape != second.shape:
        yield "values of {} changed"
        return
    moved = spans is not None and _moved(spans, _limits(other))
    if spans is not None and moved:  # compare the values themselves, in units of the accepted range
        low, span = spans[0], spans[1] - spans[0]
        ends = _limits(other) or spans
        second = np.where(second <= -9.0, second, (second * (ends[1] - ends[0]) + ends[0] - low) / (span or 1.0))
    hidden = (first <= _MISSING) != (second <= _MISSING)
    apart = np.where(hidden, 0.0, np.abs(second - first))
    if hidden.any():
        yield _left_out(one, other)
    if apart.max(initial=0.0) > TOLERANCE:
        yield _at_most(one, apart)
    elif hidden.any():
        return
    elif not moved and np.abs(np.asarray(other["signs"]) - np.asarray(one["signs"])).max() > _SIGNS:
        yield "single values of {} changed"
    elif one.get("masked", 0) != other.get("masked", 0):
        yield _left_out(one, other)


def _simple(one: Field, other: Field) -> Iterator[str]:
    for name, words in (("interpolation", "interpolation"), ("origin", "origin"), ("scale", "colour scale")):
        if one.get(name) != other.get(name):
            yield f"{words} of {{}} is now {other.get(name)} (was {one.get(name)})"
    steps = [np.asarray(side.get("steps", [])) for side in (one, other)]
    same = one.get("scale") == other.get("scale") and steps[0].shape == steps[1].shape
    if same and np.abs(steps[1] - steps[0]).max(initial=0.0) > _STEP:
        yield "colour scale of {} runs otherwise now"
    if abs(one.get("alpha", 1.0) - other.get("alpha", 1.0)) > 2e-3:
        yield f"opacity of {{}} is now {other.get('alpha', 1.0):.3g} (was {one.get('alpha', 1.0):.3g})"
    opacities = np.asarray(one.get("opacities", [])), np.asarray(other.get("opacities", []))
    if opacities[0].shape != opacities[1].shape or np.abs(opacities[1] - opacities[0]).max(initial=0.0) > 2e-3:
        yield "opacities of {} changed"
    yield from _maps(one.get("map", []), other.get("map", []))
    before, after = _limits(one), _limits(other)
    if before is not None and after is not None and _moved(before, after):
        yield "colours of {} now run from {:.6g} to {:.6g} (ran from {:.6g} to {:.6g})".format("{}", *after, *before)
    extents = one.get("extent"), other.get("extent")
    if None not in extents:
        first, second = (np.asarray(extent, dtype=float) for extent in extents)
        if np.abs(second - first).max() > 1e-6 * max(np.ptp(first), 1e-300):
            shown = [", ".join(f"{end:.6g}" for end in extent or ()) for extent in (extents[1], extents[0])]
            yield f"{{}} now covers {shown[0]} (covered {shown[1]})"


def _left_out(one: Field, other: Field) -> str:
    count = other.get("masked", 0)
    return f"{{}} now leaves out {count} value{'' if count == 1 else 's'} (left out {one.get('masked', 0)})"


def _maps(one: Sequence[str], other: Sequence[str]) -> Iterator[str]:
    """Say how colour maps differ; their last three colours are those below, above and without a value."""
    if one[1:] == other[1:]:
        return
    names = [side[0] if side else "nothing" for side in (other, one)]
    ends = [(words, *pair) for words, *pair in zip(_ENDS, one[-3:], other[-3:], strict=False) if pair[0] != pair[1]]
    if names[0] != names[1] or one[1:-3] != other[1:-3]:
        same = f"colours of the colour map {names[0]} of {{}} changed"
        yield same if names[0] == names[1] else f"colour map of {{}} is now {names[0]} (was {names[1]})"
        return
    for words, before, after in ends:
        yield "colour of {} of {{}} changed from {} to {}".format(words, *colour_words(before, after))


def _limits(field: Field) -> tuple[float, float] | None:
    limits = field.get("limits")
    return None if limits is None else (float(limits[0]), float(limits[1]))


def _moved(before: tuple[float, float], after: tuple[float, float] | None) -> bool:
    if after is None:
        return True
    span = abs(before[1] - before[0]) or max(abs(before[0]), 1e-300)
    return max(abs(a - b) for a, b in zip(before, after, strict=True)) > _LIMITS * span


def _values(field: Field) -> Array:
    return np.asarray(field["values"], dtype=float)


def _at_most(one: Field, apart: Array) -> str:
    largest = float(apart.max())
    row, column = np.unravel_index(int(np.argmax(apart)), apart.shape)
    words = f"values of {{}} differ by at most {percent(largest)} of the colour range"
    if apart.shape[1] == 1:
        shape = one["shape"]
        first = int((row + 0.5) / apart.shape[0] * shape[0])
        return f"{words}, mostly around number {first + 1}"
    x, y = (column + 0.5) / apart.shape[1], (row + 0.5) / apart.shape[0]
    if "extent" in one:
        left, right, bottom, top = one["extent"]
        share = 1.0 - y if one.get("origin") == "upper" else y
        return f"{words}, mostly around ({left + x * (right - left):.3g}, {bottom + share * (top - bottom):.3g})"
    rows, columns = one["shape"][:2]
    return f"{words}, mostly around row {int(y * rows) + 1}, column {int(x * columns) + 1}"
