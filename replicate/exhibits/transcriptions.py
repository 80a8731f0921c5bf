"""Where two transcriptions of one printed table differ: typing twice finds nearly every slip."""

from __future__ import annotations

from pathlib import Path

from replicate.exhibits.printed import Transcription, read_transcription


def differences(one: Path, other: Path) -> tuple[list[str], int]:
    """Compare two printed CSVs cell by cell, as texts: a trailing zero is a difference.

    Returns
    -------
    lines
        One for each difference: file, line, cell, and both texts.
    cells
        How many cells were compared.

    Raises
    ------
    PrintedFileError
        If one of the files cannot be read.
    """
    first, second = read_transcription(one), read_transcription(other)
    lines = [*_missing(one, first, other, second), *_missing(other, second, one, first)]
    rows = [row for row in first.lines if row in second.lines]
    columns = [column for column in first.columns if column in second.columns]
    common = [(row, column) for row in rows for column in columns]
    for row, column in common:
        texts = first.cells.get((row, column), ""), second.cells.get((row, column), "")
        if texts[0] != texts[1]:
            shown = [f"'{text}'" if text else "blank" for text in texts]
            places = f"{one}:{first.lines[row]} and {other}:{second.lines[row]}"
            lines.append(f"{places}: row '{row}', column '{column}': {shown[0]} and {shown[1]}")
    if not lines and (first.columns != second.columns or list(first.lines) != list(second.lines)):
        lines.append(f"{one} and {other}: rows or columns are in another order")
    return lines, len(common)


def _missing(one: Path, first: Transcription, other: Path, second: Transcription) -> list[str]:
    lines = [
        f"{one}:{line}: row '{row}' is not in {other}" for row, line in first.lines.items() if row not in second.lines
    ]
    return lines + [
        f"{one}:1: column '{column}' is not in {other}" for column in first.columns if column not in second.columns
    ]
