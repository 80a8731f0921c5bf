"""Whether the handouts and slides of papers can be made, as far as their texts decide it; nothing is drawn or run."""

from __future__ import annotations

from collections.abc import Sequence

from replicate.errors import ReplicateError
from replicate.exhibits import Paper
from replicate.exhibits.results import Results
from replicate.handout.edition import TEXT, edition
from replicate.handout.formats import SLIDES
from replicate.verdicts.rows import VerdictRow


def unreadable_handouts(papers: Sequence[Paper], results: Results, verdicts: Sequence[VerdictRow]) -> dict[str, str]:
    """Return by id why the handout or the slides of a paper cannot be made, with file and line.

    Nothing is returned for those that can be. Programs in the text are not run: `replicate handout` does that.
    """
    found = {}
    for paper in papers:
        for kind in (TEXT, SLIDES):
            if (paper.folder() / f"{kind}.md").is_file() and paper.id not in found:
                try:
                    edition(paper, results, verdicts, solutions=True, kind=kind, programs=False)
                except ReplicateError as error:
                    found[paper.id] = str(error)
    return found
