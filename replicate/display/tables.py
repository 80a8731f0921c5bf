"""A table of a paper as the report shows it: every printed value above what each reading computes for it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from replicate.display import numbers
from replicate.display.addresses import trial_address
from replicate.display.distance import off
from replicate.display.pieces import Piece, pieces
from replicate.display.words import CERTAINTIES
from replicate.exhibits import Reading, Table
from replicate.exhibits.conventions import tallies
from replicate.exhibits.frames import FrameCells
from replicate.exhibits.matching import Match
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.readings import input_name
from replicate.exhibits.results import Ranges, TableResult
from replicate.verdicts.rows import ERRORS, HOLDING, Computed, VerdictRow
from replicate.verdicts.strength import Strength, strengths

Point = tuple[tuple[str, str], ...]  # inputs: the name of each, and the number as it is shown
_PROMISED = 10  # digits in which a computed number is right
_WRONG = {*ERRORS, "unexplained"}


@dataclass(frozen=True)
class Value:
    """What one reading computes for a cell.

    Attributes
    ----------
    text, full
        The number as shown, and with all digits.
    number
        The number itself; none where a word is computed, or nothing.
    match
        How it compares with the print.
    range
        Its range over the printed inputs of the reading, as text; empty if there is none.
    point
        The inputs at which most of the case's cells hold together, names and numbers; empty if there is no range.
    certainty
        Why no inputs that round to the print give the print, in words; empty where some do, or there is no range.
    off
        How far the print is off, seen from this value; empty if it is equal or nothing is printed.
    """

    reading: Reading
    text: str
    full: str
    match: Match
    range: str = ""
    point: Point = ()
    certainty: str = ""
    off: str = ""
    number: float | None = None

    @property
    def same(self) -> tuple[str, ...]:
        """What two readings share whose lines are one: the digits that are promised of a number, match and range."""
        number = f"{self.number:.{_PROMISED}g}" if self.full and self.number is not None else ""
        return number or self.full or self.text, self.match.kind, self.range


@dataclass(frozen=True)
class Cell:
    """One cell: the print, its verdict (if something is printed) and the values computed for it."""

    row: str
    column: str
    printed: str
    verdict: VerdictRow | None
    values: list[Value]
    note: int = 0  # number of the explanation under the table; 0 if it needs none
    texts: Mapping[str, str] = field(default_factory=dict)  # the column's numbers with padding

    @property
    def alike(self) -> list[tuple[list[str], Value]]:
        """The computed values with the readings that agree in them, in the order of the readings."""
        groups: dict[tuple[str, ...], tuple[list[str], Value]] = {}
        for value in self.values:
            all_digits = value.full or value.text, value.match.kind, value.range
            groups.setdefault(all_digits, ([], value))[0].append(value.reading.id)
        return list(groups.values())

    def padded(self, text: str) -> str:
        """Return a number of this cell padded so that the decimal points of its column are in line."""
        return self.texts.get(text, text)


@dataclass(frozen=True)
class Line:
    """One line of a row: the readings that agree in all of its cells, and what they compute."""

    readings: list[str]
    values: list[Value]
    places: str  # of the readings among those of the table, from 2 on: the first choice of a list is "all"
    repeats: list[bool]  # which values the line above shows already, if with another range


@dataclass(frozen=True)
class Note:
    """An explanation and the cells it explains."""

    number: int
    verdict: VerdictRow
    where: dict[str, list[str]]  # the rows of each column, or the columns of each row, whichever is shorter
    corrections: list[VerdictRow]
    ranges: dict[str, list[tuple[str, str, str]]]  # row, column and range over printed inputs, by what is certain of it


@dataclass(frozen=True)
class TableView:
    """Everything the table's template needs."""

    table: Table
    columns: list[str]
    rows: list[tuple[str, list[Cell]]]
    readings: list[Reading]
    notes: list[Note]
    errors: dict[str, str]
    verdicts: list[VerdictRow]
    shortened: list[tuple[str, str]] = field(default_factory=list)  # quantities with truncated cells, and the count
    strengths: dict[str, Strength] = field(default_factory=dict)  # by reading
    trials: dict[str, list[tuple[str, str]]] = field(default_factory=dict)  # by row: case, and where one tries it out
    every_card: bool = True  # whether cells that hold have a card, too
    left_out: int = 0  # rows that are in the files only

    def has_card(self, verdict: VerdictRow) -> bool:
        """Return whether a printed value has a card; all that do not hold do."""
        return self.every_card or verdict.verdict not in HOLDING

    @property
    def differing(self) -> set[str]:
        """The rows in which some printed value that can be computed does not hold."""
        return {one.row for one in self.verdicts if one.verdict not in HOLDING and one.verdict != "not-computable"}

    @property
    def matches(self) -> set[str]:
        """The kinds of match that occur."""
        return {value.match.kind for _, cells in self.rows for cell in cells for value in cell.values if value.full}

    @property
    def differ_later(self) -> bool:
        """Whether numbers of a cell look alike and differ, beyond the digits that are shown."""
        cells = [cell for _, row in self.rows for cell in row]
        found = [{value.same: value.text for value in cell.values if value.full} for cell in cells]
        return any(len(set(texts.values())) < len(texts) for texts in found)

    @property
    def line_count(self) -> int:
        """How long the table is."""
        return sum(self.height(cells) for _, cells in self.rows)

    def height(self, cells: list[Cell]) -> int:
        """Return how many lines a row has."""
        lines = len(self.lines(cells))
        return lines + 1 if self.verdicts or lines > 1 else lines

    @property
    def pieces(self) -> list[Piece]:
        """The table in pieces that fit a page."""
        return pieces(self)

    @staticmethod
    def found(row: list[Cell]) -> str:
        """Return the verdicts of a row as names of classes, by which a page selects what it shows."""
        return classes(cell.verdict.verdict for cell in row if cell.verdict)

    def lines(self, row: list[Cell]) -> list[Line]:
        """Return the lines of a row: readings that agree in all of it share one, and what computes nothing has none."""
        places = {reading.id: str(place) for place, reading in enumerate(self.readings, 2)}
        lines: dict[tuple[tuple[str, ...], ...], tuple[list[str], list[Value]]] = {}
        for values in zip(*(entry.values for entry in row), strict=True):
            ids, _ = lines.setdefault(tuple(value.same for value in values), ([], list(values)))
            ids.append(values[0].reading.id)
        found: list[Line] = []
        told = [line for line in lines.values() if any(value.text for value in line[1])]
        for ids, shown in told if told or self.verdicts else lines.values():
            above = [value.same[:2] for value in found[-1].values] if found else [None] * len(shown)
            repeats = [one.same[:2] == said for one, said in zip(shown, above, strict=True)]
            found.append(Line(ids, shown, " ".join(places[id] for id in ids), repeats))
        return found


