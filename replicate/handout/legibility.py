"""Whether the handouts of papers can be made, as far as their texts decide it; nothing is drawn or run."""

from __future__ import annotations

from collections.abc import Sequence

from replicate.errors import ReplicateError
from replicate.exhibits import Paper
from replicate.exhibits.results import Results
from replicate.handout.edition import FILE, edition
from replicate.verdicts.rows import VerdictRow


def unreadable_handouts(papers: Sequence[Paper], results: Results, verdicts: Sequence[VerdictRow]) -> dict[str, str]:
    """Return by id why the handout of a paper cannot be made, with file and line; nothing for those that can be.

    A program in the text is not run: `replicate handout` does that.
    """
    found = {}
    for paper in papers:
        if (paper.folder() / FILE).is_file():
            try:
                edition(paper, results, verdicts, solutions=True, programs=False)
            except ReplicateError as error:
                found[paper.id] = str(error)
    return found
