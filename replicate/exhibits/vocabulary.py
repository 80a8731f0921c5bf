"""The exhibit vocabulary: the words in which a paper's package describes itself.

A paper is a list of exhibits. A `Table` (a printed table, a worked example, a formula) has *readings*,
functions that return the whole exhibit as a DataFrame with the row and column keys of its printed CSV; a
`Figure` has one function that draws on an ordinary matplotlib figure; `Claims` collects sentences that can be
true or false; `NotComputable` is an exhibit that exists in the paper but cannot be recomputed, with the reason.
This module only describes: computing, judging and rendering happen elsewhere. Everything described remembers in
``module`` where it is defined, which decides its place (see `replicate.exhibits.order`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, get_args

from replicate.errors import PaperDefinitionError
from replicate.exhibits.claims import Claims
from replicate.exhibits.comparisons import Comparison
from replicate.exhibits.definitions import (
    as_keys,
    as_mapping,
    check_count,
    check_id,
    check_kind,
    check_lists,
    check_mappings,
    check_one_of,
    check_spans,
    check_texts,
)
from replicate.exhibits.drawn import Figure, FigureKind
from replicate.exhibits.exclusion import Rule
from replicate.exhibits.near import USUAL, Near
from replicate.exhibits.notation import PLAIN, Notation
from replicate.exhibits.order import module_being_imported
from replicate.exhibits.printed import Key
from replicate.exhibits.read_off import Point
from replicate.exhibits.readings import AS_WRITTEN, Compute, Many, Reading
from replicate.exhibits.rows import Row, frame_of_rows
from replicate.exhibits.trials import ComputedTrial, Trials

if TYPE_CHECKING:
    import pandas as pd

_MOST_DIGITS = 100

TableKind = Literal["table", "example", "formula"]


@dataclass
class Table:
    """An exhibit with rows and columns: a table, a worked example or a formula.

    Attributes
    ----------
    id
        The paper's own numbering: ``table-1``, ``example-2-1``, ``eq-7a``.
    kind
        ``table``, ``example`` or ``formula``.
    title, caption
        One line, and what a reader should know besides, in Markdown.
    rows, columns
        The keys, in the paper's order. With a printed CSV they must agree with it exactly.
    labels
        Display text (may hold LaTeX math between ``$``) of row and column keys that need one.
    units
        Unit of a column, as text.
    significant_digits
        Set where the paper prints a fixed number of significant digits and strips trailing zeros ("6.968" then
        means 6.96800). ``None``: the printed string itself tells the precision.
    printed
        Whether the paper prints numbers in it, so that there is a printed CSV.
    readings
        By id, ``as-written`` first.
    notation
        How values are printed, for the table or by column; plain numbers where nothing is said.
    near
        What is near a print, for the verdict of that name.
    spans
        Where one printed number stands for several cells: by the cell in which it is entered, the others.
    points
        Of the table that belongs to a figure: what was read off the original.
    depends
        Files and folders outside the paper's folder, relative to it, that the readings use without `Paper.data`: when
        one of them changes, the exhibit is recomputed.
    cases
        Whether the rows or the columns are the cases for which the other keys, the quantities, are printed. Not
        given: the rows, or the column if there is just one.
    comparisons
        Rankings and bounds that the paper reads off its numbers (`replicate.exhibits.comparisons`).
    module
        The module in which it is defined; set by itself.
    trials
        Returns what a reader may try out, by row, or by row and case where a row holds several: two texts, plant and
        controller.
    computed_trial
        The same for rows whose parameters are computed: returns the two texts of a row from its numbers as written.
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
    notation: Notation | Mapping[str, Notation] = PLAIN
    near: Near = USUAL
    spans: Mapping[Key, Sequence[Key]] = field(default_factory=dict)
    points: Sequence[Point] = ()
    depends: tuple[str, ...] = ()
    cases: Literal["rows", "columns", ""] = ""
    comparisons: list[Comparison] = field(default_factory=list)
    trials: Trials | None = None
    computed_trial: ComputedTrial | None = None
    module: str = field(default_factory=module_being_imported, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        what = f"{self.id}"
        check_id("exhibit", self.id)
        check_one_of(what, "kind", self.kind, get_args(TableKind))
        check_one_of(what, "cases", self.cases, ("rows", "columns", ""))
        check_texts(what, title=self.title, caption=self.caption)
        check_lists(what, rows=self.rows, columns=self.columns)
        check_mappings(what, labels=self.labels, units=self.units)
        check_kind(what, "near", self.near, Near)
        if self.significant_digits is not None:
            check_count(what, "significant_digits", self.significant_digits, _MOST_DIGITS)
        check_spans(what, self.spans)
        if not isinstance(self.notation, Mapping):
            check_kind(what, "notation", self.notation, Notation)
        else:
            for column, notation in self.notation.items():
                check_kind(what, f"notation of '{column}'", notation, Notation)

    def check(self) -> None:
        """Check that what is declared of rows and columns speaks of rows and columns of the table.

        Raises
        ------
        PaperDefinitionError
            If it does not; the message says what is allowed.
        """
        columns = [] if isinstance(self.notation, Notation) else list(self.notation)
        cells = [cell for key, others in self.spans.items() for cell in (key, *others)]
        for kind, named, known in (
            ("column", [*columns, *(column for _, column in cells), *self.units], self.columns),
            ("row", [row for row, _ in cells], self.rows),
            # a table that leaves its rows or columns to the reading knows them only when it is computed
            ("row or column", self.labels, (*self.rows, *self.columns) if self.rows and self.columns else ()),
        ):
            for key in named:
                if known and key not in known:
                    msg = f"{self.id}: there is no {kind} '{key}'; allowed: {', '.join(known)}"
                    raise PaperDefinitionError(msg)

    def notation_of(self, column: str) -> Notation:
        """Return how a column prints its values.

        Parameters
        ----------
        column
            The column's key.
        """
        return self.notation if isinstance(self.notation, Notation) else self.notation.get(column, PLAIN)

    def frame(self, rows: Mapping[str, Row]) -> pd.DataFrame:
        """Return the whole table as a reading returns it, from the cells of each row.

        Parameters
        ----------
        rows
            By row key, in any order where the table names its rows: a mapping from column key to cell (a column left
            out is blank), a sequence with a cell for each column, or the cell itself if there is one column. A cell is
            a number, or what a column of another notation holds: a word, a date, a pair.

        Returns
        -------
        pandas.DataFrame
            Rows and columns in the table's order. A table that names no rows or no columns takes those given.

        Raises
        ------
        PaperDefinitionError
            If rows or columns are not those of the table, or a row has too few or too many cells.

        Examples
        --------
        >>> table = Table("table-1", "table", "Squares", rows=("two", "three"), columns=("n", "square"))
        >>> table.frame({"three": [3, 9], "two": {"n": 2, "square": 4}})
               n  square
        two    2       4
        three  3       9
        >>> table.frame({"two": [2, 4]})
        Traceback (most recent call last):
        replicate.errors.PaperDefinitionError: table-1: row 'three' is missing
        """
        return frame_of_rows(self.id, self.rows, self.columns, rows)

    def blank(self) -> pd.DataFrame:
        """Return the table with nothing computed: what a reading returns where all inputs are missing."""
        return self.frame({row: [math.nan] * len(self.columns) for row in self.rows})

    @property
    def cases_are_columns(self) -> bool:
        """Whether each column is a case and each row a quantity."""
        return self.cases == "columns" or (not self.cases and len(self.columns) == 1)

    def case(self, row: str, column: str) -> str:
        """Return the case to which the cell at ``row`` and ``column`` belongs."""
        return column if self.cases_are_columns else row

    def quantity(self, row: str, column: str) -> str:
        """Return the quantity that the cell at ``row`` and ``column`` holds."""
        return row if self.cases_are_columns else column

    def key(self, case: str, quantity: str) -> tuple[str, str]:
        """Return row and column of the ``quantity`` of a ``case``."""
        return (quantity, case) if self.cases_are_columns else (case, quantity)

    def reading(
        self,
        id: str,
        title: str,
        note: str = "",
        *,
        inputs: Sequence[str] = (),
        inputs_of: Mapping[str, Sequence[str]] | None = None,
        tried: Mapping[str, int] | None = None,
        rules_out: Mapping[str, Rule] | None = None,
        many: Many | None = None,
    ) -> Callable[[Compute], Compute]:
        """Register the decorated function as a reading; the first must be ``as-written``.

        Parameters
        ----------
        id, title, note
            As for `Reading`.
        inputs
            Quantities of this table that the reading takes from the print. The function is then called as
            ``compute(case, given)``, with the numbers by quantity in `given`, and returns numbers by quantity. It is
            called for the printed numbers and for others that round to them, and returns nothing for a quantity
            that it does not compute. ``"w0@first"`` is the quantity ``w0`` of the case ``first``,
            ``"eq-7:a:value"`` the cell of another table, ``"p=1.6667"`` a number of the text. A case that prints not
            all of the inputs is left out.
        inputs_of
            The inputs of single cases where they are others.
        tried
            How many alternatives were tried for each free choice, as ``{"order of the Padé model": 4}``.
        rules_out
            For a reading with printed inputs, by quantity: called as ``rule(case, box, ends)`` with an interval for
            each input, it returns whether the quantity certainly takes no value between the ends anywhere in the box.
            With it, that a value does not hold for any inputs that round to the print is proven, not only searched.
        many
            For a reading with printed inputs that computes many cases at once in less time than one by one: called
            as ``many([(case, given), ...])``, it returns what the function returns for each, or ``None``.

        Raises
        ------
        PaperDefinitionError
            If the id is taken, or the first reading is not ``as-written``.
        """

        def register(compute: Compute) -> Compute:
            if not self.readings and id != AS_WRITTEN:
                msg = f"{self.id}: the first reading must be '{AS_WRITTEN}', not '{id}'"
                raise PaperDefinitionError(msg)
            check_id(f"reading of {self.id}", id, self.readings)
            what = f"reading '{id}'"
            self.readings[id] = Reading(
                id,
                title,
                compute,
                note,
                as_keys(what, "inputs", inputs),
                {
                    case: as_keys(what, f"inputs_of of '{case}'", others)
                    for case, others in as_mapping(what, "inputs_of", inputs_of).items()
                },
                as_mapping(what, "tried", tried),
                as_mapping(what, "rules_out", rules_out),
                many,
            )
            return compute

        return register


@dataclass(frozen=True)
class NotComputable:
    """A numbered exhibit of the paper that cannot be recomputed, and why.

    Attributes
    ----------
    id
        The paper's own numbering.
    kind
        What it is: ``table``, ``example``, ``formula``, ``figure`` or ``diagram``.
    title
        One line.
    reason
        Why it cannot be recomputed.
    module
        The module in which it is defined; set by itself.
    """

    id: str
    kind: TableKind | FigureKind
    title: str
    reason: str
    module: str = field(default_factory=module_being_imported, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        check_id("exhibit", self.id)
        check_one_of(self.id, "kind", self.kind, (*get_args(TableKind), *get_args(FigureKind)))
        check_texts(self.id, title=self.title, reason=self.reason)


Exhibit = Table | Figure | Claims | NotComputable
