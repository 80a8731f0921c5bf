"""A paper's prose, cut into pieces: headings with ids for the contents, text, and places for exhibits."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

_FENCE = re.compile(r"^\s{0,3}(```+|~~~+)")
_HEADING = re.compile(r"^(#{1,5})\s+(.+?)(?:\s+#+)?\s*$")
TOP_LEVEL = 2  # the page's title is the only heading of level 1

# What prose leaves where an exhibit is to stand; a private-use character cannot occur in a text by chance.
_PLACE = re.compile("\ue002([^\ue003]+)\ue003")


def place(exhibit: str) -> str:
    """Return the mark that `pieces` turns into a place for the exhibit."""
    return f"\n\n\ue002{exhibit}\ue003\n\n"


@dataclass(frozen=True)
class Piece:
    """A part of the prose.

    Attributes
    ----------
    kind
        ``heading``, ``text`` or ``exhibit``.
    text
        Markdown of a heading (without ``#``) or text; the id of an exhibit.
    level, id
        Of a heading: its level on the page (2 and more) and its id.
    """

    kind: Literal["heading", "text", "exhibit"]
    text: str
    level: int = 0
    id: str = ""


def pieces(text: str) -> list[Piece]:
    r"""Cut Markdown into headings, texts and exhibits, in order; the highest heading becomes one of level 2.

    Examples
    --------
    >>> for piece in pieces("Intro." + place("table-1") + "# The *rule*\nIt is.\n"):
    ...     print(piece.kind, "|", piece.text, "|", piece.level, piece.id)
    text | Intro. | 0
    exhibit | table-1 | 0
    heading | The *rule* | 2 s-the-rule
    text | It is. | 0
    """
    found: list[Piece] = []
    lines: list[str] = []
    fence = ""

    def flush() -> None:
        joined = "\n".join(lines).strip()
        if joined:
            found.append(Piece("text", joined))
        lines.clear()

    for line in text.splitlines():
        mark = _FENCE.match(line)
        if mark and (not fence or mark[1].startswith(fence)):
            fence = "" if fence else mark[1][:3]
        heading = None if fence else _HEADING.match(line)
        exhibit = None if fence else _PLACE.search(line)
        if heading:
            flush()
            found.append(Piece("heading", heading[2], len(heading[1])))
        elif exhibit:
            lines.append(line[: exhibit.start()])
            flush()
            found.append(Piece("exhibit", exhibit[1]))
            lines.append(line[exhibit.end() :])
        else:
            lines.append(line)
    flush()
    return _with_ids(found)


def _with_ids(found: list[Piece]) -> list[Piece]:
    top = min((piece.level for piece in found if piece.kind == "heading"), default=TOP_LEVEL)
    used: dict[str, int] = {}
    result = []
    for piece in found:
        if piece.kind == "heading":
            # "s-" keeps a section's id apart from those of exhibits.
            slug = "s-" + (re.sub(r"[^a-z0-9]+", "-", piece.text.lower()).strip("-") or "section")
            used[slug] = used.get(slug, 0) + 1
            id = slug if used[slug] == 1 else f"{slug}-{used[slug]}"
            result.append(Piece("heading", piece.text, piece.level - top + TOP_LEVEL, id))
        else:
            result.append(piece)
    return result
