"""What is drawn: the figures of a paper, and charts for parameters of the reader's choice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, get_args

from replicate.exhibits.definitions import (
    check_function,
    check_id,
    check_mappings,
    check_one_of,
    check_size,
    check_texts,
)
from replicate.exhibits.order import module_being_imported

if TYPE_CHECKING:
    from matplotlib.figure import Figure as MatplotlibFigure

FigureKind = Literal["figure", "diagram"]


@dataclass
class Figure:
    """A figure or block diagram.

    Attributes
    ----------
    id
        The paper's own numbering: ``fig-4``.
    kind
        ``figure`` or ``diagram``.
    title, caption
        One line, and what a reader should know besides, in Markdown.
    draw
        Draws on an empty matplotlib figure: ``draw(fig)``.
    alt
        What it shows, in words, for those who cannot see it.
    size
        Width and height in inches.
    stands_for
        Set when a simulation stands in for a measurement; shown with the figure.
    depends
        Files and folders, as for `Table`.
    module
        The module in which it is defined; set by itself.
    """

    id: str
    kind: FigureKind
    title: str
    draw: Callable[[MatplotlibFigure], None]
    caption: str = ""
    alt: str = ""
    size: tuple[float, float] = (6.4, 4.0)
    stands_for: str = ""
    depends: tuple[str, ...] = ()
    module: str = field(default_factory=module_being_imported, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        check_id("exhibit", self.id)
        check_one_of(self.id, "kind", self.kind, get_args(FigureKind))
        check_texts(self.id, title=self.title, caption=self.caption, alt=self.alt, stands_for=self.stands_for)
        check_size(self.id, self.size)
        check_function(self.id, "what draws it", self.draw)


@dataclass(frozen=True)
class Chart:
    """A figure for parameters of the reader's choice (``replicate chart``).

    Attributes
    ----------
    id, title
        Its name, and one line.
    draw
        Draws on an empty matplotlib figure: ``draw(fig, **values)``; raises `ValueError` with a sentence for a value
        that makes no sense.
    parameters
        Name and meaning of every parameter, in the order in which they are listed. All are numbers.
    size
        Width and height in inches.
    module
        The module in which it is defined; set by itself.
    """

    id: str
    title: str
    draw: Callable[..., None]
    parameters: dict[str, str]
    size: tuple[float, float] = (6.4, 4.0)
    module: str = field(default_factory=module_being_imported, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        what = f"chart '{self.id}'"
        check_id("chart", self.id)
        check_texts(what, title=self.title)
        check_mappings(what, parameters=self.parameters)
        check_size(what, self.size)
        check_function(what, "what draws it", self.draw)
