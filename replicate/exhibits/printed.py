"""The numbers of a paper, kept as the strings it prints.

A printed CSV looks like the paper's own table, so that a person can proofread it against the page: the first
column holds the row keys, the header the column keys, and a cell the paper leaves blank is blank. Trailing
zeros are information: ``6.968`` and ``6.9680`` have different units in the last place and so accept
different computed values. Digits under an overbar stand in brackets: ``0.91[6]`` is 0.91666..., which says all
of its digits. A digit that cannot be read in the copy at hand is a question mark: ``1.2?`` is one of 1.20 to 1.29.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from functools import cached_property
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import TYPE_CHECKING

from replicate.errors import PrintedFileError, listed
from replicate.exhibits.file_names import display_name
from replicate.exhibits.near import USUAL, Near
from replicate.exhibits.notation import PLAIN, Notation, Statement
from replicate.exhibits.numerals import LOST, last_place
from replicate.exhibits.statements import scaled
from replicate.plain_text import read_text

if TYPE_CHECKING:
    from replicate.exhibits.vocabulary import Table

_SAID_DIGITS = 12  # of a repeating decimal, which says them all; numbers are compared with so many

Key = tuple[str, str]


@dataclass(frozen=True)
class PrintedValue:
    """A number as the paper prints it.

    Attributes
    ----------
    text
        The print: digits with an optional sign (``-`` or U+2212), decimal point and exponent; digits under an
        overbar in brackets, a last digit that is lost as ``?``; or what `notation` allows besides.
    row, column
        The keys of its cell.
    line
        Its line in the printed CSV, from 1; 0 if it does not come from a file.
    significant_digits
        Set where the paper prints a fixed number of significant digits and strips trailing zeros; ``None``
        where the text itself tells the precision.
    notation
        How its column prints values.
    near
        What is near it.
    reading_error
        Of a point read off a figure: half the width within which it lies.

    Raises
    ------
    PrintedFileError
        If the text is not what the notation allows.

    Examples
    --------
    >>> PrintedValue("6.968").unit, PrintedValue("6.9680").unit, PrintedValue("100").unit
    (Decimal('0.001'), Decimal('0.0001'), Decimal('1'))
    >>> PrintedValue("6.968", significant_digits=6).unit
    Decimal('0.00001')
    """

    text: str
    row: str = ""
    column: str = ""
    line: int = 0
    significant_digits: int | None = None
    notation: Notation = PLAIN
    near: Near = USUAL
    reading_error: Decimal | None = None

    def __post_init__(self) -> None:
        _ = self.statement  # refuses a text that the notation does not allow

    @cached_property
    def statement(self) -> Statement:
        """What the text states."""
        return self.notation.read(self.text)

    @property
    def states_number(self) -> bool:
        """Whether it is compared as a plain number is: no bound, interval, count, word or date."""
        return self.statement.kind == "number"

    @property
    def value(self) -> Decimal:
        """The number itself, exactly as printed; NaN for a word or a date."""
        if self.statement.kind in {"word", "date"}:
            return Decimal("NaN")
        return scaled(self.statement)[0]

    @property
    def lost_digit(self) -> bool:
        """Whether the last digit cannot be read in the copy at hand."""
        return LOST in self.statement.text

    @property
    def candidates(self) -> list[Decimal]:
        """What may stand there: the number, or ten of them where the last digit is lost."""
        if not self.lost_digit:
            return [self.value]
        texts = [self.statement.text.replace(LOST, str(digit)) for digit in range(10)]
        return [scaled(replace(self.statement, text=text))[0] for text in texts]

    @property
    def interval(self) -> tuple[Decimal, Decimal]:
        """The smallest and the largest number that rounds to the print."""
        values = self.candidates
        return min(values) - self.unit / 2, max(values) + self.unit / 2

    @property
    def ends(self) -> tuple[float, float]:
        """The interval in floating point."""
        low, high = self.interval
        return float(low), float(high)

    @property
    def repeating(self) -> bool:
        """Whether it ends with repeating decimals."""
        return "[" in self.statement.text

    @property
    def unit(self) -> Decimal:
        """The weight of the last printed digit.

        With n significant digits it is that of the n-th digit, the first being the leading one: 10^-n for a
        zero, which has no leading digit. A repeating decimal says all digits that comparisons use.
        """
        value = self.value
        if self.repeating:
            return Decimal(1).scaleb(value.adjusted() - _SAID_DIGITS + 1)
        if self.significant_digits is None:
            return Decimal(1).scaleb(last_place(value))
        leading = value.adjusted() if value else -1
        return Decimal(1).scaleb(leading - self.significant_digits + 1)


def read_printed(path: Traversable | Path, table: Table) -> dict[Key, PrintedValue]:
    """Read the printed numbers of a table.

    Parameters
    ----------
    path
        The CSV: UTF-8, comma separated, row keys in the first column, column keys in the header.
    table
        The exhibit. Its rows and columns must all be in the file, in the exhibit's order, and nothing else.

    Returns
    -------
    dict
        By (row, column), in the order of the exhibit. A cell that is blank in the paper is not there.

    Raises
    ------
    PrintedFileError
        If the file cannot be read, a cell is not a number, has more digits than the table prints, or a row
        or column is missing, unknown, out of order or duplicated. The message names file, line and cell.
    """
    name = display_name(path)
    (header_line, columns), body = _grid(path, name, table.columns)
    _check_keys(f"{name}:{header_line}", "column", [(header_line, key) for key in columns], table.columns)
    _check_keys(name, "row", [(line, row) for line, row, _ in body], table.rows)
    found = {
        (row, column): _value(name, (text, row, column, line), table)
        for line, row, texts in body
        for column, text in zip(columns, texts, strict=True)
        if not table.notation_of(column).is_blank(text)
    }
    for entered, others in table.spans.items():
        _check_once_entered(name, found, entered, others)
    return found


@dataclass(frozen=True)
class Transcription:
    """A printed CSV as it was typed.

    Attributes
    ----------
    columns
        Column keys, in the order of the file.
    lines
        Line of each row by its key, in the order of the file.
    cells
        Texts by (row, column); blank cells are left out.
    """

    columns: tuple[str, ...]
    lines: dict[str, int]
    cells: dict[Key, str]


def read_transcription(path: Traversable | Path) -> Transcription:
    """Read a printed CSV as texts; nothing is compared with an exhibit's keys: `read_printed` does that.

    Raises
    ------
    PrintedFileError
        If the file cannot be read, its rows are of different lengths, or a row or column appears twice.
    """
    name = display_name(path)
    (header_line, columns), body = _grid(path, name, ("row",))
    _check_once(f"{name}:{header_line}", "column", [(header_line, key) for key in columns])
    _check_once(name, "row", [(line, row) for line, row, _ in body])
    cells = {(row, column): text for _, row, texts in body for column, text in zip(columns, texts, strict=True) if text}
    return Transcription(tuple(columns), {row: line for line, row, _ in body}, cells)


def _grid(
    path: Traversable | Path, name: str, needed: Sequence[str]
) -> tuple[tuple[int, list[str]], list[tuple[int, str, list[str]]]]:
    """Return line and column keys of the header, then line, row key and cells of every row."""
    records = _records(path, name)
    if not records:
        msg = f"{name}:1: the file is empty; expected: a header with the columns {listed(needed)}"
        raise PrintedFileError(msg)
    (header_line, header), *body = records
    for sign, called in ((";", "semicolons"), ("\t", "tabs")):
        if len(header) == 1 and sign in header[0]:
            msg = f"{name}:{header_line}: cells are separated by {called}; allowed: commas, and quotes around 1,5"
            raise PrintedFileError(msg)
    for line, cells in records:
        if (cells[0].startswith("#") and len(cells) == 1) or cells[0].lower() == "sep=":
            msg = f"{name}:{line}: '{cells[0]}' is not a row; a CSV has no comments: remove the line"
            raise PrintedFileError(msg)
    if "" in header[1:]:
        msg = f"{name}:{header_line}: column {header.index('', 1) + 1} has no name; remove the comma too many"
        raise PrintedFileError(msg)
    for line, cells in body:
        if len(cells) != len(header):
            msg = f"{name}:{line}: row '{cells[0]}' has {len(cells)} cells, the header has {len(header)}"
            raise PrintedFileError(msg)
    return (header_line, header[1:]), [(line, cells[0], cells[1:]) for line, cells in body]


def _records(path: Traversable | Path, name: str) -> list[tuple[int, list[str]]]:
    """Return the non-empty records with the line on which each ends."""
    content = read_text(path, name, PrintedFileError)
    reader = csv.reader(io.StringIO(content, newline=""), strict=True)
    records = []
    try:
        for cells in reader:
            stripped = [cell.strip() for cell in cells]
            if any(stripped):
                records.append((reader.line_num, stripped))
    except csv.Error as error:
        msg = f"{name}:{reader.line_num}: is not a CSV file: {error}"
        raise PrintedFileError(msg) from error
    return records


def _check_once(place: str, kind: str, found: Sequence[tuple[int, str]]) -> None:
    """Demand that no key appears twice."""
    first_line: dict[str, int] = {}
    for line, key in found:
        if key in first_line:
            where = place if kind == "column" else f"{place}:{line}"
            also = f" (first in line {first_line[key]})" if kind == "row" else ""
            msg = f"{where}: {kind} '{key}' appears twice{also}"
            raise PrintedFileError(msg)
        first_line[key] = line


def _check_once_entered(name: str, found: Mapping[Key, PrintedValue], entered: Key, others: Iterable[Key]) -> None:
    """Demand that a number that stands for several cells is entered in the one that its table names, and there only."""
    if entered not in found:
        msg = f"{name}: row '{entered[0]}', column '{entered[1]}' is blank, though it stands for other cells, too"
        raise PrintedFileError(msg)
    for other in others:
        if other in found:
            where = f"{name}:{found[other].line}: row '{other[0]}', column '{other[1]}'"
            msg = f"{where} is not blank, though the number in row '{entered[0]}', column '{entered[1]}' stands for it"
            raise PrintedFileError(msg)


def _check_keys(place: str, kind: str, found: Sequence[tuple[int, str]], expected: Sequence[str]) -> None:
    """Demand the expected keys, all of them, once each and in their order."""
    _check_once(place, kind, found)
    for line, key in found:
        if key not in expected:
            where = place if kind == "column" else f"{place}:{line}"
            msg = f"{where}: {kind} '{key}' is not one of the exhibit's; allowed: {listed(expected)}"
            raise PrintedFileError(msg)
    keys = {key for _, key in found}
    missing = [key for key in expected if key not in keys]
    if missing:
        last = f":{found[-1][0]}" if kind == "row" and found else ""
        msg = f"{place}{last}: {kind} {listed(missing)} is missing"
        raise PrintedFileError(msg)
    for (line, key), wanted in zip(found, expected, strict=True):
        if key != wanted:
            where = place if kind == "column" else f"{place}:{line}"
            order = listed(expected)
            msg = f"{where}: {kind} '{key}' is out of order, '{wanted}' comes first; expected order: {order}"
            raise PrintedFileError(msg)


def _value(place: str, value: tuple[str, str, str, int], table: Table) -> PrintedValue:
    text, _, column, line = value
    where = f"{place}:{line}: column '{column}'"
    digits = table.significant_digits
    try:
        printed = PrintedValue(*value, digits, table.notation_of(column), table.near)
    except PrintedFileError as error:
        msg = f"{where}: {error}"
        raise PrintedFileError(msg) from error
    # Trailing zeros may be place holders: only digits that say something can be too many.
    if digits is None or not printed.states_number or not printed.value or printed.repeating:
        return printed
    if last_place(printed.value.normalize()) < printed.unit.adjusted():
        msg = f"{where}: '{text}' has more than the {digits} significant digits that this table prints"
        raise PrintedFileError(msg)
    return printed
