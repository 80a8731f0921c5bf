"""Whether the handouts and slides of papers can be made, as far as their texts decide it; nothing is drawn or run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from replicate.errors import ReplicateError
from replicate.exhibits import Paper
from replicate.exhibits.results import Results
from replicate.handout.edition import TEXT, edition
from replicate.handout.formats import SLIDES
from replicate.handout.own_code import LONGEST_RUN
from replicate.handout.placing import code_of
from replicate.run.guarded import GuardedProcess
from replicate.run.units import loaded
from replicate.verdicts.rows import VerdictRow


def unreadable_handouts(
    papers: Sequence[Paper], results: Results, verdicts: Sequence[VerdictRow], seconds: float = LONGEST_RUN
) -> dict[str, str]:
    """Return by id why the handout or the slides of a paper cannot be made, with file and line.

    Nothing is returned for those that can be. Programs in the text are not run, and its own figures not drawn:
    `replicate handout` does that. ``seconds`` is what a function of an exercise may take.
    """
    found = {}
    with GuardedProcess(seconds) as process:
        for paper in papers:
            kinds = [kind for kind in (TEXT, SLIDES) if (paper.folder() / f"{kind}.md").is_file()]
            given = (
                {key: result for key, result in results.items() if key[0] == paper.id},
                [row for row in verdicts if row.paper == paper.id],
            )
            try:
                for kind in kinds:
                    if code_of(paper).is_file():
                        list(process.stream(_read_in_process, paper.package, *given, kind))
                    else:  # a text alone ends
                        _read(paper, *given, kind)
            except ReplicateError as error:
                found[paper.id] = str(error)
    return found


def _read(paper: Paper, results: Results, verdicts: Sequence[VerdictRow], kind: str) -> None:
    edition(paper, results, verdicts, solutions=True, kind=kind, only_read=True)


def _read_in_process(package: str, results: Results, verdicts: Sequence[VerdictRow], kind: str) -> Iterator[None]:
    _read(loaded(package), results, verdicts, kind)
    yield from ()
