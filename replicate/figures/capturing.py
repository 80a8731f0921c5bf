"""Turn a figure into a record: its curves as data, its axes described, and everything that is drawn as named parts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import Collection, PathCollection
from matplotlib.figure import Figure

from replicate.errors import FigureError
from replicate.figures.describe import said_texts, said_titles
from replicate.figures.drawing import parasites, recorded
from replicate.figures.fields import read_field
from replicate.figures.ink import Ink
from replicate.figures.marks import Box, marks_of
from replicate.figures.parts import Namer, Part
from replicate.figures.readback import read_panel
from replicate.figures.record import REVISION, Record
from replicate.figures.recorder import Drawn
from replicate.figures.stacking import Stack, box_around, extent
from replicate.figures.sub_figures import in_order_of_place, names_of_sub_figures
from replicate.figures.uncommon import path_effects, uncommon

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.text import Text

    from replicate.figures.polylines import Points

_LONGEST_NAME = 24
_TITLE_PAD = 6.0
_TITLES = {"title": "title", "_left_title": "left title", "_right_title": "right title"}


def record_of(figure: Figure) -> Record:
    """Return the record of a figure; `replicate.figures.capture` says more."""
    given: object = figure
    if not isinstance(given, Figure):
        msg = f"a matplotlib figure is needed, not {type(given).__name__}"
        raise FigureError(msg)
    # After `tight_layout()` was called, places follow the sizes of texts.
    engine = type(figure.get_layout_engine()).__name__
    fitted = {"fitted": True} if engine == "PlaceHolderLayoutEngine" else {}
    with recorded(figure) as drawn:
        panels = list(_panels(figure))
        ink = Ink.of(drawn)
        read = {id(axes): read_panel(name, axes, ink) for name, axes in panels}
        outside = _outside_the_axes(figure) if panels else {}
        namers = {
            key: Namer(axes, read[key].names, _described_texts(axes), heads=read[key].heads)
            for key, axes in ((id(axes), axes) for _, axes in panels)
        }
        names = names_of_sub_figures(figure) | _names_of_texts(figure)
        # What the texts of a figure read is said with its first panel, if it has one.
        described_texts = _names_of_texts(figure) if panels else {}
        whole = Namer(figure, {}, described_texts, names, placed=True)
        stacks = {id(owner): Stack() for owner in (figure, *(axes for _, axes in panels if axes.child_axes))}
        called = {id(axes): f"panel '{name}'" for name, axes in panels}
        for call in in_order_of_place(figure, drawn):
            name = _owner(call, namers, whole)
            _pile(call, name, called, stacks, id(figure))
        described = []
        curves: dict[tuple[str, str], Points] = {}
        for _, axes in panels:
            panel = read[id(axes)]
            places: dict[tuple[str, str], list[tuple[float, float]]] = {}
            for owner, curve, x, y in panel.points:
                places.setdefault((owner, curve), []).append((x, y))
            curves |= {key: np.array(value) for key, value in places.items()}
            box = Box.of(axes.bbox.extents)
            parts = [_entry(part, box) for part in namers[id(axes)].parts.values()]
            over = stacks[id(axes)].over() if id(axes) in stacks else {}
            placed = {"position": _position(axes, figure)} | fitted | over
            described.append(panel.description | placed | {"parts": parts})
        if described:
            described[0] |= outside
        frame = Box.of(figure.bbox.extents)
        parts = [_entry(part, frame) for part in whole.parts.values()]
    size = [round(float(side), 3) for side in figure.get_size_inches()]
    about: dict[str, Any] = {"revision": REVISION, "size": size} | fitted
    about |= stacks[id(figure)].over()
    return Record(about | {"parts": parts}, described, curves)


def _panels(figure: Figure) -> Iterator[tuple[str, Axes]]:
    """Name every axes by its title, or by its place where it has none that is short and plain.

    The name stands in every line of the data; one used again gets a number.
    """
    used: dict[str, int] = {}
    for place, axes in enumerate(_all_axes(figure), start=1):
        title = next(iter(said_titles(axes)), "")
        name = " ".join(title.split())
        if not name or len(name) > _LONGEST_NAME or "$" in name:
            name = f"panel {place}"
        used[name] = used.get(name, 0) + 1
        yield (name if used[name] == 1 else f"{name} ({used[name]})"), axes


def _all_axes(figure: Figure) -> list[Axes]:
    """Return all axes that can be seen, those inside others last."""
    found = [axes for axes in figure.axes if axes.get_visible()]
    for axes in found:  # grows while it is walked
        inside = (*getattr(axes, "child_axes", ()), *parasites(axes))
        found += [child for child in inside if child.get_visible() and child not in found]
    return found


def _owner(call: Drawn, namers: dict[int, Namer], whole: Namer) -> str:
    """Hand a mark to the panel it was drawn in, or to the figure; return the name of its part."""
    chain: tuple[Artist, ...] = call.artists
    inner = max((i for i, artist in enumerate(chain) if id(artist) in namers), default=None)
    guest = chain[inner + 1].axes if inner is not None and len(chain) > inner + 1 else None
    if inner is not None and guest in parasites(chain[inner]):  # whose artists the host draws
        return namers[id(guest)].add(call, chain[inner + 1 :])
    if inner is not None:
        axes = chain[inner]
        return namers[id(axes)].add(call, chain[inner + 1 :])
    # Sub-figures are not parts themselves.
    below = [artist for artist in chain[1:] if not hasattr(artist, "subplots")]
    return whole.add(call, tuple(below))


def _pile(call: Drawn, name: str, called: dict[int, str], stacks: dict[int, Stack], figure: int) -> None:
    """Note where a mark lies among what the figure, and each panel with insets, consists of."""
    owners: list[Any] = [artist for artist in call.artists if id(artist) in called]
    for owner, inner in zip([figure, *map(id, owners)], [*owners, None], strict=True):
        if owner not in stacks:
            continue
        if inner is None:
            stacks[owner].add(name, extent(call))
        else:
            left, bottom, right, top = inner.bbox.extents
            stacks[owner].add(called[id(inner)], (left, bottom, right, top))


def _names_of_texts(figure: Figure) -> dict[int, str]:
    title = getattr(figure, "_suptitle", None)
    names = {id(text): f"text '{text.get_text()}'" for text in figure.texts}
    return names if title is None else names | {id(title): "figure title"}


def _described_texts(axes: Axes) -> dict[int, str]:
    names = {id(text): f"text '{_one_line(text.get_text())}'" for text in (*said_texts(axes), *_empty_texts(axes))}
    return names | {id(getattr(axes, name)): words for name, words in _TITLES.items() if hasattr(axes, name)}


def _empty_texts(axes: Axes) -> list[Text]:
    """Return texts that say nothing; an arrow may belong to one."""
    return [text for text in axes.texts if not text.get_text()]


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _entry(part: Part, box: Box) -> dict[str, Any]:
    """Return a part for the record."""
    entry: dict[str, Any] = {"name": part.name, "class": type(part.owner).__name__}
    entry |= {flag: True for flag in ("told", "loose") if getattr(part, flag)}
    if not part.named:
        entry["net"] = True
    texts = (call.artists[-1] for call in part.drawn if call.kind == "text" and call.artists)
    special = uncommon(part.owner) | path_effects([part.owner, *texts])
    properties = dict(part.properties) | _placed_by_hand(part) | special
    if properties:
        entry["properties"] = properties
    field = read_field(part.owner) or next(
        (read_field(call.artists[-1]) for call in part.drawn if call.kind == "image" and call.artists), {}
    )
    if field:
        entry["field"] = field
    around = box_around(part.drawn)
    if around is not None:
        entry["box"] = [round(float(end), 2) for end in box.units(np.reshape(around, (2, 2))).ravel()]
    where = part.placed or part.told
    entry["marks"] = marks = marks_of(part.drawn, box, where=where, loose=part.loose, outlined=not part.told)
    if field:
        _leave_colours_to(field, marks)
    if part.told:
        _leave_place_to_name(part, marks)
    if not part.turned:
        for mark in marks:
            mark.pop("angle", None)
    if part.name.startswith(("tick labels of the x", "tick labels of the y", "minor tick labels")):
        _along_the_axis(marks, part)
    return entry


def _leave_colours_to(field: dict[str, Any], marks: list[dict[str, Any]]) -> None:
    """Leave out what follows from the values that are shown in colours."""
    for mark in marks:
        for name in ("image", "face", *(("at",) if "extent" in field else ()), *_edges(mark)):
            mark.pop(name, None)


def _leave_place_to_name(part: Part, marks: list[dict[str, Any]]) -> None:
    """Leave out what a curve or a text says, and where, which is compared by its name."""
    lines = any(mark["draws"] == "path" for mark in marks)
    for mark in marks:
        mark.pop("texts", None)
        if not (lines and mark["draws"] == "markers"):  # which points of a line are marked is not
            mark.pop("places", None)
        if _is_shape(part.owner):  # one shape alone is handed to the renderer as a marker
            mark.pop("symbol", None)
        if not part.placed:
            mark.pop("at", None)


def _is_shape(artist: Artist) -> bool:
    return isinstance(artist, Collection) and not isinstance(artist, PathCollection)


def _along_the_axis(marks: list[dict[str, Any]], part: Part) -> None:
    """Keep where tick labels stand along their axis, and at which end of the other one; the pad is said in points."""
    axes: Any = part.owner.axes
    across = {"x": 1, "y": 0}.get(getattr(part.owner, "axis_name", ""))
    if axes is None or axes.name != "rectilinear" or across is None:
        return
    for mark in marks:
        for place in mark.get("at", ()):
            place[across] = float(round(place[across])) + 0.0


def _edges(mark: dict[str, Any]) -> tuple[str, ...]:
    """Edges that have the colours of what they surround say no more than those."""
    return ("edge",) if not isinstance(mark.get("edge", ""), str) else ()


def _placed_by_hand(part: Part) -> dict[str, Any]:
    """Say where a title or a label stands as far as somebody said so; the rest follows other texts."""
    text: Any = part.owner
    if part.name.endswith("title") and part.told and hasattr(text, "get_position"):
        x, y = text.get_position()
        fixed = getattr(text.axes, "_autotitlepos", True) is False if text.axes is not None else True
        pad = _title_pad(text)
        return {"across": round(float(x), 4)} | ({"up": round(float(y), 4)} if fixed else {}) | pad
    if part.name.startswith("label of the ") and hasattr(text, "get_position") and part.name[13] in "xy":
        along = part.name[13] == "y"
        return {"along": round(float(text.get_position()[along]), 4)}
    return {}


def _title_pad(text: Any) -> dict[str, Any]:
    """Return how far above the axes a title was put, where that is not matplotlib's own."""
    shift = getattr(getattr(text.axes, "titleOffsetTrans", None), "_t", None)
    pad = _TITLE_PAD if shift is None else 72.0 * float(shift[1])
    return {} if abs(pad - _TITLE_PAD) < 1e-6 else {"pad": round(pad, 2)}


def _position(axes: Axes, figure: Figure) -> list[float]:
    """Return left, bottom, width and height as fractions of the figure, before the aspect trims the axes."""
    box = axes.bbox
    if axes.get_aspect() != "auto" and axes.get_axes_locator() is None:
        parent: Any = axes.get_figure()
        box = axes.get_position(original=True).transformed(parent.transSubfigure)
    frame = Box.of(figure.bbox.extents)
    low, high = frame.units(np.reshape(box.extents, (2, 2)))
    return [round(float(part), 4) for part in (*low, *(high - low))]


def _outside_the_axes(figure: Figure) -> dict[str, Any]:
    """Describe texts and legends that belong to the figure as a whole; they are kept with the first panel."""
    title = figure.get_suptitle()
    texts = [text.get_text() for text in figure.texts if text.get_text() not in {"", title}]
    legends = [entry.get_text() for legend in figure.legends for entry in legend.get_texts()]
    found = {"figure_title": title, "figure_texts": texts, "figure_legend": legends}
    return {name: value for name, value in found.items() if value}
