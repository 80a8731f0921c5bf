"""One paper: who wrote it, where it appeared, and its exhibits in the paper's order."""

from __future__ import annotations

import importlib
import importlib.resources
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from importlib.resources.abc import Traversable
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

from replicate.exhibits.claims import Claims
from replicate.exhibits.definitions import (
    as_keys,
    as_texts,
    check_id,
    check_lists,
    check_one_of,
    check_paper_id,
    check_texts,
    check_year,
    refuse,
)
from replicate.exhibits.drawn import Chart, Figure, FigureKind
from replicate.exhibits.file_names import display_name
from replicate.exhibits.near import USUAL, Near
from replicate.exhibits.notation import PLAIN, Notation
from replicate.exhibits.order import in_listed_order
from replicate.exhibits.printed import Key, PrintedValue, read_transcription
from replicate.exhibits.read_off import COLUMN, read_points, values_at, with_points
from replicate.exhibits.readings import AS_WRITTEN
from replicate.exhibits.vocabulary import Exhibit, NotComputable, Table, TableKind

if TYPE_CHECKING:
    from matplotlib.figure import Figure as MatplotlibFigure


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
        Modules of the package that define exhibits, in the paper's order. Exhibits, claims and charts appear in this
        order, those of one module as it defines them, whichever module imports which.
    title, authors, citation, year
        As the paper gives them; the citation in one line.
    numbered
        Ids of every numbered table, figure and example of the paper: `replicate check` demands that each is in the
        inventory.
    summary
        What holds, what does not, and what a reader should use, in one or two sentences of Markdown.
    exhibits
        By id, in the paper's order once `load` has been called.
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
    _data_read: set[str] = field(default_factory=set, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        check_paper_id(self.id)
        what = f"paper '{self.id}'"
        check_texts(what, package=self.package, title=self.title, citation=self.citation, summary=self.summary)
        check_lists(what, authors=self.authors, modules=self.modules, numbered=self.numbered)
        check_year(what, self.year)

    def load(self) -> Paper:
        """Import the modules that define the exhibits (once), put all in the paper's order, return the paper itself.

        Raises
        ------
        PaperDefinitionError
            If an exhibit is defined in a module that `modules` does not list, or a printed table has no reading.
        """
        if not self._loaded:
            for module in self.modules:
                importlib.import_module(f"{self.package}.{module}")
            self._put_in_order()
            self._loaded = True
        return self

    def _put_in_order(self) -> None:
        self.exhibits = in_listed_order(self.exhibits, self.package, self.modules)
        self.charts = in_listed_order(self.charts, self.package, self.modules)
        for exhibit in self.exhibits.values():
            if isinstance(exhibit, Claims):
                exhibit.claims = in_listed_order(exhibit.claims, self.package, self.modules)
            elif isinstance(exhibit, Table):
                if exhibit.printed and not exhibit.readings:
                    file = display_name(Path(str(sys.modules[exhibit.module].__file__)))
                    refuse(f"{file}: {exhibit.id} has no reading; expected: one or more, '{AS_WRITTEN}' first")
                others = dict(exhibit.readings)
                first = {id: others.pop(id) for id in (AS_WRITTEN,) if id in others}
                exhibit.readings = first | in_listed_order(others, self.package, self.modules)

    def folder(self) -> Traversable:
        """Return the package's folder, for its data files."""
        return importlib.resources.files(self.package)

    def data(self, name: str) -> Path:
        """Return the path of a data file, and note that the paper's results depend on it.

        Parameters
        ----------
        name
            Relative to the paper's folder, with forward slashes: ``"x.csv"``, ``"../measured/run-3.csv"``.

        Raises
        ------
        PaperDefinitionError
            If there is no such file.
        """
        path = self._data_place(name)
        if not path.exists():
            refuse(f"{self.id}: there is no data file '{name}' in the paper's folder")
        self._data_read.add(name)
        return path

    def data_of(self, exhibit: Exhibit) -> set[str]:
        """Return the data files that ``exhibit`` declares, and those that the paper has read so far."""
        return self._data_read | set(getattr(exhibit, "depends", ()))

    def _data_place(self, name: str) -> Path:
        if not name or PurePosixPath(name).is_absolute() or Path(name).is_absolute():
            refuse(f"{self.id}: data file '{name}'; expected: a path relative to the paper's folder")
        return Path(str(self.folder())) / name

    def _declared(self, exhibit: str, depends: Sequence[str]) -> tuple[str, ...]:
        check_lists(f"{self.id}: {exhibit}", depends=depends)
        for name in depends:
            if not self._data_place(name).exists():
                refuse(f"{self.id}: {exhibit} depends on '{name}', which is not there")
        return tuple(depends)

    def printed_cells(self, exhibit: str) -> Mapping[tuple[str, str], str]:
        """Return what the paper prints in a table, by row and column, for exhibits that weigh the print as evidence.

        Blank cells are left out. The file is not validated here; `replicate.exhibits.printed.read_printed` does that.
        ``exhibit`` is the table's id.
        """
        return _printed_cells(self.package, exhibit)

    def printed_numbers(self, exhibit: str) -> dict[Key, float]:
        """Return the printed cells of the table ``exhibit`` as numbers."""
        return {key: float(PrintedValue(cell).value) for key, cell in self.printed_cells(exhibit).items()}

    def _add(self, exhibit: Exhibit) -> None:
        check_id("exhibit", exhibit.id, self.exhibits)
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
        labels: Mapping[str, str] | None = None,
        shared_labels: Mapping[str, str] | None = None,
        units: dict[str, str] | None = None,
        significant_digits: int | None = None,
        printed: bool = True,
        notation: Notation | Mapping[str, Notation] = PLAIN,
        near: Near = USUAL,
        spans: Mapping[Key, Sequence[Key]] | None = None,
        depends: Sequence[str] = (),
        cases: Literal["rows", "columns", ""] = "",
    ) -> Table:
        """Add a table, worked example or formula; ``printed=False`` where the paper prints no numbers in it.

        Parameters
        ----------
        id, title, rows, columns, kind, caption, units, significant_digits, printed, notation, near, spans
            As for `Table`.
        depends, cases
            As for `Table`.
        labels
            Display text of row and column keys of this table.
        shared_labels
            The same for several tables: what this one has no row or column for is left out.

        Raises
        ------
        PaperDefinitionError
            If the id is taken, or a printed exhibit names no rows or columns.
        """
        check_one_of(id, "printed", printed, (True, False))
        rows, columns = as_keys(id, "rows", rows), as_keys(id, "columns", columns)
        if printed and not (rows and columns):
            refuse(f"{self.id}: {id} has printed values, so its row and column keys must be given")
        shared = as_texts(id, "shared_labels", shared_labels)
        own = {key: text for key, text in shared.items() if key in (*rows, *columns)}
        exhibit = Table(
            id,
            kind,
            title,
            caption,
            rows,
            columns,
            own | as_texts(id, "labels", labels),
            as_texts(id, "units", units),
            significant_digits,
            printed,
            notation=notation,
            near=near,
            spans={} if spans is None else spans,
            depends=self._declared(id, depends),
            cases=cases,
        )
        exhibit.check()
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
        points: bool = False,
        depends: Sequence[str] = (),
    ) -> Callable[[Callable[[MatplotlibFigure], None]], Callable[[MatplotlibFigure], None]]:
        """Register the decorated function as a figure; it draws on an empty matplotlib figure.

        Parameters
        ----------
        id, title, kind, caption, alt, size, stands_for, depends
            As for `Figure`.
        points
            Whether ``printed/<id>.csv`` holds points read off the original. They are drawn over the figure and make a
            table of their own, ``<id>-points``, judged within their reading error.

        Raises
        ------
        PaperDefinitionError
            If the id is taken.
        PrintedFileError
            If the file of points is missing or malformed.
        """
        check_one_of(id, "points", points, (True, False))

        def register(draw: Callable[[MatplotlibFigure], None]) -> Callable[[MatplotlibFigure], None]:
            needs = self._declared(id, depends)
            if not points:
                self._add(Figure(id, kind, title, draw, caption, alt, size, stands_for, needs))
                return draw
            found = read_points(self.folder() / "printed" / f"{id}.csv")
            self._add(Figure(id, kind, title, with_points(draw, found), caption, alt, size, stands_for, needs))
            ids = tuple(point.id for point in found)
            table = Table(
                f"{id}-points",
                "table",
                f"{title}: points read off the original",
                rows=ids,
                columns=(COLUMN,),
                depends=needs,
            )
            table.points = found
            table.reading(AS_WRITTEN, "our curve, within the reading error of x")(partial(values_at, draw, found, size))
            self._add(table)
            return draw

        return register

    def chart(
        self, id: str, title: str, *, parameters: dict[str, str], size: tuple[float, float] = (6.4, 4.0)
    ) -> Callable[[Callable[..., None]], Callable[..., None]]:
        """Register the decorated function as a chart; it draws on an empty figure, given the parameters by name.

        Parameters
        ----------
        id, title, parameters, size
            As for `Chart`.

        Raises
        ------
        PaperDefinitionError
            If there is a chart of that name, or no parameter.
        """
        check_id("chart", id, self.charts)
        named = as_texts(f"chart '{id}'", "parameters", parameters)
        if not named:
            refuse(f"{self.id}: chart '{id}' has no parameters")

        def register(draw: Callable[..., None]) -> Callable[..., None]:
            self.charts[id] = Chart(id, title, draw, named, size)
            return draw

        return register

    def claims(
        self, id: str = "claims", title: str = "Claims made in the text", *, depends: Sequence[str] = ()
    ) -> Claims:
        """Add a collection of claims.

        Parameters
        ----------
        id, title, depends
            As for `Claims`.
        """
        exhibit = Claims(id, title, depends=self._declared(id, depends))
        self._add(exhibit)
        return exhibit

    def not_computable(self, id: str, title: str, reason: str, *, kind: TableKind | FigureKind = "figure") -> None:
        """Add an exhibit that cannot be recomputed, with the reason.

        Parameters
        ----------
        id, title, reason, kind
            As for `NotComputable`.
        """
        self._add(NotComputable(id, kind, title, reason))


@cache
def _printed_cells(package: str, exhibit: str) -> Mapping[tuple[str, str], str]:
    return MappingProxyType(read_transcription(importlib.resources.files(package) / "printed" / f"{exhibit}.csv").cells)
