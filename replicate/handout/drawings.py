"""Figures of a handout, drawn when they are placed; whoever only reads a handout loads no matplotlib."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property, partial
from types import ModuleType
from typing import Literal

from replicate.errors import ReplicateError, TemplateError
from replicate.exhibits import Figure
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.results import FigureResult


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
    """A picture of the numbers of one form, in values that can be sent to a process.

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
    """

    owner: str
    id: str
    exercise: str
    figure: str
    draw: str
    title: str
    size: tuple[float, float]
    kind: Literal["svg", "png"]

    def drawn(self, exercises: Exercises) -> bytes:
        """Return the picture."""
        variation = exercises.variations[self.exercise]
        found = variation.figures[self.figure]
        inputs = variation.drawn(self.draw) if self.draw else variation.original
        draw = partial(found.draw, inputs=inputs)
        with said_by(f"figure('{self.figure}')"):
            figure = Figure(self.id, "figure", self.title, draw, alt=found.alt, size=self.size)
            made: bytes = _drawing().picture(self.owner, figure, self.kind)
            return made


def undrawn(figure: Figure, width: float) -> Drawing:
    """Return the place of a figure in a text that is only read."""
    return Drawing(figure.id, "", b"", figure.alt, width)


class DrawnLater(Drawing):
    """A figure of the numbers of one form, drawn when it is needed: a sheet without solutions needs fewer.

    Parameters
    ----------
    draw
        Returns the picture of one kind.
    """

    def __init__(self, wanted: Wanted, alt: str, width: float, draw: Callable[[Wanted], bytes]) -> None:
        self.__dict__.update(name=wanted.figure, alt=alt, width=width, _wanted=wanted, _draw={"svg": draw, "png": draw})

    @cached_property
    def svg(self) -> str:
        """The vector drawing."""
        return self._drawn("svg").decode()

    @cached_property
    def png(self) -> bytes:
        """The picture."""
        return self._drawn("png")

    def wanted(self, kind: Literal["svg", "png"]) -> Wanted:
        """Return which picture it is."""
        wanted: Wanted = self.__dict__["_wanted"]
        return replace(wanted, kind=kind)

    def drawn_by(self, kind: Literal["svg", "png"], draw: Callable[[Wanted], bytes]) -> None:
        """Have the picture of a kind drawn otherwise if it is not drawn yet."""
        self.__dict__["_draw"][kind] = draw

    def _drawn(self, kind: Literal["svg", "png"]) -> bytes:
        made: bytes = self.__dict__["_draw"][kind](self.wanted(kind))
        return made


def captured(call: str, paper: str, figure: Figure) -> FigureResult:
    """Draw a figure that a call of a text places."""
    with said_by(call):
        found: FigureResult = _drawing().capture(f"{paper}-handout", figure)
        return found


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
