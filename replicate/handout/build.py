"""Write the handouts of papers: for each a plain edition and one with solutions, as PDF or as web page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal, get_args

from replicate.errors import ReplicateError, TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.results import Results
from replicate.handout.edition import FILE, edition
from replicate.verdicts.rows import VerdictRow

Format = Literal["pdf", "html"]


def build_handouts(
    papers: Sequence[Paper],
    results: Results,
    verdicts: Sequence[VerdictRow],
    folder: Path,
    *,
    solutions: Sequence[bool] = (False, True),
    file_format: Format = "pdf",
) -> list[Path]:
    """Write handouts.

    Parameters
    ----------
    papers
        Loaded papers, each with a ``handout.md``.
    results, verdicts
        Of all of them together.
    folder
        Where the files go; it is created if it does not exist.
    solutions
        The editions: without solutions, with them, or both.

    Returns
    -------
    list of Path
        ``<paper>.pdf`` and ``<paper>-solutions.pdf``, or the same with ``.html``. Nothing is written before
        all of them are complete.

    Raises
    ------
    TemplateError
        If a text asks for something that does not exist, or cannot be converted or set.
    """
    made: dict[str, bytes] = {}
    for paper in papers:
        for with_solutions in solutions:
            document = edition(paper, results, verdicts, solutions=with_solutions)
            name = f"{paper.id}{'-solutions' if with_solutions else ''}.{file_format}"
            if file_format == "pdf":
                from replicate.handout.printout import pdf

                made[name] = pdf(document)
            else:
                from replicate.handout.webpage import webpage

                made[name] = webpage(document).encode()
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in made.items():
        (folder / name).write_bytes(content)
    return [folder / name for name in made]


def with_handout(papers: Sequence[Paper], *, all_needed: bool = False) -> list[Paper]:
    """Return the papers that have a handout.

    Raises
    ------
    TemplateError
        If none has one, or `all_needed` and one has none.
    """
    found = [paper for paper in papers if (paper.folder() / FILE).is_file()]
    missing = [paper.id for paper in papers if paper not in found]
    if missing and (all_needed or not found):
        msg = f"{missing[0]}/{FILE}: the paper has no handout"
        raise TemplateError(msg)
    return found


def checked_format(text: str) -> Format:
    """Return a format if there is one of that name.

    Raises
    ------
    ReplicateError
        If there is not.
    """
    for known in get_args(Format):
        if text == known:
            return known  # type: ignore[no-any-return]
    msg = f"the format is '{text}', allowed: {', '.join(get_args(Format))}"
    raise ReplicateError(msg)
