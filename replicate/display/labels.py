"""What an exhibit is called: "table-2" is Table 2, "II-fig-4" is Figure 4 of part II."""

from __future__ import annotations

import re

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


def heading(exhibit: str, title: str) -> tuple[str, str]:
    """Return label and title of an exhibit, without saying the label twice.

    Examples
    --------
    >>> heading("table-2", "Table 2: step response"), heading("table-2", "Step response")
    (('Table 2', 'Step response'), ('Table 2', 'Step response'))
    >>> heading("claims", "Claims made in the text")
    ('', 'Claims made in the text')
    """
    name = label(exhibit)
    if not name:
        return "", title
    for spelling in (name, name.replace("Figure", "Fig.")):
        if title.lower().startswith(spelling.lower()):
            rest = title[len(spelling) :]
            if not rest.startswith((".", ":", ",", " –", " —")):
                return "", title
            rest = rest.lstrip(" .:,–—")
            return name, rest[:1].upper() + rest[1:]
    return name, title
