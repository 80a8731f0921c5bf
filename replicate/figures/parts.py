"""Name the parts of a figure as a person would: the curve by its label, "tick labels of the x axis", "left spine".

Everything that is drawn belongs to one part. A part whose kind is not known here has its class for a name; it is
compared all the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axis import Axis
from matplotlib.collections import LineCollection, PathCollection, PolyCollection, QuadMesh
from matplotlib.contour import ContourSet
from matplotlib.image import _ImageBase
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.offsetbox import OffsetBox, PackerBase
from matplotlib.patches import Patch
from matplotlib.spines import Spine
from matplotlib.table import Table
from matplotlib.text import Text

from replicate.figures.contours import placed_by_hand
from replicate.figures.describe import said_label
from replicate.figures.marks import Box
from replicate.figures.recorder import Drawn
from replicate.figures.style_numbers import style_numbers

if TYPE_CHECKING:
    from matplotlib.artist import Artist

_TICKS = {"gridline": "grid lines", "label1": "tick labels", "label2": "tick labels"}
_LONGEST = 40
_SHRINK = 2.0  # points

#: What a class of matplotlib is called where it has no label; the first that fits counts.
_WORDS: Sequence[tuple[type, str]] = (
    (_ImageBase, "image"),
    (QuadMesh, "mesh"),
    (ContourSet, "contours"),
    (PathCollection, "points"),
    (LineCollection, "lines"),
    (PolyCollection, "area"),
    (Line2D, "line"),
    (Table, "table"),
    (Legend, "legend"),
    (Patch, "shape"),
)


@dataclass
class Part:
    """What is drawn for one thing that has a name.

    Attributes
    ----------
    named
        Whether a reader says what it is. The others are seen by the safety net only.
    told
        Whether its coming and going is said elsewhere, as that of curves and texts is.
    placed
        Whether where it is drawn is compared here, and not as data or by what it follows.
    loose
        Whether its place follows the size of texts.
    turned
        Whether its angle is compared.
    properties
        What else can be said of it.
    """

    name: str
    owner: Artist
    named: bool = True
    told: bool = False
    placed: bool = True
    loose: bool = False
    turned: bool = True
    properties: dict[str, Any] = field(default_factory=dict)
    drawn: list[Drawn] = field(default_factory=list)


class Namer:
    """Names what belongs to one panel, or to the figure itself.

    Parameters
    ----------
    curves
        The names of the artists that are compared as curves, by identity.
    described
        The texts whose words and places are compared by name, by identity.
    placed
        Whether just their words are, and not their places.
    names
        What other artists are called, by identity.
    heads
        Of the arrow heads of stream plots, whose they are, and the first of them, by identity.
    """

    def __init__(
        self,
        owner: Any,
        curves: Mapping[int, str],
        described: Mapping[int, str],
        names: Mapping[int, str] | None = None,
        heads: Mapping[int, tuple[str, Artist]] | None = None,
        *,
        placed: bool = False,
    ) -> None:
        self.owner, self.curves, self.described, self.placed = owner, curves, described, placed
        self.names, self.heads = names or {}, heads or {}
        self.parts: dict[str, Part] = {}
        self._numbers: dict[str, int] = {}
        self._given: dict[tuple[int, str], str] = {}

    def add(self, drawn: Drawn, chain: tuple[Artist, ...]) -> str:
        """Add a mark to the part it belongs to, and return that part's name.

        Parameters
        ----------
        chain
            Who draws: from the child of the panel down to the artist itself.
        """
        key = self._key(self._part(chain, drawn))
        self.parts[key].drawn.append(drawn)
        return key

    def _key(self, part: Part) -> str:
        """Return the name of a part that no other one has, and keep the part if it is new."""
        key = self._given.get((id(part.owner), part.name))
        if key is None:
            self._numbers[part.name] = count = self._numbers.get(part.name, 0) + 1
            key = part.name if count == 1 else f"{part.name} ({count})"
            self._given[id(part.owner), part.name] = key
            part.name = key
            self.parts[key] = part
        return key

    def _part(self, chain: tuple[Artist, ...], drawn: Drawn) -> Part:
        if not chain:
            return Part("frame", self.owner)
        top = chain[0]
        if id(top) in self.curves:
            return Part(self.curves[id(top)], top, told=True, placed=False)
        if id(top) in self.heads:
            name, first = self.heads[id(top)]
            style = _arrow_style(top)
            return Part(f"arrow heads of {name}", first, placed=False, properties=style | {"size": style.pop("head")})
        if top is getattr(self.owner, "patch", None):
            return Part("background", top)
        match top:
            case Axis():
                part = _of_axis(top, chain)
            case Legend():
                part = self._of_legend(top, chain)
            case Text():
                part = self._of_text(top, chain, drawn)
            case Spine():
                part = Part(f"{top.spine_type} spine", top)
            case Table():
                part = _of_table(self._name(top), top, chain)
            case _:
                loose = any(isinstance(artist, OffsetBox) for artist in chain)
                part = Part(self._name(top), top, named=_word(top) is not None, loose=loose)
        return part

    def _name(self, artist: Artist) -> str:
        if id(artist) in self.names:
            return self.names[id(artist)]
        label = said_label(artist)
        if label:
            return label
        key = (id(artist), "")
        if key not in self._given:
            word = _word(artist) or type(artist).__name__
            taken = self.curves.values()
            self._given[key] = next(name for name in self._further(word) if name not in taken)
        return self._given[key]

    def _further(self, word: str) -> Iterator[str]:
        """Yield names with numbers that have not been given yet."""
        while True:
            self._numbers[f"{word} #"] = count = self._numbers.get(f"{word} #", 0) + 1
            yield f"{word} {count}"

    def _of_legend(self, legend: Legend, chain: tuple[Artist, ...]) -> Part:
        first = legend is getattr(self.owner, "legend_", legend)
        name = "legend" if first else self._name(legend)
        whole = Part(name, legend, placed=False, properties=_legend_properties(legend))
        packer: Any = next((artist for artist in reversed(chain) if isinstance(artist, PackerBase)), None)
        if packer is None:
            return whole
        self._key(whole)  # whether it has a frame or not
        said = [_shortened(text.get_text()) for text in _texts_in(packer)]
        box: Any = getattr(legend, "_legend_box", None)
        if packer is box:
            return Part(f"title of the {name}", packer, placed=False)
        return Part(f"{name} entry '{said[0] if said else ''}'", packer, told=first, placed=False)

    def _of_text(self, text: Text, chain: tuple[Artist, ...], drawn: Drawn) -> Part:
        told = id(text) in self.described
        name = self.described.get(id(text)) or self.names.get(id(text)) or f"text '{_shortened(text.get_text())}'"
        if chain[-1] is not text or drawn.kind != "text":
            box = text.get_bbox_patch()
            if box is None or chain[-1] is not box:
                return Part(
                    f"arrow of {name}", chain[-1], loose=bool(text.get_text()), properties=_arrow_style(chain[-1])
                )
            style = box.get_boxstyle()
            shape = {"style": type(style).__name__, "shape": style_numbers(style) or "usual"}
            return Part(f"box of {name}", box, placed=False, properties=shape)
        if not told and not self.placed and text in self.owner.texts:  # of a contour: width and font decide where it is
            turned = {"orientation": "upside down" if 91.0 < text.get_rotation() % 360.0 < 269.0 else "upright"}
            hand = placed_by_hand(text, self.owner)
            return Part(
                f"label '{_shortened(text.get_text())}'", text, placed=hand, loose=hand, turned=False, properties=turned
            )
        solid = hasattr(text, "get_position_3d")  # its data say two of three coordinates
        clip = {"clipping": "none" if drawn.clip_box is None and drawn.clip_path is None else "to the axes"}
        return Part(name, text, told=told, placed=not told or self.placed or solid, properties=clip)


def _arrow_style(arrow: Any) -> dict[str, Any]:
    """Return what an arrow looks like; its head may be smaller than what its place may follow the text."""
    styles = [getattr(arrow, f"get_{name}", lambda: None)() for name in ("arrowstyle", "connectionstyle")]
    given = [style for style in styles if style is not None]
    size = getattr(arrow, "get_mutation_scale", lambda: 1.0)()
    if not given:
        return {}
    names = [type(style).__name__ for style in given]
    return {"style": names, "head": round(float(size), 2), "shape": _shape(arrow, given)}


def _shape(arrow: Any, styles: Sequence[Any]) -> str:
    """Return the numbers of an arrow's styles, and its distance from both ends, that are not matplotlib's own."""
    ends = [(f"shrink{end}", getattr(arrow, f"shrink{end}", _SHRINK)) for end in "AB"]
    shrunk = [f"{name}={float(value):.3g}" for name, value in ends if value != _SHRINK]
    return ", ".join(filter(None, [*map(style_numbers, styles), *shrunk])) or "usual"


def _of_axis(axis: Axis, chain: tuple[Artist, ...]) -> Part:
    which = f"of the {getattr(axis, 'axis_name', '')} axis"
    below = chain[1] if len(chain) > 1 else axis
    if below is axis.label:
        place: dict[str, Any] = {"pad": round(float(axis.labelpad), 2)}
        if not getattr(axis, "_autolabelpos", True):  # set_label_coords was called
            place = {"place": [round(float(part), 4) for part in axis.label.get_position()]}
        elif getattr(axis.axes, "name", "") == "rectilinear":
            place["side"] = str(axis.get_label_position())
        known = any(axis is getattr(axis.axes, f"{name}axis", None) for name in "xyz")  # their words are said by name
        return Part(f"label {which}", below, told=known, placed=False, properties=place)
    if below is axis.offsetText:
        return Part(f"offset text {which}", below, placed=False)
    minor = "minor " if any(below is tick for tick in axis.minorTicks) else ""
    what = next((words for name, words in _TICKS.items() if chain[-1] is getattr(below, name, None)), "tick marks")
    if len(chain) < 3:
        return Part(f"line {which}", axis)
    pad = {"pad": round(float(below.get_pad()), 2)} if what == "tick labels" and hasattr(below, "get_pad") else {}
    return Part(f"{minor}{what} {which}", axis, properties=pad)


def _of_table(name: str, table: Table, chain: tuple[Artist, ...]) -> Part:
    cell = next((place for place, cell in table.get_celld().items() if cell in chain), None)
    if cell is None:
        return Part(name, table, loose=True)
    return Part(
        f"{name}, cell {cell[0]}, {cell[1]}",
        chain[-1],
        loose=True,
        properties=_cell_properties(table, cell) if chain[-1] is table[cell] else {},
    )


def _cell_properties(table: Table, place: tuple[int, int]) -> dict[str, Any]:
    cell = table[place]
    found: dict[str, Any] = {"lines": cell.visible_edges, "height": round(float(cell.get_height()), 4)}
    if place[1] not in getattr(table, "_autoColumns", ()):  # those follow the width of their texts
        found["width"] = round(float(cell.get_width()), 4)
    return found


def _legend_properties(legend: Legend) -> dict[str, Any]:
    codes = {code: name for name, code in Legend.codes.items()}
    place = getattr(legend, "_loc_real", getattr(legend, "_loc", None))
    found: dict[str, Any] = {
        "place": codes.get(place, place) if isinstance(place, int) else [round(float(part), 4) for part in place or ()],
        "columns": int(getattr(legend, "_ncols", 1)),
    }
    parent: Any = getattr(legend, "axes", None) or legend.get_figure()
    box = Box.of(parent.bbox.extents)
    anchor = box.units(np.reshape(legend.get_bbox_to_anchor().extents, (2, 2)))
    return found | {"anchor": [round(float(part), 3) for part in anchor.ravel()]}


def _texts_in(box: Artist) -> list[Text]:
    found: list[Text] = []
    waiting: list[Artist] = [box]
    while waiting:
        artist = waiting.pop(0)
        if isinstance(artist, Text):
            found.append(artist)
        waiting += artist.get_children()
    return [text for text in found if text.get_text()]


def _word(artist: Artist) -> str | None:
    kind = type(artist)
    # Arrows and barbs are polygons to matplotlib, but no areas.
    if not kind.__module__.startswith("matplotlib.") or kind.__module__ == "matplotlib.quiver":
        return None
    return next((word for known, word in _WORDS if isinstance(artist, known)), None)


def _shortened(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST else f"{line[:_LONGEST]}…"
