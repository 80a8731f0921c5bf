"""Figures of a handout, drawn when they are placed; whoever only reads a handout loads no matplotlib."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import Literal

from replicate.errors import ReplicateError, TemplateError
from replicate.exhibits import Figure
from replicate.exhibits.results import FigureResult


@dataclass(frozen=True)
class Drawing:
    """A figure to be placed: its SVG and PNG, its words and its width as a fraction of the text's."""

    name: str
    svg: str
    png: bytes
    alt: str
    width: float


class DrawnLater(Drawing):
    """A figure of the numbers of one form, drawn when it is needed: a sheet without solutions needs fewer."""

    def __init__(self, paper: str, figure: Figure, width: float) -> None:
        self.__dict__.update(name=figure.id, alt=figure.alt, width=width, _paper=paper, _figure=figure)

    @cached_property
    def svg(self) -> str:
        """The vector drawing."""
        return self._drawn("svg").decode()

    @cached_property
    def png(self) -> bytes:
        """The picture."""
        return self._drawn("png")

    def _drawn(self, kind: Literal["svg", "png"]) -> bytes:
        with said_by(f"figure('{self.name}')"):
            return picture(f"{self.__dict__['_paper']}-handout", self.__dict__["_figure"], kind)


def captured(call: str, paper: str, figure: Figure) -> FigureResult:
    """Draw a figure that a call of a text places."""
    with said_by(call):
        found: FigureResult = _drawing().capture(f"{paper}-handout", figure)
        return found


def picture(owner: str, figure: Figure, kind: Literal["svg", "png"]) -> bytes:
    """Return one picture of a figure; the owner's name seeds the ids inside it."""
    found: bytes = _drawing().picture(owner, figure, kind)
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
