"""A roster: a CSV file with one student or group per line, and the column that names them."""

from __future__ import annotations

import csv
import hashlib
import io
import re
import unicodedata
from pathlib import Path
from unicodedata import category

from replicate.errors import ReplicateError
from replicate.plain_text import read_text

_QUOTED = re.compile(r'"[^"]*"')
_UNSAFE = re.compile(r'[<>:"/\\|?*]')  # in a file's name, on some system
_LONGEST = 150  # bytes of a name, so that its file's name fits any system
_SHOWN = 60  # letters of a name in a message
_RESERVED = {"key", "solutions", "slides"}  # files of other kinds have these names
_INVISIBLE = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}
_NO_STUDENT = "Points Possible"  # in a line of a gradebook of Canvas, in any language
_NOBODY = "Student, Test"  # whom Canvas puts into such a gradebook when a teacher looks at the course as a student
_JOINERS = "\u200c\u200d"  # within words of some scripts, and between the parts of a pictograph


def read_roster(path: Path, column: str = "") -> list[str]:
    """Return the ids of a roster.

    Parameters
    ----------
    path
        A CSV file whose first line names the columns, separated by commas, semicolons or tabs.
    column
        The one with the ids; the first if empty.

    Raises
    ------
    ReplicateError
        If there is no such file or column, nobody in it, an id missing, or two ids would name one file.
    """
    columns, lines = _table(path)
    if column and column not in columns:
        msg = f"{path.name}: no column '{column}'; allowed: {', '.join(columns)}"
        raise ReplicateError(msg)
    if column and columns.count(column) > 1:
        msg = f"{path.name}: several columns are named '{column}'; rename them"
        raise ReplicateError(msg)
    at = columns.index(column) if column else 0
    students: list[str] = []
    seen: dict[str, tuple[int, str]] = {}
    for number, row in lines:
        student = unicodedata.normalize("NFC", row[at].strip()) if at < len(row) else ""
        if not student:
            msg = f"{path.name}:{number}: no entry in the column '{columns[at]}', which names the sheets"
            raise ReplicateError(msg)
        if "\n" in student:
            begin = student.partition("\n")[0]
            msg = f"{path.name}:{number}: '{begin}...' goes on in another line; is a quotation mark missing?"
            raise ReplicateError(msg)
        name = unicodedata.normalize("NFC", file_stem(student).casefold())
        if name in seen:
            line, other = seen[name]
            msg = (
                f"{path.name}:{number}: '{_short(student)}' names the same sheet as '{_short(other)}' in line {line}; "
                "choose a column in which all differ with --roster-id"
            )
            raise ReplicateError(msg)
        seen[name] = (number, student)
        students.append(student)
    return students


def _table(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Return the names of the columns and the other lines that hold something, with their numbers."""
    text = _text(path)
    head = text.splitlines()[0] if text.strip() else ""
    skipped = 1 if re.fullmatch(r'"?sep=[,;\t]"?', head.strip()) else 0  # what a spreadsheet may write first
    text = "\n" * skipped + text.partition("\n")[2] if skipped else text
    head = _QUOTED.sub("", next((line for line in text.splitlines() if line.strip()), ""))
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=max(",;\t", key=head.count), strict=True)
    try:
        found = [(rows.line_num, row) for row in rows if any(cell.strip() for cell in row)]
    except csv.Error as error:
        msg = f"{path.name}:{rows.line_num}: cannot be read as CSV: {error}"
        raise ReplicateError(msg) from error
    lines = [(number, row) for number, row in found[1:] if row[0].strip() != _NO_STUDENT]
    if len(lines) < len(found) - 1:  # a gradebook
        if lines and not lines[0][1][0].strip():
            del lines[0]  # how grades are posted: such a gradebook may say it above
        lines = [(number, row) for number, row in lines if row[0].strip() != _NOBODY]
    if not lines:
        msg = f"{path.name}: the roster is empty: it needs a line with the names of the columns and one per student"
        raise ReplicateError(msg)
    number, names = found[0]
    columns = [name.strip() for name in names]
    if len(columns) > 1 and not any(columns[1:]):
        msg = f"{path.name}:{number}: '{_short(columns[0])}' is a title, not the names of the columns; remove the line"
        raise ReplicateError(msg)
    unnamed = [place for place, name in enumerate(columns) if place and not name and any(columns[place:])]
    if unnamed:  # the first column may be an index, and those at the end may be empty
        why = "name it, or remove the line if it holds heads of several columns each"
        msg = f"{path.name}:{number}: column {unnamed[0] + 1} has no name; {why}"
        raise ReplicateError(msg)
    for number, row in lines:
        if any(cell.strip() for cell in row[len(columns) :]):
            cells = f"has {len(row)} cells, more than the {len(columns)} columns that the first line names"
            msg = f"{path.name}:{number}: {cells}; is a quotation mark missing, or is there a title above the names?"
            raise ReplicateError(msg)
    return columns, lines


def _text(path: Path) -> str:
    try:
        return read_text(path, path.name, ReplicateError, pipes=True, wide=True)
    except ReplicateError as error:
        if isinstance(error.__cause__, UnicodeDecodeError):
            msg = f"{error}; in a spreadsheet, save the roster as 'CSV UTF-8'"
            raise ReplicateError(msg) from error
        raise


def _short(student: str) -> str:
    return student if len(student) <= _SHOWN else f"{student[:_SHOWN]}..."


def file_stem(student: str) -> str:
    """Return an id as part of a file's name; of one that is too long, its beginning and a hash.

    Examples
    --------
    >>> file_stem("Ångström/2"), file_stem("key"), file_stem(" .. ")
    ('Ångström_2', 'key_', '_')
    """
    shown = (sign if sign in _JOINERS or category(sign) not in _INVISIBLE else "_" for sign in student)
    stem = _UNSAFE.sub("_", "".join(shown)).rstrip(". ") or "_"
    if len(stem.encode()) > _LONGEST:
        digits = hashlib.sha256(student.encode()).hexdigest()[:8]
        stem = stem.encode()[: _LONGEST - len(digits) - 1].decode(errors="ignore") + f"-{digits}"
    return f"{stem}_" if stem.casefold() in _RESERVED else stem
