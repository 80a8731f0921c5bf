"""Row heads of tables in a PDF: Typst marks the cells above the columns as heads, but not those before the rows.

A screen reader that says "Haalman, settling time, printed: 76.3" needs both. Typst's own way to mark such a cell,
``pdf.header-cell``, is behind a switch that the typst package does not offer. So the structure elements of the cells
are replaced by an incremental update (ISO 32000-1, 7.5.6): every first cell of a row becomes a ``TH`` of scope ``Row``,
and the explicit lists of column heads go, since they would hide it; scopes say the same (14.8.5.7).
"""

from __future__ import annotations

import re

# One object per cell, written in one way: number, role, rest; then the ids of the heads above it, which are named by
# table, column x and row y: (U1x0y0)(U1x0y1).
_CELL = re.compile(
    rb"(?P<number>\d+) 0 obj\n<</Type/StructElem/S/TD/P (?P<parent>\d+) 0 R/A\[<</O/Table/Headers\[(?P<heads>[^]]*)\]>>"
    rb"(?P<rest>.*?)\nendobj\n",
    re.DOTALL,
)
_FIRST = re.compile(rb"\(U\d+x0y\d+\)")
_END = re.compile(rb"trailer\n<<(?P<trailer>.*?)>>\nstartxref\n(?P<start>\d+)\n%%EOF\s*$", re.DOTALL)


def with_row_heads(content: bytes, rows: int) -> bytes:
    """Return a PDF in which the first cell of each row of its tables is the head of the row.

    Parameters
    ----------
    content
        What Typst wrote.
    rows
        How many rows below their heads the tables have together.

    Raises
    ------
    ValueError
        If there are not so many: Typst writes its files in another way than this function knows.
    """
    end = _END.search(content)
    cells = list(_CELL.finditer(content))
    found = sum(bool(_FIRST.match(cell["heads"])) for cell in cells)
    if end is None or found != rows:
        msg = f"{found} row heads in the tables of the PDF, expected: {rows}"
        raise ValueError(msg)
    if not rows:
        return content
    out, places = bytearray(content), dict[int, int]()
    if not content.endswith(b"\n"):
        out += b"\n"
    for cell in cells:
        first = bool(_FIRST.match(cell["heads"]))
        role, scope = (b"TH", b"<</O/Table/Scope/Row>>") if first else (b"TD", b"")
        attributes = (b"/A[" + scope + cell["rest"]).replace(b"/A[]", b"", 1)
        places[int(cell["number"])] = len(out)
        out += b"%b 0 obj\n<</Type/StructElem/S/%b/P %b 0 R" % (cell["number"], role, cell["parent"])
        out += attributes + b"\nendobj\n"
    start = len(out)
    out += b"xref\n"
    for number, place in sorted(places.items()):
        out += b"%d 1\n%010d 00000 n \n" % (number, place)
    out += b"trailer\n<<%b/Prev %b>>\nstartxref\n%d\n%%%%EOF\n" % (end["trailer"], end["start"], start)
    return bytes(out)
