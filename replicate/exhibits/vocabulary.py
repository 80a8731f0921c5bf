"""The exhibit vocabulary: the words in which a paper's package describes itself.

A paper is a list of exhibits. A `Table` (a printed table, a worked example, a formula) has *readings*,
functions that return the whole exhibit as a DataFrame with the row and column keys of its printed CSV; a
`Figure` has one function that draws on an ordinary matplotlib figure; `Claims` collects sentences that can be
true or false; `NotComputable` is an exhibit that exists in the paper but cannot be recomputed, with the reason.
This module only describes: computing, judging and rendering happen elsewhere.
"""

from __future__ import annotations

import csv
import importlib
import importlib.resources
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.resources.abc import Traversable
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

from replicate.errors import PaperDefinitionError

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure as MatplotlibFigure

TableKind = Literal["table", "example", "formula"]
FigureKind = Literal["figure", "diagram"]
ClaimVerdict = Literal["holds", "fails", "holds-partly"]

AS_WRITTEN = "as-written"


@dataclass(frozen=True)
class Reading:
    """One way to understand how an exhibit was computed.

    Attributes
    ----------
    id
        ``as-written`` for the first reading of an exhibit, a short ASCII slug for every other.
    title
        One line for table headings and the terminal.
    compute
        Returns the whole exhibit; rows and columns carry the keys of the printed CSV.
    note
        What is assumed and why, in Markdown; may be empty.
    """

    id: str
    title: str
    compute: Callable[[], pd.DataFrame]
    note: str = ""


@dataclass
class Table:
    """An exhibit with rows and columns: a table, a worked example or a formula.

    Attributes
    ----------
    rows, columns
        The keys, in the paper's order. With a printed CSV they must agree with it exactly.
    labels
        Display text (may hold LaTeX math between ``$``) of row and column keys that need one.
    units
        Unit of a column, as text.
    significant_digits
        Set where the paper prints a fixed number of significant digits and strips trailing zeros ("6.968" then
        means 6.96800). ``None``: the printed string itself tells the precision.
    """

    id: str
    kind: TableKind
    title: str
    caption: str = ""
    rows: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    labels: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    significant_digits: int | None = None
    printed: bool = True
    readings: dict[str, Reading] = field(default_factory=dict)

    def reading(
        self, id: str, title: str, note: str = ""
    ) -> Callable[[Callable[[], pd.DataFrame]], Callable[[], pd.DataFrame]]:
        """Register the decorated function as a reading; the first must be ``as-written``."""

        def register(compute: Callable[[], pd.DataFrame]) -> Callable[[], pd.DataFrame]:
            if not self.readings and id != AS_WRITTEN:
                msg = f"{self.id}: the first reading must be '{AS_WRITTEN}', not '{id}'"
                raise PaperDefinitionError(msg)
            if id in self.readings:
                msg = f"{self.id}: reading '{id}' is defined twice"
                raise PaperDefinitionError(msg)
            self.readings[id] = Reading(id, title, compute, note)
            return compute

        return register


@dataclass
class Figure:
    """A figure or block diagram; ``draw(fig)`` draws on an empty matplotlib figure of the given size in inches."""

    id: str
    kind: FigureKind
    title: str
    draw: Callable[[MatplotlibFigure], None]
    caption: str = ""
    alt: str = ""
    size: tuple[float, float] = (6.4, 4.0)
    stands_for: str = ""  # set when a simulation stands in for a measurement; shown with the figure


@dataclass(frozen=True)
class Chart:
    """A figure that a reader orders for parameters of his own choice (``replicate chart``).

    Attributes
    ----------
    draw
        Draws on an empty matplotlib figure: ``draw(fig, **values)``; raises `ValueError` with a sentence for a value
        that makes no sense.
    parameters
        Name of every parameter and what it is, in the order in which they are told. All are numbers.
    """

    id: str
    title: str
    draw: Callable[..., None]
    parameters: dict[str, str]
    size: tuple[float, float] = (6.4, 4.0)


@dataclass(frozen=True)
class Finding:
    """What a claim's check found: the verdict, the number that decides it, and the evidence in one or two sentences."""

    verdict: ClaimVerdict
    value: float
    evidence: str


@dataclass(frozen=True)
class Claim:
    """A sentence of the paper that can be true or false."""

    id: str
    text: str
    check: Callable[[], Finding]
    where: str = ""
    printed: str = ""


@dataclass
class Claims:
    """All checkable sentences of a paper (or of one part of it)."""

    id: str
    title: str
    kind: Literal["claims"] = "claims"
    claims: dict[str, Claim] = field(default_factory=dict)

    def claim(
        self, id: str, text: str, *, where: str = "", printed: str = ""
    ) -> Callable[[Callable[[], Finding]], Callable[[], Finding]]:
        """Register the decorated function as the check of a claim.

        Parameters
        ----------
        text
            The claim in our own words. where: section or page. printed: the number the sentence names, if it names one.
        """

        def register(check: Callable[[], Finding]) -> Callable[[], Finding]:
            if id in self.claims:
                msg = f"{self.id}: claim '{id}' is defined twice"
                raise PaperDefinitionError(msg)
            self.claims[id] = Claim(id, text, check, where, printed)
            return check

        return register


@dataclass(frozen=True)
class NotComputable:
    """A numbered exhibit of the paper that cannot be recomputed, and why."""

    id: str
    kind: TableKind | FigureKind
    title: str
    reason: str


Exhibit = Table | Figure | Claims | NotComputable


