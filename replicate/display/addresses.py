"""Where in the report something stands: the page of an exhibit, and the address of one cell or claim."""

from __future__ import annotations

import re
from urllib.parse import quote

from replicate.display.labels import cited, heading, key_text, part_of
from replicate.display.unmarked import unmarked
from replicate.exhibits import Paper, Table

#: The page on which loops can be tried out, in the report's folder and in that of the handouts.
TRIALS = "whatif.html"

_LONGEST_LABEL = 24  # of a row beside its point in the gain plane

_NOTES = re.compile(r"notes-(\w+)\.md")


def parts(paper: Paper) -> dict[str, str]:
    """Return the parts of a paper that have a page of their own, each with the file of its notes.

    A file ``notes-<part>.md`` makes a page for that part, on which all exhibits with the part's prefix stand. They
    come in the order of the exhibits.
    """
    files = sorted(entry.name for entry in paper.folder().iterdir())
    found = {match[1]: name for name in files if (match := _NOTES.fullmatch(name))}
    order = [part for id in paper.exhibits if (part := part_of(id)) in found]
    return {part: found[part] for part in dict.fromkeys([*order, *found])}


def page_name(paper: str, part: str = "") -> str:
    """Return the file name of the page of a paper, or of one of its parts."""
    return f"{paper}-{part}.html" if part else f"{paper}.html"


def parts_of(paper: Paper) -> dict[str, str]:
    """Return, by exhibit, the part on whose page it stands; empty on the paper's main page."""
    known = parts(paper)
    return {id: part if (part := part_of(id)) in known else "" for id in paper.exhibits}


def pages_of(paper: Paper) -> dict[str, str]:
    """Return, by exhibit, the file name of the page on which it stands."""
    return {id: page_name(paper.id, part) for id, part in parts_of(paper).items()}


def anchor(exhibit: str, row: str, column: str) -> str:
    """Return the id of a cell or claim on its page; characters that an address cannot hold become ``_``.

    Examples
    --------
    >>> anchor("table-2", "Ms = 1.4", "K/Ti")
    'table-2.Ms___1_4.K_Ti'
    """
    return ".".join(re.sub(r"[^A-Za-z0-9_-]", "_", part) for part in (exhibit, row, column))


def address(page: str, exhibit: str, row: str, column: str) -> str:
    """Return the address of a cell or claim, relative to the report's folder.

    Examples
    --------
    >>> address("bayhan.html", "table-2", "PA", "Mp")
    'bayhan.html#table-2.PA.Mp'
    """
    return f"{page}#{anchor(exhibit, row, column)}"


def trial_table(paper: Paper, exhibit: str) -> str:
    """Return what an exhibit is called where its loops can be tried out, in the paper's own numbering.

    Examples
    --------
    >>> paper = Paper("id", "package", "Title", ("Ann Lee",), "Citation.", 1999, (), ())
    >>> table = paper.table("II-table-2", "Table II: gains", rows=("slow_one",), columns=("k",), printed=False)
    >>> trial_table(paper, "II-table-2")
    'Lee 1999, Part II, Table II'
    """
    number, title = heading(exhibit, paper.exhibits[exhibit].title)
    part = part_of(exhibit)
    name = number or unmarked(title.partition(": ")[0])
    return ", ".join(filter(None, (cited(paper), part and f"Part {part}", name)))


def trial_label(paper: Paper, exhibit: str, row: str, case: str = "") -> str:
    """Return what a row, or a case of it, is called where its loop can be tried out: table, then labels of the row.

    The names of a row and its case stand in the gain plane, too: where a label is long, the key stands for it.

    Examples
    --------
    >>> paper = Paper("id", "package", "Title", ("Ann Lee",), "Citation.", 1999, (), ())
    >>> labels = {"b": "$K_P$ of *b*", "c": "set point, with the filter of the appendix"}
    >>> table = paper.table("table-2", "Gains", rows=("a_1", "b", "c"), columns=("k",), labels=labels, printed=False)
    >>> trial_label(paper, "table-2", "b", "h = 0.1")
    'Lee 1999, Table 2: K_P of b, h = 0.1'
    >>> trial_label(paper, "table-2", "a_1"), trial_label(paper, "table-2", "c")
    ('Lee 1999, Table 2: a 1', 'Lee 1999, Table 2: c')
    """
    table = paper.exhibits[exhibit]
    labels = table.labels if isinstance(table, Table) else {}
    names = (
        label if len(label := unmarked(labels.get(key, ""))) <= _LONGEST_LABEL and label else key_text(key)
        for key in (row, case)
        if key
    )
    return f"{trial_table(paper, exhibit)}: {', '.join(names)}"


def trial_address(plant: str, controller: str) -> str:
    """Return where a loop can be tried out, relative to the folder of the report or of the handouts.

    Examples
    --------
    >>> trial_address("e^{-s}/(s+1)", "k=0.6,ki=0.5")
    'whatif.html#plant=e%5E%7B-s%7D%2F%28s%2B1%29&controller=k%3D0.6%2Cki%3D0.5'
    """
    return f"{TRIALS}#plant={quote(plant, safe='')}&controller={quote(controller, safe='')}"
