"""The handouts of papers: for each a plain edition and one with solutions, or a file of questions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from replicate.errors import TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.results import Results
from replicate.handout.edition import TEXT, edition
from replicate.handout.formats import BANKS, EDITIONS, SLIDES, named
from replicate.handout.own_exercises import with_own
from replicate.handout.placing import exercises_of
from replicate.handout.questions import questions_of
from replicate.handout.sheet import Sheet
from replicate.verdicts.rows import VerdictRow


def handouts(
    papers: Sequence[Paper],
    results: Results,
    verdicts: Sequence[VerdictRow],
    *,
    solutions: Sequence[bool] = (False, True),
    file_format: str = "pdf",
    sheet: Sheet | None = None,
) -> Iterator[tuple[str, bytes]]:
    """Yield the name and content of the files of handouts: ``<paper>.pdf`` and so on, as the format has them.

    Parameters
    ----------
    papers
        Loaded papers, each with a ``handout.md``.
    results, verdicts
        Of all of them together.
    solutions
        The editions: without solutions, with them, or both.
    file_format
        As `replicate.handout.formats` names them.
    sheet
        What a lecturer sets for all of them.

    Raises
    ------
    TemplateError
        If a text asks for something that does not exist, or cannot be converted or set.
    """
    sheet = sheet or Sheet()
    for paper in papers:
        if file_format == SLIDES:
            from replicate.handout.slides import slides

            document = edition(paper, results, verdicts, solutions=False, sheet=sheet, kind=SLIDES)
            yield f"{paper.id}-slides.pdf", slides(document)
            continue
        exercises = with_own(exercises_of(paper), sheet.own)
        for variation in exercises.variations.values():
            for name, text in variation.files(variation.original).items():
                yield f"{paper.id}-{name}", text.encode()
        if file_format in BANKS:
            document = edition(paper, results, verdicts, solutions=True, sheet=sheet)
            questions = list(questions_of(document, exercises, None))
            yield from named(BANKS[file_format](questions), paper.id).items()
            continue
        for with_solutions in solutions:
            document = edition(paper, results, verdicts, solutions=with_solutions, sheet=sheet)
            name = f"{paper.id}{'-solutions' if with_solutions else ''}"
            yield from named(next(iter(EDITIONS[file_format]([document]))), name).items()


def with_handout(papers: Sequence[Paper], *, all_needed: bool = False, file_format: str = "pdf") -> list[Paper]:
    """Return the papers that have a handout, or slides if that is the format.

    Raises
    ------
    TemplateError
        If none has one, or `all_needed` and one has none.
    """
    kind = SLIDES if file_format == SLIDES else TEXT
    found = [paper for paper in papers if (paper.folder() / f"{kind}.md").is_file()]
    missing = [paper.id for paper in papers if paper not in found]
    if missing and (all_needed or not found):
        msg = f"{missing[0]}/{kind}.md: the paper has no {kind}"
        raise TemplateError(msg)
    return found