@dataclass
class Paper:
    """One paper: who wrote it, where it appeared, and its exhibits in the paper's order.

    Attributes
    ----------
    id
        Short ASCII name, the folder's name.
    package
        Import name of the paper's package (``__name__``); its folder holds ``printed/*.csv``, ``ledger.toml``,
        ``notes.md`` and ``handout.md``.
    modules
        Modules of the package that define exhibits, imported in this order by `load`, which is the paper's order.
    numbered
        Ids of every numbered table, figure and example of the paper: `replicate check` demands that each is in the
        inventory.
    charts
        Figures for parameters of the reader's choice; the first is the one that ``replicate chart`` draws if none is
        named.
    """

    id: str
    package: str
    title: str
    authors: tuple[str, ...]
    citation: str
    year: int
    modules: tuple[str, ...]
    numbered: tuple[str, ...]
    summary: str = ""
    exhibits: dict[str, Exhibit] = field(default_factory=dict)
    charts: dict[str, Chart] = field(default_factory=dict)
    _loaded: bool = False

    def load(self) -> Paper:
        """Import the modules that define the exhibits (once) and return the paper itself."""
        if not self._loaded:
            for module in self.modules:
                importlib.import_module(f"{self.package}.{module}")
            self._loaded = True
        return self

    def folder(self) -> Traversable:
        """Return the package's folder, for its data files."""
        return importlib.resources.files(self.package)

    def printed_cells(self, exhibit: str) -> Mapping[tuple[str, str], str]:
        """Return what the paper prints in a table, by row and column, for exhibits that weigh the print as evidence.

        Blank cells are left out. The file is not validated here; `replicate.exhibits.printed.read_printed` does that.
        """
        return _printed_cells(self.package, exhibit)

    def printed_numbers(self, exhibit: str) -> dict[tuple[str, str], float]:
        """Return the printed cells of a table as numbers."""
        return {key: float(cell) for key, cell in self.printed_cells(exhibit).items()}

    def _add(self, exhibit: Exhibit) -> None:
        if exhibit.id in self.exhibits:
            msg = f"{self.id}: exhibit '{exhibit.id}' is defined twice"
            raise PaperDefinitionError(msg)
        self.exhibits[exhibit.id] = exhibit

    def table(
        self,
        id: str,
        title: str,
        *,
        rows: Sequence[str] = (),
        columns: Sequence[str] = (),
        kind: TableKind = "table",
        caption: str = "",
        labels: dict[str, str] | None = None,
        units: dict[str, str] | None = None,
        significant_digits: int | None = None,
        printed: bool = True,
    ) -> Table:
        """Add a table, worked example or formula; ``printed=False`` where the paper prints no numbers in it.

        Raises
        ------
        PaperDefinitionError
            If the id is taken, or a printed exhibit names no rows or columns.
        """
        if printed and not (rows and columns):
            msg = f"{self.id}: {id} has printed values, so its row and column keys must be given"
            raise PaperDefinitionError(msg)
        exhibit = Table(
            id,
            kind,
            title,
            caption,
            tuple(rows),
            tuple(columns),
            labels or {},
            units or {},
            significant_digits,
            printed,
        )
        self._add(exhibit)
        return exhibit

    def figure(
        self,
        id: str,
        title: str,
        *,
        kind: FigureKind = "figure",
        caption: str = "",
        alt: str = "",
        size: tuple[float, float] = (6.4, 4.0),
        stands_for: str = "",
    ) -> Callable[[Callable[[MatplotlibFigure], None]], Callable[[MatplotlibFigure], None]]:
        """Register the decorated function as a figure; it draws on an empty matplotlib figure."""

        def register(draw: Callable[[MatplotlibFigure], None]) -> Callable[[MatplotlibFigure], None]:
            self._add(Figure(id, kind, title, draw, caption, alt, size, stands_for))
            return draw

        return register

    def chart(
        self,
        id: str,
        title: str,
        *,
        parameters: dict[str, str],
        size: tuple[float, float] = (6.4, 4.0),
    ) -> Callable[[Callable[..., None]], Callable[..., None]]:
        """Register the decorated function as a chart; it draws on an empty figure, given the parameters by name.

        Raises
        ------
        PaperDefinitionError
            If there is a chart of that name, or no parameter.
        """
        if id in self.charts or not parameters:
            msg = f"{self.id}: chart '{id}' " + ("is defined twice" if id in self.charts else "has no parameters")
            raise PaperDefinitionError(msg)

        def register(draw: Callable[..., None]) -> Callable[..., None]:
            self.charts[id] = Chart(id, title, draw, parameters, size)
            return draw

        return register

    def claims(self, id: str = "claims", title: str = "Claims made in the text") -> Claims:
        """Add a collection of claims."""
        exhibit = Claims(id, title)
        self._add(exhibit)
        return exhibit

    def not_computable(self, id: str, title: str, reason: str, *, kind: TableKind | FigureKind = "figure") -> None:
        """Add an exhibit that cannot be recomputed, with the reason."""
        self._add(NotComputable(id, kind, title, reason))


@cache
def _printed_cells(package: str, exhibit: str) -> Mapping[tuple[str, str], str]:
    text = (importlib.resources.files(package) / "printed" / f"{exhibit}.csv").read_text(encoding="utf-8")
    cells = {
        (record["row"], column): cell
        for record in csv.DictReader(text.splitlines())
        for column, cell in record.items()
        if column != "row" and cell
    }
    return MappingProxyType(cells)
