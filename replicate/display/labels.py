"""What an exhibit is called: "table-2" is Table 2, "II-fig-4" is Figure 4 of part II."""

from __future__ import annotations

import re
from collections.abc import Sequence

from replicate.exhibits import Paper

_KINDS = {"table": "Table", "fig": "Figure", "example": "Example", "box": "Box", "algorithm": "Algorithm"}


def part_of(exhibit: str) -> str:
    """Return the part prefix of an exhibit id, empty if it has none.

    Examples
    --------
    >>> part_of("IIs-table-2"), part_of("table-2")
    ('IIs', '')
    """
    match = re.match(r"([IVX]+[a-z]?)-", exhibit)
    return match[1] if match else ""


def label(exhibit: str) -> str:
    """Return the exhibit's number as the paper would write it; empty if the id has none.

    Examples
    --------
    >>> label("table-2"), label("I-fig-4b"), label("example-2-1"), label("eq-7a"), label("eq-21-24")
    ('Table 2', 'Figure 4b', 'Example 2.1', 'Equation (7a)', 'Equations (21) to (24)')
    >>> label("claims"), label("toolchain"), label("fig-9-values")
    ('Claims', '', 'Figure 9, values')
    """
    kind, *numbers = exhibit.removeprefix(f"{part_of(exhibit)}-").split("-")
    if kind == "claims" and not numbers:
        return "Claims"
    if not numbers or not re.match(r"\d|[A-Z]\d*$", numbers[0]):
        return ""
    if kind == "eq":
        ends = [f"({number})" for number in numbers]
        return f"Equations {ends[0]} to {ends[1]}" if len(ends) == 2 else f"Equation {'–'.join(ends)}"
    words = [number for number in numbers if re.match(r"[a-z]{2}", number)]  # what belongs to a numbered exhibit
    plain = ".".join(number for number in numbers if number not in words)
    return f"{_KINDS.get(kind, kind.capitalize())} {', '.join([plain, *words])}"


def cell_keys(row: str, column: str, columns: Sequence[str]) -> tuple[str, ...]:
    """Return the keys that name a cell of a table: the row alone where all that is beside it is its "value".

    Examples
    --------
    >>> cell_keys("Ms", "value", ["value"]), cell_keys("Ms", "k", ["k"]), cell_keys("Ms", "value", ["value", "unit"])
    (('Ms',), ('Ms', 'k'), ('Ms', 'value'))
    """
    return (row,) if list(columns) == ["value"] else (row, column)


def key_text(key: str) -> str:
    """Return a key of a row or column that has no label as a reader sees it.

    Examples
    --------
    >>> key_text("gain_margin"), key_text("0.5 <= ph <= 10")
    ('gain margin', '0.5 ≤ ph ≤ 10')
    """
    return key.replace("_", " ").replace("<=", "≤").replace(">=", "≥")


_ROMAN = {"M": 1000, "CM": 900, "D": 500, "CD": 400, "C": 100, "XC": 90, "L": 50, "XL": 40, "X": 10, "IX": 9, "V": 5,
          "IV": 4, "I": 1}  # fmt: skip


def _roman(number: int) -> str:
    text = ""
    for letters, worth in _ROMAN.items():
        text += number // worth * letters
        number %= worth
    return text


def _spellings(name: str) -> list[str]:
    """Return how a title may begin with the exhibit's number: as we write it, or as papers do."""
    kind, _, number = name.rpartition(" ")
    roman = [f"{kind} {_roman(int(number))}"] if number.isdigit() else []
    return [name, name.replace("Figure", "Fig."), *roman]


def heading(exhibit: str, title: str) -> tuple[str, str]:
    """Return label and title of an exhibit, without saying the label twice; a number is written as the title has it.

    Examples
    --------
    >>> heading("table-2", "Table 2: step response"), heading("table-2", "Step response")
    (('Table 2', 'Step response'), ('Table 2', 'Step response'))
    >>> heading("table-2", "Table II: step response"), heading("claims", "Claims made in the text")
    (('Table II', 'Step response'), ('', 'Claims made in the text'))
    """
    name = label(exhibit)
    if not name:
        return "", title
    for spelling in _spellings(name):
        if title.lower().startswith(spelling.lower()):
            rest = title[len(spelling) :]
            if not rest.startswith((".", ":", ",", " –", " —")):
                return "", title
            rest = rest.lstrip(" .:,–—")
            return name if "." in spelling else spelling, rest[:1].upper() + rest[1:]
    return name, title


def cited(paper: Paper) -> str:
    """Return a paper as one would cite it: surnames and year.

    Examples
    --------
    >>> names = ("Ann Lee", "Bo Kim", "Cy Wu")
    >>> for count in (1, 2, 3):
    ...     print(cited(Paper("id", "package", "Title", names[:count], "Citation.", 1999, (), ())))
    Lee 1999
    Lee and Kim 1999
    Lee et al. 1999
    """
    surnames = [author.split(" ")[-1] for author in paper.authors]
    names = f"{surnames[0]} et al." if len(surnames) > 2 else " and ".join(surnames)
    return f"{names} {paper.year}"
