"""One exhibit on the terminal: what the paper prints, what each reading gives, the verdicts, and why."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rich.console import Console, JustifyMethod
from rich.markdown import Markdown
from rich.padding import Padding
from rich.table import Table as Grid
from rich.text import Text

from replicate.display.csv_text import number_text
from replicate.display.numbers import shown, shown_word
from replicate.display.words import MATCHES, WORDS
from replicate.exhibits import Claims, Exhibit, Figure, NotComputable, Table
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.results import ClaimsResult, FigureResult, TableResult, errors_of
from replicate.run.outcome import Outcome
from replicate.terminal.colours import colour
from replicate.terminal.console import print_whole
from replicate.terminal.mathtext import readable
from replicate.verdicts.rows import Computed, VerdictRow

_DIGITS = 9


def print_exhibit(outcome: Outcome, paper: str, exhibit: Exhibit, readings: Sequence[str], console: Console) -> None:
    """Print an exhibit.

    Parameters
    ----------
    readings
        Ids of the readings to show, for a table.
    """
    console.print(Text.assemble((f"{paper}/{exhibit.id}", "bold"), f"  {readable(exhibit.title)}"))
    result = outcome.results.get((paper, exhibit.id))
    verdicts = [row for row in outcome.judgements[paper].verdicts if row.exhibit == exhibit.id]
    if isinstance(exhibit, NotComputable):
        console.print(Text(f"not computable: {exhibit.reason}"))
    elif isinstance(exhibit, Table) and isinstance(result, TableResult):
        if verdicts:
            print_whole(_comparison(readings, verdicts), console)
        else:
            _print_frames(result, readings, console)
        _print_readings(exhibit, readings, console)
        _print_explanations([verdict for verdict in verdicts if verdict.cause], console)
    elif isinstance(exhibit, Figure) and isinstance(result, FigureResult):
        _print_figure(exhibit, result, console)
    elif isinstance(exhibit, Claims) and isinstance(result, ClaimsResult):
        _print_claims(exhibit, verdicts, console)
    if result is not None:
        for part, why in errors_of(result).items():
            console.print(Text(f"failed{f' ({part})' if part else ''}: {why}", style="red"))


def _comparison(readings: Sequence[str], verdicts: list[VerdictRow]) -> Grid:
    """Return one line per printed value; computed values have a digit or two more than the print."""
    grid = _grid("row", "", ">printed", *(f">{reading}" for reading in readings), "verdict")
    previous = ""
    for verdict in verdicts:
        by_reading = {one.reading: one for one in verdict.values}
        grid.add_row(
            "" if verdict.row == previous else verdict.row,
            verdict.column,
            verdict.printed,
            *(_computed(by_reading.get(reading), verdict.value) for reading in readings),
            _verdict(verdict),
        )
        previous = verdict.row
    return grid


def _computed(one: Computed | None, printed: PrintedValue | None) -> str:
    if one is None or not one.text:
        return ""
    text = shown_word(one.word, printed) if one.word else shown(one.number, printed)
    return f"{text} {MATCHES[one.match.kind][0]:1}"


def _print_frames(result: TableResult, readings: Sequence[str], console: Console) -> None:
    """Print what each reading gives, for an exhibit without printed values."""
    for reading in readings:
        frame = result.frames.get(reading)
        if frame is None:
            continue
        console.print(Text(f"\n{reading}", style="bold"))
        grid = _grid("row", *(f">{column}" for column in frame.columns))
        for row, values in zip(frame.index, frame.itertuples(index=False, name=None), strict=True):
            grid.add_row(str(row), *(number_text(value, _DIGITS) for value in values))
        print_whole(grid, console)


def _print_readings(table: Table, readings: Sequence[str], console: Console) -> None:
    for id in readings:
        reading = table.readings[id]
        console.print()
        console.print(Text.assemble((id, "bold"), f": {readable(reading.title)}"))
        if reading.note:
            console.print(_indented(reading.note))


def _print_explanations(verdicts: list[VerdictRow], console: Console) -> None:
    """Print every explanation once, with the cells it is about."""
    together: dict[tuple[str, str, str], list[VerdictRow]] = {}
    for verdict in verdicts:
        together.setdefault((verdict.verdict, verdict.cause, verdict.explanation), []).append(verdict)
    for (word, cause, explanation), cells in together.items():
        console.print()
        for cell in cells:
            corrected = f", should be {cell.corrected}" if cell.corrected else ""
            why = "" if cause == word else f" ({cause})"
            said = f" {cell.row} {cell.column}: {word}{why}{corrected}"
            console.print(Text.assemble((WORDS[word].symbol, colour(word)), said))
        if explanation:
            console.print(_indented(explanation))


def _print_figure(figure: Figure, result: FigureResult, console: Console) -> None:
    if figure.caption:
        console.print(Text(readable(figure.caption)))
    if figure.stands_for:
        console.print(Text(f"stands for: {figure.stands_for}"))
    grid = _grid("panel", "curve", ">points", ">x from", ">to", ">y from", ">to")
    for (panel, curve), points in result.curves.groupby(["panel", "curve"], sort=False):
        x, y = points["x"].to_numpy(), points["y"].to_numpy()
        ends = (np.nanmin(x), np.nanmax(x), np.nanmin(y), np.nanmax(y))
        grid.add_row(str(panel), str(curve), str(int(np.isfinite(x).sum())), *(f"{end:.5g}" for end in ends))
    print_whole(grid, console)


def _print_claims(claims: Claims, verdicts: list[VerdictRow], console: Console) -> None:
    for verdict in verdicts:
        claim = claims.claims[verdict.row]
        console.print()
        console.print(Text.assemble((claim.id, "bold"), "  ", _verdict(verdict), f"  {_short(verdict.computed)}"))
        where = f" ({claim.where})" if claim.where else ""
        console.print(_indented(f"{claim.text}{where}"))
        console.print(_indented(verdict.explanation))


def _indented(text: str) -> Padding:
    """Return a Markdown text with its formulas as plain characters."""
    return Padding(Markdown(readable(text)), (0, 0, 0, 2))


def _verdict(verdict: VerdictRow) -> Text:
    return Text(f"{WORDS[verdict.verdict].symbol} {WORDS[verdict.verdict].name}", style=colour(verdict.verdict))


def _short(computed: str) -> str:
    """Return a computed number with nine significant digits."""
    return f"{float(computed):.{_DIGITS}g}" if computed else ""


def _grid(*headings: str) -> Grid:
    """Return an empty table; a heading that begins with ``>`` is that of a column of numbers."""
    grid = Grid(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for heading in headings:
        numeric = heading.startswith(">")
        justify: JustifyMethod = "right" if numeric else "left"
        grid.add_column(Text(heading.removeprefix(">")), justify=justify, no_wrap=True)
    return grid
