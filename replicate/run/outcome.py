"""A whole run with its judgement: what the report, the outputs and the accepted state are made from."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from replicate.errors import ReplicateError
from replicate.exhibits import Paper
from replicate.exhibits.results import Results
from replicate.run.limits import UNIT_TIMEOUT
from replicate.run.parallel import Executor, Progress, failures, run
from replicate.verdicts.inputs import Inputs, read_inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.rows import Judgement

Selection = Collection[tuple[str, str]]


@dataclass(frozen=True)
class Outcome:
    """Papers, their results by (paper, exhibit), and what is said about each paper.

    Attributes
    ----------
    complete
        Whether every exhibit of the papers was computed, not just a selection.
    broken
        By id: why a paper was left out.
    inputs
        By id: the data files of a paper as they were read.
    """

    papers: Sequence[Paper]
    results: Results
    judgements: dict[str, Judgement]
    complete: bool = True
    broken: dict[str, str] = field(default_factory=dict)
    inputs: dict[str, Inputs] = field(default_factory=dict)

    @property
    def judgement(self) -> Judgement:
        """The judgements of all papers as one, in the order of the papers."""
        together = Judgement()
        for part in self.judgements.values():
            together.extend(part)
        return together

    def of(self, papers: Collection[str]) -> Outcome:
        """Return the part of it that is about some papers."""
        return replace(
            self,
            papers=[paper for paper in self.papers if paper.id in papers],
            results={key: result for key, result in self.results.items() if key[0] in papers},
            judgements={id: part for id, part in self.judgements.items() if id in papers},
            broken={id: why for id, why in self.broken.items() if id in papers},
        )

    def without(self, broken: dict[str, str]) -> Outcome:
        """Return the part of it that is not about papers that turned out to be broken, which are named with the reason.

        Raises
        ------
        ReplicateError
            If no paper is left.
        """
        left = self.of({paper.id for paper in self.papers} - set(broken))
        if not left.papers:
            raise ReplicateError(next(iter(broken.values())))
        return replace(left, broken=self.broken | broken)

    @property
    def failures(self) -> list[str]:
        """One line for everything that raised."""
        return failures(self.results)


def recompute(
    papers: Sequence[Paper],
    selection: Selection | None = None,
    *,
    jobs: int | None = None,
    cache_dir: Path | None,
    progress: Callable[[Progress], None] | None = None,
    unit_timeout: float = UNIT_TIMEOUT,
    executor: Executor | None = None,
) -> Outcome:
    """Compute the exhibits of papers and judge them.

    Parameters
    ----------
    selection
        ``(paper, exhibit)`` pairs; all exhibits if not given.
    jobs, cache_dir, progress, unit_timeout, executor
        As for `replicate.run.parallel.run`.

    Raises
    ------
    ReplicateError
        If no paper is left whose data files can be read. An exhibit that raises, or ends its process, is a result, a
        paper with a malformed data file is left out and named.
    """
    inputs: dict[str, Inputs] = {}
    broken: dict[str, ReplicateError] = {}
    for paper in papers:  # before computing: a typing error is reported at once
        try:
            inputs[paper.id] = read_inputs(paper)
        except ReplicateError as error:
            broken[paper.id] = error
    papers = [paper for paper in papers if paper.id in inputs]
    if not papers:
        raise next(iter(broken.values()))
    results = run(
        papers,
        selection,
        jobs=jobs,
        cache_dir=cache_dir,
        progress=progress,
        unit_timeout=unit_timeout,
        executor=executor,
    )
    judgements = {}
    for paper in papers:
        exhibits = None if selection is None else [id for owner, id in selection if owner == paper.id]
        judgements[paper.id] = judge(paper, results, inputs[paper.id], exhibits=exhibits)
    why = {id: str(error) for id, error in broken.items()}
    return Outcome(papers, results, judgements, selection is None, why, inputs)
