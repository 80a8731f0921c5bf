"""Whether everything that is printed holds or is explained, and nothing has moved.

Judging a paper already lists most of what can be wrong: a printed value that does not hold and has no ledger
entry, an entry that no longer applies, a numbered exhibit missing from the inventory, an exhibit that raised.
Here the comparison with the accepted state joins in, and the demand that something was compared at all.
"""

from __future__ import annotations

from pathlib import Path

from replicate.diff.comparison import Comparison, compare
from replicate.run.outcome import Outcome
from replicate.verdicts.open_work import open_work


def check(outcome: Outcome, accepted: Path) -> list[str]:
    """Return one line for each problem; none means that everything is as accepted.

    Parameters
    ----------
    accepted
        The folder with the accepted state.
    """
    return problems(outcome, compare(outcome, accepted))


def problems(outcome: Outcome, comparison: Comparison) -> list[str]:
    """Return one line for each problem of a run that has been compared with the accepted state."""
    judgement = outcome.judgement
    found = list(judgement.problems)
    found += [line for paper in outcome.papers for line in open_work(paper)]
    if not judgement.compared:
        found.append("no printed value was compared with a computed one")
    # Judging has named the exhibits that raised already.
    compared = Comparison([exhibit for exhibit in comparison.exhibits if not exhibit.failed])
    return found + compared.lines