def classes(verdicts: Iterable[str]) -> str:
    """Return verdicts as names of classes of an element; ``has-wrong`` stands for errors and open questions.

    Examples
    --------
    >>> classes(["near", "misprint", "near"])
    'has-near has-misprint has-wrong'
    """
    found = dict.fromkeys(verdicts)
    return " ".join([f"has-{id}" for id in found] + (["has-wrong"] if _WRONG & found.keys() else []))


def table_view(table: Table, result: TableResult, verdicts: Iterable[VerdictRow]) -> TableView:
    """Arrange a table for display.

    Parameters
    ----------
    table
        The exhibit.
    result
        What its readings computed; a reading that failed is listed with its reason.
    verdicts
        The verdicts on this exhibit's printed values.

    Returns
    -------
    TableView
        Rows and columns in the paper's order; without printed values, those of the first reading.
    """
    by_cell = {(verdict.row, verdict.column): verdict for verdict in verdicts}
    frames = {id: result.cells[id] for id in table.readings if id in result.cells}
    first = next(iter(frames.values()), None)
    rows = list(table.rows) or ([] if first is None else list(first.rows))
    columns = list(table.columns) or ([] if first is None else list(first.columns))
    notes = _notes(by_cell.values(), columns)
    note_of = {where: note.number for note, cells in notes for where in cells}
    cells = {
        (row, column): _cell(table, result, frames, (row, column), by_cell.get((row, column)))
        for row in rows
        for column in columns
    }
    for column in columns:
        texts = numbers.aligned(text for row in rows for text in _texts(cells[row, column]))
        for row in rows:
            plain = cells[row, column]
            cells[row, column] = Cell(
                row, column, plain.printed, plain.verdict, plain.values, note_of.get((row, column), 0), texts
            )
    return TableView(
        table,
        columns,
        [(row, [cells[row, column] for column in columns]) for row in rows],
        [table.readings[id] for id in frames],
        [note for note, _ in notes],
        dict(result.errors),
        list(by_cell.values()),
        _shortened(table, by_cell.values()),
        _strengths(table, frames, by_cell),
        _trials(result),
    )


def _trials(result: TableResult) -> dict[str, list[tuple[str, str]]]:
    """Return by row the cases that can be tried out, each with its address."""
    found: dict[str, list[tuple[str, str]]] = {}
    for row, case, *loop in result.trials.all:
        found.setdefault(row, []).append((case, trial_address(*loop)))
    return found


