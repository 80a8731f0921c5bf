"""A renderer that draws nothing and writes down everything: each path, marker, image and text, and whose it is.

It is the safety net of the comparison: what no reader knows by name passes through here all the same. Texts are
laid out with the widths of an imagined typewriter, so that neither fonts nor the library that reads them can move
anything.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.colors import to_hex, to_rgba
from matplotlib.path import Path
from matplotlib.text import Text
from matplotlib.transforms import Transform
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Pixels per inch of every recording, whatever the figure's own resolution is.
DPI = 100.0

_HATCH_WIDTH = 1.0  # points
_DARK = 0.25

# Width, height and depth of a letter, as fractions of the font size.
_WIDTH, _ASCENT, _DESCENT = 0.6, 0.75, 0.2


@dataclass
class Drawn:
    """One call of the renderer.

    Attributes
    ----------
    kind
        ``path``, ``markers``, ``collection``, ``mesh``, ``triangles``, ``image`` or ``text``.
    artists
        Who draws, from the figure down to the artist itself.
    groups
        The renderer's own open groups below that artist.
    paths
        Vertices in pixels with their codes; of markers, relative to where each one is.
    offsets
        Where markers are, in pixels, shape (n, 2); ``None`` for paths that are where they are.
    edges, faces
        RGBA, shape (n, 4), ``n`` being 0 where there is no line or no fill.
    widths, dashes
        In points, one for all or one each; a dash pattern is ``(offset, lengths)``.
    extra
        What only this kind has: the text, the image.
    """

    kind: str
    artists: tuple[Artist, ...]
    groups: tuple[str, ...]
    paths: Sequence[Path] = ()
    offsets: Array | None = None
    scales: Array | None = None
    edges: Array = field(default_factory=lambda: np.empty((0, 4)))
    faces: Array = field(default_factory=lambda: np.empty((0, 4)))
    widths: Sequence[float] = ()
    dashes: Sequence[Any] = ()
    cap: str = ""
    join: str = ""
    hatch: str = ""
    sketch: tuple[float, ...] = ()
    clip_box: Sequence[float] | None = None
    clip_path: Path | None = None
    extra: dict[str, Any] = field(default_factory=dict)


class RecordingRenderer(RendererBase):
    """Writes down what is drawn on a canvas of the given size in pixels."""

    def __init__(self, width: float, height: float) -> None:
        super().__init__()
        self.width, self.height, self.dpi = width, height, DPI
        self.drawn: list[Drawn] = []
        self.artists: list[Artist] = []
        self._groups: list[list[str]] = [[]]
        self.recording = False

    # ------------------------------------------------------------------------------------- who is drawing

    @contextmanager
    def drawing(self, artist: Artist) -> Iterator[None]:
        """Attribute what is drawn inside the ``with`` block to an artist."""
        self.artists.append(artist)
        self._groups.append([])
        try:
            yield
        finally:
            self.artists.pop()
            self._groups.pop()

    def open_group(self, s: str, gid: str | None = None) -> None:
        self._groups[-1].append(s)

    def close_group(self, s: str) -> None:
        if self._groups[-1]:
            self._groups[-1].pop()

    # ------------------------------------------------------------------------------------- what is drawn

    def draw_path(self, gc: Any, path: Any, transform: Any, rgbFace: Any = None) -> None:
        if not self.recording:
            return
        artist = self.artists[-1] if self.artists else None
        if isinstance(artist, Text) and self._groups[-1][-1:] == ["text"]:  # letters as outlines, for path effects
            own: Any = self.new_gc()  # what the effects put around it is a property of the text
            own.copy_properties(gc)
            own.set_foreground(to_rgba(artist.get_color()), isRGBA=True)
            own.set_alpha(artist.get_alpha())
            font, angle = artist.get_fontproperties(), artist.get_rotation()
            self.draw_text(own, 0.0, 0.0, artist.get_text(), font, angle)
            return
        self._add("path", gc, paths=[_moved(path, transform)], faces=_face(gc, rgbFace))

    def draw_markers(
        self, gc: Any, marker_path: Any, marker_trans: Any, path: Any, trans: Any, rgbFace: Any = None
    ) -> None:
        if self.recording:
            offsets = _vertices(trans.transform(path.vertices))
            shape = [_moved(marker_path, marker_trans)]
            self._add("markers", gc, paths=shape, offsets=offsets, faces=_face(gc, rgbFace))

    def draw_path_collection(
        self,
        gc: Any,
        master_transform: Any,
        paths: Any,
        all_transforms: Any,
        offsets: Any,
        offset_trans: Any,
        facecolors: Any,
        edgecolors: Any,
        linewidths: Any,
        linestyles: Any,
        *_: Any,
        hatchcolors: Any = None,
        **__: Any,
    ) -> None:
        if not self.recording or not len(paths):
            return
        places = _vertices(offset_trans.transform(np.ma.filled(np.ma.asarray(offsets, dtype=float), np.nan)))
        matrices = np.asarray(all_transforms, dtype=float).reshape(-1, 3, 3)
        master = np.asarray(master_transform.get_matrix(), dtype=float)
        together = master @ matrices if len(matrices) else master[None]
        scattered = len(places) > 1 or (len(matrices) > 0 and len(places) == 1)
        stamped = scattered and len(paths) == 1 and _only_scaled(together)
        shift = np.zeros(2) if scattered or not len(places) else places[0]
        moved = []
        for i in range(1 if stamped else max(len(paths), len(matrices))):
            path, matrix = paths[i % len(paths)], together[i % len(together)]
            moved.append(Path(path.vertices @ matrix[:2, :2].T + matrix[:2, 2] + shift, path.codes))
        scales = np.sqrt(np.abs(np.linalg.det(together[:, :2, :2]))) if scattered else None
        self._add(
            "collection",
            gc,
            paths=moved,
            offsets=places if scattered else None,
            scales=scales,
            edges=_colours(edgecolors),
            faces=_colours(facecolors),
            widths=[float(width) for width in np.ravel(linewidths)],
            dashes=list(linestyles),
            hatch_colours=() if hatchcolors is None else hatchcolors,
        )

    def draw_quad_mesh(
        self,
        gc: Any,
        master_transform: Any,
        meshWidth: int,
        meshHeight: int,
        coordinates: Any,
        offsets: Any,
        offsetTrans: Any,
        facecolors: Any,
        antialiased: Any,
        edgecolors: Any,
    ) -> None:
        if not self.recording:
            return
        corners = _vertices(coordinates)
        shape = [Path(_vertices(master_transform.transform(corners)))]
        colours = _colours(np.asarray(facecolors, dtype=float).reshape(-1, 4))
        self._add("mesh", gc, paths=shape, faces=colours, edges=_colours(edgecolors), size=(meshHeight, meshWidth))

    def draw_gouraud_triangles(self, gc: Any, triangles_array: Any, colors_array: Any, transform: Any) -> None:
        if self.recording:
            corners = np.asarray(triangles_array, dtype=float).reshape(-1, 2)
            colours = _colours(np.asarray(colors_array, dtype=float).reshape(-1, 4))
            self._add("triangles", gc, paths=[Path(_vertices(transform.transform(corners)))], faces=colours)

    def draw_image(self, gc: Any, x: float, y: float, im: Any, transform: Any = None) -> None:
        if self.recording:
            height, width = im.shape[:2]
            corners: Array = np.array([[x, y], [x + width, y + height]], dtype=float)
            if transform is not None:  # the image fills the unit square of the transform
                corners = np.asarray(transform.transform([[0.0, 0.0], [1.0, 1.0]])) + np.array([x, y])
            self._add("image", gc, corners=corners, image=np.asarray(im), edges=np.empty((0, 4)))

    def draw_text(
        self,
        gc: Any,
        x: float,
        y: float,
        s: str,
        prop: Any,
        angle: float,
        ismath: Any = False,
        mtext: Any = None,
    ) -> None:
        if not self.recording or not s.strip():
            return
        found: dict[str, Any] = {"text": s, "place": (x, y), "font": prop, "angle": float(angle)}
        artist = self.artists[-1] if self.artists else None
        if isinstance(artist, Text):  # where it is anchored, before its own size comes in
            anchor = artist.get_transform().transform(artist.get_unitless_position())
            align = f"{artist.get_horizontalalignment()} {artist.get_verticalalignment()}"
            found |= {"text": artist.get_text(), "place": tuple(anchor), "align": align}
            if self.drawn and self.drawn[-1].kind == "text" and self.drawn[-1].artists[-1] is artist:
                return  # the next line of the same text
        self._add("text", gc, **found)

    def draw_tex(self, gc: Any, x: float, y: float, s: str, prop: Any, angle: float, *, mtext: Any = None) -> None:
        self.draw_text(gc, x, y, s, prop, angle, mtext=mtext)

    def _add(self, kind: str, gc: GraphicsContextBase, **parts: Any) -> None:
        fields = {name: parts.pop(name) for name in list(parts) if name in Drawn.__dataclass_fields__}
        fields.setdefault("edges", _edge(gc))
        fields.setdefault("widths", [float(gc.get_linewidth())])
        fields.setdefault("dashes", [gc.get_dashes()])
        box = gc.get_clip_rectangle()
        clip: Any = gc.get_clip_path()  # a path and its transform; both may be missing
        self.drawn.append(
            Drawn(
                kind,
                tuple(self.artists),
                tuple(self._groups[-1]),
                cap=str(gc.get_capstyle()),
                join=str(gc.get_joinstyle()),
                hatch=_hatch(gc, fields["edges"], parts.pop("hatch_colours", ())),
                sketch=tuple(gc.get_sketch_params() or ()),
                clip_box=None if box is None else [float(end) for end in box.extents],
                clip_path=None if clip[0] is None else _moved(*clip),
                extra=parts,
                **fields,
            )
        )

    # --------------------------------------------------------------------- what artists ask of a renderer

    def get_canvas_width_height(self) -> tuple[float, float]:
        return self.width, self.height

    def points_to_pixels(self, points: Any) -> Any:
        return points * DPI / 72.0

    def flipy(self) -> bool:
        return False

    def option_image_nocomposite(self) -> bool:
        return True

    def get_text_width_height_descent(self, s: str, prop: Any, ismath: Any) -> tuple[float, float, float]:
        size = self.points_to_pixels(prop.get_size_in_points())
        return _WIDTH * size * len(s), (_ASCENT + _DESCENT) * size, _DESCENT * size

    def _get_font_height_metrics(self, prop: Any) -> tuple[float, float, float]:
        """Tell newer matplotlib how high a line is; older ones ask for the height of letters instead."""
        size = self.points_to_pixels(prop.get_size_in_points())
        return _ASCENT * size, _DESCENT * size, 0.0


def _moved(path: Path, transform: Transform | None) -> Path:
    if transform is None:
        return path
    moved = transform.transform_path(path)
    return Path(_vertices(moved.vertices), moved.codes)


def _only_scaled(matrices: Array) -> bool:
    """Whether transforms differ in size only, and neither turn nor stretch anything."""
    parts = matrices[:, :2, :2]
    sizes = np.sqrt(np.abs(np.linalg.det(parts)))
    units = parts / np.where(sizes > 0.0, sizes, 1.0)[:, None, None]
    return bool(np.allclose(units[sizes > 0.0], units[:1], rtol=0.0, atol=1e-6))


def _vertices(points: Any) -> Array:
    return np.ma.filled(np.ma.asarray(points, dtype=float), np.nan).reshape(-1, 2)


def _colours(colours: Any) -> Array:
    array: Array = np.ma.filled(np.ma.asarray(colours, dtype=float), 0.0)
    return array.reshape(-1, 4) if array.size else np.empty((0, 4))


def _hatch(gc: GraphicsContextBase, edges: Array, colours: Sequence[Any]) -> str:
    """Return a hatch; width and colour of its lines are said where they are uncommon: neither dark nor the edge's."""
    hatch, width = str(gc.get_hatch() or ""), float(gc.get_hatch_linewidth())
    if not hatch:
        return ""
    given = colours[0] if len(colours) else gc.get_hatch_color()
    colour = (0.0, 0.0, 0.0, 1.0) if given is None else to_rgba(given)
    usual = [max(colour[:3]) < _DARK, *(np.allclose(colour[:3], edge[:3], atol=1e-2) for edge in edges[:1])]
    words = ([f"{width:g} pt"] if width != _HATCH_WIDTH else []) + ([] if any(usual) else [to_hex(colour)])
    return ", ".join([hatch, *words])


def _edge(gc: GraphicsContextBase) -> Array:
    red, green, blue, alpha = gc.get_rgb()
    alpha = gc.get_alpha() if gc.get_forced_alpha() else alpha
    return np.array([[red, green, blue, alpha]]) if gc.get_linewidth() > 0.0 else np.empty((0, 4))


def _face(gc: GraphicsContextBase, face: Any) -> Array:
    if face is None:
        return np.empty((0, 4))
    alpha = face[3] if len(face) == 4 and not gc.get_forced_alpha() else gc.get_alpha()
    return np.array([[*face[:3], alpha]], dtype=float)
