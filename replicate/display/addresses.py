"""Where in the report something stands: the page of an exhibit, and the address of one cell or claim."""

from __future__ import annotations

import re
from urllib.parse import quote

from replicate.display.labels import part_of
from replicate.exhibits import Paper

#: The page on which loops can be tried out, in the report's folder and in that of the handouts.
TRIALS = "whatif.html"

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


def trial_label(exhibit: str, row: str, case: str = "") -> str:
    """Return what a row, or a case of it, is called where its loop can be tried out, after its paper.

    Examples
    --------
    >>> trial_label("I-table-1", "G1 Ms=1.4")
    'I-table-1: G1 Ms=1.4'
    >>> trial_label("table-2", "ISE", "ph = 0.1")
    'table-2: ISE, ph = 0.1'
    """
    return f"{exhibit}: {row.replace('_', ' ')}" + (f", {case}" if case else "")


def trial_address(plant: str, controller: str) -> str:
    """Return where a loop can be tried out, relative to the folder of the report or of the handouts.

    Examples
    --------
    >>> trial_address("e^{-s}/(s+1)", "k=0.6,ki=0.5")
    'whatif.html#plant=e%5E%7B-s%7D%2F%28s%2B1%29&controller=k%3D0.6%2Cki%3D0.5'
    """
    return f"{TRIALS}#plant={quote(plant, safe='')}&controller={quote(controller, safe='')}"