def _cell(
    table: Table, result: TableResult, frames: Mapping[str, FrameCells], key: Key, verdict: VerdictRow | None
) -> Cell:
    judged = {one.reading: one for one in verdict.values} if verdict else {}
    printed = verdict.value if verdict else None
    values = []
    for id, cells in frames.items():
        reading = table.readings[id]
        found = judged[id].match if id in judged else Match("none")
        if key in cells.words:
            word = cells.words[key]
            values.append(
                Value(reading, numbers.shown_word(word, printed), word if found.kind != "none" else "", found)
            )
            continue
        number = cells.numbers.get(key)
        text, full = numbers.shown(number, printed), numbers.full(number)
        texts = _range(table, result.ranges.get(id), key, printed)
        apart = off(printed, number) if found.kind in {"near", "differs"} else ""
        certainty = CERTAINTIES.get(judged[id].certainty, "") if id in judged else ""
        values.append(Value(reading, text, full, found, *texts, certainty, apart, number))
    return Cell(*key, numbers.overlined(verdict.printed) if verdict else "", verdict, values)


def _range(table: Table, ranges: Ranges | None, key: Key, printed: PrintedValue | None) -> tuple[str, Point]:
    """Return the range of a cell over the printed inputs, and the inputs at which its case holds best, as texts."""
    if ranges is None or key not in ranges.lower:
        return "", ()
    low, high = (numbers.shown(end, printed) for end in (ranges.lower[key], ranges.upper[key]))
    point = ranges.points[table.case(*key)]
    inputs = tuple((input_name(name), numbers.shown(number, None)) for name, number in point.items())
    return numbers.between(low, high), inputs


def _shortened(table: Table, verdicts: Iterable[VerdictRow]) -> list[tuple[str, str]]:
    """Return, for every quantity with several cells of which some are truncated, how many are which."""
    matches = {
        (verdict.row, verdict.column): one.match
        for verdict in verdicts
        for one in verdict.values
        if one.reading == verdict.reading
    }
    counts = tallies(table, matches)
    return [(quantity, count.sentence) for quantity, count in counts.items() if count.truncated and count.total > 1]


def _strengths(table: Table, readings: Iterable[str], verdicts: Mapping[Key, VerdictRow]) -> dict[str, Strength]:
    """Return how strong the match of each reading is that is judged by some printed value."""
    computed: dict[str, dict[Key, Computed]] = {id: {} for id in readings}
    for key, verdict in verdicts.items():
        for one in verdict.values:
            if one.reading in computed:
                computed[one.reading][key] = one
    return {id: one for id, one in strengths(table, computed).items() if one.compared}


def _texts(cell: Cell) -> list[str]:
    return [cell.printed, *(value.text for value in cell.values if value.full)]


def _notes(verdicts: Iterable[VerdictRow], columns: Sequence[str]) -> list[tuple[Note, list[Key]]]:
    """Return the explanations of cells that do not hold, each once, numbered in the order of the table."""
    groups: dict[tuple[str, str, str, str], list[VerdictRow]] = {}
    for verdict in verdicts:
        if verdict.verdict not in HOLDING and (verdict.explanation or verdict.verdict != "near"):
            groups.setdefault((verdict.verdict, verdict.cause, verdict.consequence, verdict.explanation), []).append(
                verdict
            )
    notes = []
    for number, group in enumerate(groups.values(), 1):
        keys = [(verdict.row, verdict.column) for verdict in group]
        by_row: dict[str, list[str]] = {}
        by_column: dict[str, list[str]] = {}
        for row, column in keys:
            by_row.setdefault(row, []).append(column)
            by_column.setdefault(column, []).append(row)
        where = by_row if len(by_row) <= len(by_column) and columns != ["value"] else by_column
        corrections = [verdict for verdict in group if verdict.corrected]
        notes.append((Note(number, group[0], where, corrections, _ranges(group)), keys))
    return notes


def _ranges(group: Iterable[VerdictRow]) -> dict[str, list[tuple[str, str, str]]]:
    """Return the ranges over printed inputs of cells that do not hold, by what is certain of them, in words."""
    found: dict[str, list[tuple[str, str, str]]] = {}
    for verdict in group:
        one = next((one for one in verdict.values if one.reading == verdict.reading), None)
        if one is not None and (words := CERTAINTIES.get(one.certainty)):
            low, high = (numbers.shown(end, verdict.value) for end in (one.lower, one.upper))
            found.setdefault(words, []).append((verdict.row, verdict.column, numbers.between(low, high)))
    return found
