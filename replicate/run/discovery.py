"""Find the papers: sub-packages of `replicate.papers`, and installed packages that announce themselves.

A package outside this project adds a paper with an entry point in the group ``replicate.papers`` that names
its `Paper`, for example ``mypaper = "mypaper:paper"``.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import pkgutil
import traceback
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from replicate.errors import PaperDefinitionError, UnknownPaperError
from replicate.exhibits import Exhibit, Paper
from replicate.exhibits.file_names import display_name

ENTRY_POINTS = "replicate.papers"


def known_papers() -> dict[str, Paper]:
    """Return every paper by id, in alphabetical order; their exhibits are not loaded yet.

    Raises
    ------
    PaperDefinitionError
        If a package defines no paper, or two packages define the same one.
    """
    papers: dict[str, Paper] = {}
    for where, paper in (*_own_papers(), *_installed_papers()):
        if not isinstance(paper, Paper):
            msg = f"{where}: defines no 'paper' that is a replicate.exhibits.Paper"
            raise PaperDefinitionError(msg)
        if paper.id in papers:
            msg = f"{where}: there is a paper '{paper.id}' already, in {papers[paper.id].package}"
            raise PaperDefinitionError(msg)
        papers[paper.id] = paper
    return dict(sorted(papers.items()))


def find_paper(id: str) -> Paper:
    """Return one paper with its exhibits.

    Raises
    ------
    UnknownPaperError
        If there is none of this name; the message lists the known ones.
    PaperDefinitionError
        If one of its modules cannot be imported.
    """
    papers = known_papers()
    if id not in papers:
        msg = f"there is no paper '{id}'; known: {', '.join(papers) or 'none'}"
        raise UnknownPaperError(msg)
    with _importing(id):
        return papers[id].load()


def find_papers(ids: Iterable[str] = ()) -> list[Paper]:
    """Return the papers named, or all of them if none is named, with their exhibits.

    Raises
    ------
    UnknownPaperError
        If one of the names is unknown.
    """
    wanted = dict.fromkeys(ids)
    return [find_paper(id) for id in wanted or known_papers()]


def find_exhibit(paper: Paper, id: str) -> Exhibit:
    """Return one exhibit of a loaded paper.

    Raises
    ------
    UnknownPaperError
        If the paper has none of this name; the message lists those it has.
    """
    if id not in paper.exhibits:
        msg = f"{paper.id} has no exhibit '{id}'; known: {', '.join(paper.exhibits) or 'none'}"
        raise UnknownPaperError(msg)
    return paper.exhibits[id]


def select(names: Iterable[str]) -> tuple[list[Paper], list[tuple[str, str]] | None]:
    """Turn names as on the command line, ``PAPER`` or ``PAPER/EXHIBIT``, into papers and exhibits.

    Returns
    -------
    papers
        Loaded, each once; all papers if nothing is named.
    exhibits
        ``(paper, exhibit)`` pairs, or ``None`` if only whole papers are named.

    Raises
    ------
    UnknownPaperError
        If a paper or exhibit does not exist.
    """
    pairs = [(paper, exhibit) for paper, _, exhibit in (name.partition("/") for name in names)]
    papers = find_papers(paper for paper, _ in pairs)
    if not any(exhibit for _, exhibit in pairs):
        return papers, None
    wanted = []
    for paper in papers:
        named = [exhibit for owner, exhibit in pairs if owner == paper.id]
        whole = "" in named
        wanted += [(paper.id, find_exhibit(paper, id).id) for id in (paper.exhibits if whole else named)]
    return papers, wanted


def _own_papers() -> list[tuple[str, object]]:
    import replicate.papers as home

    names = [module.name for module in pkgutil.iter_modules(home.__path__, f"{home.__name__}.") if module.ispkg]
    found: list[tuple[str, object]] = []
    for name in sorted(names):
        with _importing(name):
            found.append((name, getattr(importlib.import_module(name), "paper", None)))
    return found


def _installed_papers() -> list[tuple[str, object]]:
    found: list[tuple[str, object]] = []
    for point in sorted(importlib.metadata.entry_points(group=ENTRY_POINTS)):
        where = f"entry point '{point.name}'"
        with _importing(f"{where}: {point.value}"):
            found.append((where, point.load()))
    return found


@contextmanager
def _importing(what: str) -> Iterator[None]:
    """Tell of an exception in a paper's own code in one line, with the file and line that raised it."""
    try:
        yield
    except PaperDefinitionError:
        raise
    except Exception as error:
        if isinstance(error, SyntaxError) and error.filename:
            file, line, reason = error.filename, error.lineno, error.msg
        else:
            frames = traceback.extract_tb(error.__traceback__)
            frame = next(frame for frame in reversed(frames) if not frame.filename.startswith("<frozen"))
            file, line, reason = frame.filename, frame.lineno, f"{type(error).__name__}: {error}"
        msg = f"{what} cannot be loaded: {display_name(Path(file))}:{line}: {reason}"
        raise PaperDefinitionError(msg) from error
