"""A table of a paper for the handout: each printed value beside what chosen readings compute for it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from replicate.display.labels import key_text
from replicate.display.numbers import aligned
from replicate.display.tables import Cell, TableView, Value
from replicate.display.words import MATCHES, VERDICTS
from replicate.errors import TemplateError
from replicate.exhibits import Table
from replicate.exhibits.numerals import MINUS
from replicate.handout.tree import Element, inlines, plain, span, string

# What the signs say to a reader who has not seen the report; a verdict of no more words is its own name.
_MATCHES = {
    "equal": "equal to the printed digits",
    "consistent": "equal within the rounding of the printed inputs",
    "near": "within 1 % or two units of the last digit",
    "differs": "neither",
}
_VERDICTS = {
    "reproduced": "reproduced as the paper says",
    "consistent": "consistent with the rounding of the printed inputs",
    "damaged": "wrong in the paper or in the copy at hand",
    "reconstructed": "reconstructed under another reading",
    "discrepant": "differs for a known cause",
}


@dataclass(frozen=True)
class Choice:
    """What of a table the handout shows; nothing given means everything.

    Attributes
    ----------
    readings
        Reading ids with the heading of their columns.
    printed
        Whether the printed values are shown. (A table of the project's own has none.)
    digits
        Significant digits of computed values in a table without printed ones; 0: six.
    transposed
        Whether the paper's columns are shown as rows; `columns` and `rows` are those shown, then.
    """

    columns: Sequence[str] = ()
    rows: Sequence[str] = ()
    readings: Mapping[str, str] | None = None
    labels: Mapping[str, str] | None = None
    printed: bool = True
    digits: int = 0
    transposed: bool = False


def key_table(view: TableView, choice: Choice) -> Element:
    """Return the table as an element of pandoc's document tree, without its caption.

    Raises
    ------
    TemplateError
        If a row, column or reading does not exist.
    """
    table = view.table
    if choice.transposed:
        view = transposed_view(view)
    if choice.digits:
        view = replace(view, rows=_rounded(view.rows, choice))
    columns = _chosen("column", choice.columns, view.columns)
    rows = _chosen("row", choice.rows, [row for row, _ in view.rows])
    titles = {reading.id: reading.id for reading in view.readings}
    readings = _chosen("reading", list(choice.readings or ()), list(titles))
    titles |= dict(choice.readings or {})
    printed = bool(choice.printed and view.verdicts)
    labels = {**table.labels, **(choice.labels or {})}

    def label(key: str) -> list[Element]:
        return inlines(labels.get(key, key_text(key)))

    groups = len(readings) + printed
    by_row = dict(view.rows)
    heads = _heads(table, columns, [titles[id] for id in readings], printed, label)
    body = []
    for row in rows:
        cells = [_cell(label(row), "AlignLeft")]
        for found in (cell for key, cell in zip(view.columns, by_row[row], strict=True) if key in columns):
            cells += ([_printed_cell(found)] if printed else []) + [
                _computed_cell(found, value) for value in found.values if value.reading.id in readings
            ]
        body.append(_row(cells))
    aligned = [["AlignLeft"], *([["AlignRight"]] * (groups * len(columns)))]
    widths = [[{"t": align[0]}, {"t": "ColWidthDefault"}] for align in aligned]
    no_attr = ["", [], []]
    return {
        "t": "Table",
        "c": [
            ["", ["values"], []],
            [None, []],
            widths,
            [no_attr, heads],
            [[no_attr, 1, [], body]],
            [no_attr, []],
        ],
    }


def legend(view: TableView, choice: Choice) -> list[Element]:
    """Return what bold type and the signs in the shown cells mean, as sentences of inline content."""
    if choice.transposed:
        view = transposed_view(view)
    columns, rows = choice.columns or view.columns, choice.rows or [row for row, _ in view.rows]
    shown = [
        cell
        for row, cells in view.rows
        for key, cell in zip(view.columns, cells, strict=True)
        if row in rows and key in columns
    ]
    readings = choice.readings or {reading.id for reading in view.readings}
    matches = {
        value.match.kind for cell in shown for value in cell.values if cell.verdict and value.reading.id in readings
    }
    verdicts = {cell.verdict.verdict for cell in shown if cell.verdict}
    signs = [
        (span([string(sign)], "sign", "bare", kind), _MATCHES[kind])
        for kind, (sign, _) in MATCHES.items()
        if kind in matches and kind in _MATCHES
    ]
    badges = [
        (span([string(word.symbol)], "badge", "bare", word.id), _VERDICTS.get(word.id, word.name))
        for word in VERDICTS.values()
        if word.id in verdicts
    ]
    return [*inlines("Bold: as printed."), *_listed(signs), *_listed(badges)]


def _listed(signs: Sequence[tuple[Element, str]]) -> list[Element]:
    """Return signs and their meanings as a sentence, each sign on one line with the first word after it."""
    out: list[Element] = []
    for place, (sign, meaning) in enumerate(signs):
        first, _, rest = meaning.partition(" ")
        end = "." if place == len(signs) - 1 else ","
        words = inlines(f"{rest}{end}") if rest else []
        out += [{"t": "Space"}, sign, string(f"\N{NO-BREAK SPACE}{first}{'' if rest else end}")]
        out += [{"t": "Space"}, *words] if words else []
    return out


def transposed_view(view: TableView) -> TableView:
    """Return the table with rows and columns exchanged, decimal points of the new columns in line."""
    rows = [(column, [cells[place] for _, cells in view.rows]) for place, column in enumerate(view.columns)]
    return replace(view, columns=[row for row, _ in view.rows], rows=_lined_up(rows))


def _lined_up(rows: Sequence[tuple[str, list[Cell]]]) -> list[tuple[str, list[Cell]]]:
    columns = zip(*(cells for _, cells in rows), strict=True)
    texts = [
        aligned(text for cell in column for text in (cell.printed, *(value.text for value in cell.values)))
        for column in columns
    ]
    return [
        (row, [replace(cell, texts=lined) for cell, lined in zip(cells, texts, strict=True)]) for row, cells in rows
    ]


def _rounded(rows: Sequence[tuple[str, list[Cell]]], choice: Choice) -> list[tuple[str, list[Cell]]]:
    """Return the rows with computed values of so many digits, decimal points of the shown rows in line again."""
    shown = [
        (
            row,
            [replace(cell, values=[_short(value, choice.digits) for value in cell.values]) for cell in cells],
        )
        for row, cells in rows
        if not choice.rows or row in choice.rows
    ]
    return _lined_up(shown)


def _short(value: Value, digits: int) -> Value:
    """Return a value with so many digits, a zero at the end among them; a whole number is a count and stays."""
    number = value.full.replace(MINUS, "-")
    if not number.strip("-").isdigit():
        number = f"{float(number):#.{digits}g}".removesuffix(".") if number else ""
    return replace(value, text=number.replace("-", MINUS))


def _heads(
    table: Table,
    columns: Sequence[str],
    titles: Sequence[str],
    printed: bool,
    label: Callable[[str], list[Element]],
) -> list[Any]:
    under = [span(inlines("printed"), "over-badge")] if printed else []
    under += [span(inlines(title), "over-sign") if printed else span(inlines(title)) for title in titles]
    groups = [
        _cell([*label(key), *_unit(table, key)], "AlignCenter" if len(under) > 1 else "AlignRight", len(under))
        for key in columns
    ]
    first = _row([_cell([], "AlignLeft"), *groups])
    if len(under) < 2:
        return [first]
    return [
        first,
        _row([_cell([], "AlignLeft"), *(_cell([head], "AlignRight") for _ in columns for head in under)]),
    ]


def _unit(table: Table, key: str) -> list[Element]:
    return [string(","), {"t": "Space"}, *inlines(table.units[key])] if key in table.units else []


def _printed_cell(cell: Cell) -> Any:
    if cell.verdict is None:
        return _cell([], "AlignRight")
    word = VERDICTS[cell.verdict.verdict]
    mark = span([string(word.symbol)], "badge", word.id)
    return _cell([span([string(cell.padded(cell.printed))], "printed"), mark], "AlignRight")


def _computed_cell(cell: Cell, value: Value) -> Any:
    sign = MATCHES[value.match.kind][0]
    text = [string(cell.padded(value.text))] if value.text else []
    return _cell([span(text, "computed"), span([string(sign)], "sign", value.match.kind)], "AlignRight")


def _cell(content: Sequence[Element], align: str, width: int = 1) -> Any:
    """Return a cell of a table; like rows, cells are bare lists in pandoc's tree."""
    blocks = [plain(content)] if content else []
    return [["", [], []], {"t": align}, 1, width, blocks]


def _row(cells: Sequence[Any]) -> Any:
    return [["", [], []], list(cells)]


def _chosen(what: str, wanted: Sequence[str], known: Sequence[str]) -> list[str]:
    for key in wanted:
        if key not in known:
            msg = f"there is no {what} '{key}'; allowed: {', '.join(known) or 'none'}"
            raise TemplateError(msg)
    return list(wanted or known)
