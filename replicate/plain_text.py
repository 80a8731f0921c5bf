"""Texts of papers, fit for a terminal and a page: UTF-8, and none of the characters that steer what shows them.

An escape sequence can repaint a terminal, a bidirectional control can show ``1.2`` where ``2.1`` stands, and two words
that differ by what has no width look the same. A text that is defined or read is refused with its place; whatever else
is shown has such characters written out. Which characters these are is decided by Unicode's categories.
"""

from __future__ import annotations

import codecs
import re
import sys
import tomllib
import unicodedata
from collections.abc import Iterator
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any
from unicodedata import category

from replicate.errors import ReplicateError

_CANDIDATE = re.compile(r"[^\t\n\r -~]|\r(?!\n)")
_STEERING = {"Cc", "Cf", "Cs", "Zl", "Zp"}  # controls, formats, surrogates, separators of lines and of paragraphs
# Formats with a shape: signs that stand before Arabic, Syriac and Kaithi numbers.
_SHOWN = {*"\u0600\u0601\u0602\u0603\u0604\u0605\u06dd\u070f\u0890\u0891\u08e2\U000110bd\U000110cd"}
_JOINERS = "\u200c\u200d"  # within words of scripts without capitals, and between the parts of a pictograph
_JOINED = {"Lo", "Mc", "Mn", "Sk", "So"}
_ARCHIVE = b"PK\x03\x04"
LARGEST = 16 * 2**20  # bytes of a text


def steering(text: str) -> str:
    r"""Return the name of the first character that steers what shows a text, empty if there is none.

    Examples
    --------
    >>> steering("a\x1b[2Jb"), steering("plain\n")
    ('U+001B', '')
    >>> steering("1\u202e2")
    'U+202E RIGHT-TO-LEFT OVERRIDE'
    """
    found = next(_found(text), None)
    return _named(found[0]) if found else ""


def visible(text: str) -> str:
    r"""Return a text in which characters that steer are written out.

    Examples
    --------
    >>> visible("a\x1b[2Jb")
    'a\\x1b[2Jb'
    """
    pieces, end = [], 0
    for found in _found(text):
        written = found[0].encode("unicode_escape", "backslashreplace").decode("ascii")
        pieces += [text[end : found.start()], written]
        end = found.end()
    return "".join([*pieces, text[end:]])


def _found(text: str) -> Iterator[re.Match[str]]:
    """Yield the characters of a text that steer."""
    return (match for match in _CANDIDATE.finditer(text) if category(match[0]) in _STEERING and not _belongs(match))


def _belongs(match: re.Match[str]) -> bool:
    """Say whether a format character is part of how its script is written."""
    if match[0] not in _JOINERS:
        return match[0] in _SHOWN
    before, after = match.string[max(0, match.start() - 1) : match.start()], match.string[match.end() : match.end() + 1]
    return bool(before and after) and {category(before), category(after)} <= _JOINED


def read_text(
    path: Path | Traversable, name: str, error: type[ReplicateError], *, pipes: bool = False, wide: bool = False
) -> str:
    """Read a text file of a paper.

    Parameters
    ----------
    name
        What messages call the file.
    error
        Raised if it cannot be read, is too large, is not UTF-8 or holds a character that steers; the message has the
        line.
    pipes
        Whether it may be a pipe, which a reader waits for, as in ``--roster <(command)``.
    wide
        Whether UTF-16 and UTF-32 are read, too, with or without a byte order mark, as some programs export tables.
    """
    try:
        if isinstance(path, Path) and (path.is_char_device() or path.is_block_device() or path.is_socket()):
            msg = f"{name}: cannot be read: it is a device"
            raise error(msg)
        if isinstance(path, Path) and path.is_fifo() and not pipes:
            msg = f"{name}: cannot be read: it is a pipe"
            raise error(msg)
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
    except OSError as why:
        msg = f"{name}: cannot be read: {why.strerror or why}"
        raise error(msg) from why
    if len(content) > LARGEST:
        msg = f"{name}: is larger than {LARGEST // 2**20} MiB; allowed: texts that a person wrote"
        raise error(msg)
    if content.startswith(_ARCHIVE):
        msg = f"{name}: is a spreadsheet or an archive; expected: text (save a table as CSV in UTF-8)"
        raise error(msg)
    try:
        text = content.decode(_encoding(content) if wide else "utf-8")
    except UnicodeDecodeError as why:
        line = content[: why.start].count(b"\n") + 1
        msg = f"{name}:{line}: is not UTF-8 text"
        raise error(msg) from why
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    found = next(_found(text), None)
    if found:
        line = text.count("\n", 0, found.start()) + 1
        msg = (
            f"{name}:{line}: holds the character {_named(found[0])}, which pages and terminals must not get; remove it"
        )
        raise error(msg)
    return text


def _encoding(content: bytes) -> str:
    """Return the encoding of a table: UTF-8, unless a byte order mark or its line ends are those of a wider one."""
    if content.startswith((codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE)):  # the first begins with the mark of UTF-16
        return "utf-32"
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    for wide in ("utf-32-le", "utf-32-be", "utf-16-le", "utf-16-be") if b"\0" in content else ():
        if re.search(r"[\r\n]", content.decode(wide, errors="replace")):
            return wide
    return "utf-8"


def parse_toml(text: str, name: str, error: type[ReplicateError]) -> dict[str, Any]:
    """Return the tables of a TOML text; if it is none, `error` is raised, with the line."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as why:
        place = re.search(r" \(at (?:line (\d+)|end of document).*", str(why))
        line = (place and place[1]) or text.count("\n") + 1
        msg = f"{name}:{line}: is not readable TOML: {str(why)[: place.start()] if place else why}"
        raise error(msg) from why
    except ValueError as why:  # from Python's own `int`
        digits = re.search(rf"[0-9_]{{{sys.get_int_max_str_digits()},}}", text)
        line = text.count("\n", 0, digits.start() if digits else 0) + 1
        msg = f"{name}:{line}: is not readable TOML: an integer of too many digits"
        raise error(msg) from why
    except RecursionError as why:
        msg = f"{name}: is not readable TOML: too many brackets inside each other"
        raise error(msg) from why


def toml_line(text: str, *keys: str) -> int:
    r"""Return the line of a readable TOML text in which a value begins, however its keys are written; 1 without it.

    Examples
    --------
    >>> toml_line('[a]\nb = [\n  1,\n]\n"c".d = 2', "a", "c", "d")
    5
    """
    lines = text.splitlines()
    begins = 1
    for number, line in enumerate(lines, start=1):
        if begins == number and (not line.strip() or line.lstrip().startswith("#")):
            begins += 1
            continue
        try:
            found: Any = tomllib.loads("\n".join(lines[:number]))
        except tomllib.TOMLDecodeError:
            continue  # in the middle of a value
        for key in keys:
            found = found.get(key) if isinstance(found, dict) else None
        if found is not None:
            return begins
        begins = number + 1
    return 1


def _named(character: str) -> str:
    name = unicodedata.name(character, "")
    return f"U+{ord(character):04X}{f' {name}' if name else ''}"
