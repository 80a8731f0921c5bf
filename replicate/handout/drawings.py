"""Figures of a handout, drawn when they are placed; whoever only reads a handout loads no matplotlib."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from types import ModuleType
from typing import TYPE_CHECKING

from replicate.display.inline_svg import description
from replicate.errors import ReplicateError, TemplateError
from replicate.exhibits import Figure
from replicate.exhibits.results import FigureResult
from replicate.exhibits.variants import Variation

if TYPE_CHECKING:
    from replicate.figures.off_screen import Kind
    from replicate.handout.artist import Artist


@dataclass(frozen=True)
class Drawing:
    """A figure to be placed: its SVG and PNG, its words and its width as a fraction of the text's."""

    name: str
    svg: str
    png: bytes
    alt: str
    width: float


@dataclass(frozen=True)
class Wanted:
    """Pictures of the numbers of one form, in values that can be sent to a process.

    Attributes
    ----------
    owner, id
        Seed the ids inside it.
    exercise, figure
        Their names.
    draw
        What the numbers are drawn from; empty for those that all share.
    title
        Inside an SVG.
    size
        In inches.
    kinds
        Of pictures; both together cost little more than one.
    """

    owner: str
    id: str
    exercise: str
    figure: str
    draw: str
    title: str
    size: tuple[float, float]
    kinds: tuple[Kind, ...] = ()

    def drawn(self, variations: Mapping[str, Variation]) -> tuple[bytes, ...]:
        """Return the pictures, in the order of their kinds."""
        variation = variations[self.exercise]
        found = variation.figures[self.figure]
        inputs = variation.drawn(self.draw) if self.draw else variation.original
        draw = partial(found.draw, inputs=inputs)
        with said_by(f"exercise '{self.exercise}': figure('{self.figure}')"):
            figure = Figure(self.id, "figure", self.title, draw, alt=found.alt, size=self.size)
            made: tuple[bytes, ...] = _drawing().drawn_as(self.owner, figure, self.kinds)
            return made


def undrawn(figure: Figure, width: float) -> Drawing:
    """Return the place of a figure in a text that is only read."""
    return Drawing(figure.id, "", b"", figure.alt, width)


class DrawnLater(Drawing):
    """A figure of the numbers of one form, drawn when it is needed: a sheet without solutions needs fewer.

    Parameters
    ----------
    variations
        Whose figure it is, among others.
    """

    def __init__(self, wanted: Wanted, alt: str, width: float, variations: Mapping[str, Variation]) -> None:
        self.__dict__.update(name=wanted.figure, alt=alt, width=width)  # the fields of a frozen class
        self.wanted = wanted
        self._variations = variations
        self._draw: Callable[[Wanted], tuple[bytes, ...]] = self._drawn_here
        self._made: dict[Kind, bytes] = {}

    @property
    def svg(self) -> str:
        """The vector drawing."""
        return self.picture("svg").decode()

    @property
    def png(self) -> bytes:
        """The picture."""
        return self.picture("png")

    def want(self, kind: Kind) -> None:
        """Have a kind of picture drawn together with the others that are wanted."""
        if kind not in self.wanted.kinds:
            self.wanted = replace(self.wanted, kinds=(*self.wanted.kinds, kind))

    def drawn_by(self, draw: Callable[[Wanted], tuple[bytes, ...]]) -> None:
        """Have what is wanted drawn otherwise."""
        self._draw = draw

    def picture(self, kind: Kind) -> bytes:
        """Return what is wanted of a kind; it is drawn once."""
        self.want(kind)
        if kind not in self._made:
            self._made.update(zip(self.wanted.kinds, self._draw(self.wanted), strict=True))
        return self._made[kind]

    def _drawn_here(self, wanted: Wanted) -> tuple[bytes, ...]:
        return wanted.drawn(self._variations)


def have_drawn(pictures: Iterable[tuple[Drawing, Kind]], artist: Artist | None) -> None:
    """Have pictures drawn that vary: by an artist meanwhile, or now, while no other thread draws."""
    later = [(drawing, kind) for drawing, kind in pictures if isinstance(drawing, DrawnLater)]
    for drawing, kind in later:
        drawing.want(kind)
    if artist is None:
        for drawing, kind in later:
            drawing.picture(kind)
        return
    draw = artist.order([drawing.wanted for drawing, _ in later])
    for drawing, _ in later:
        drawing.drawn_by(draw)


def pictures_of(call: str, paper: str, figure: Figure) -> tuple[str, bytes, str]:
    """Draw a figure that a call of a text places; return its SVG, its PNG and its words.

    Only for a figure without words is read back what it shows.
    """
    owner = f"{paper}-handout"
    with said_by(call):
        if not figure.alt:
            found: FigureResult = _drawing().capture(owner, figure)
            return found.svg, found.png, description("", found.axes)
        svg, png = _drawing().drawn_as(owner, figure, ("svg", "png"))
        return svg.decode(), png, figure.alt


@contextmanager
def said_by(call: str) -> Iterator[None]:
    """Turn whatever a paper's own function raises into a message that the text's line is added to."""
    try:
        yield
    except ReplicateError as error:
        msg = f"{call} failed: {error}"
        raise TemplateError(msg) from error
    except Exception as error:
        msg = f"{call} failed: {type(error).__name__}: {error}"
        raise TemplateError(msg) from error


def _drawing() -> ModuleType:
    from replicate.run import drawing  # loads matplotlib

    return drawing
