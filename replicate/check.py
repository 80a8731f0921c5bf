"""Whether everything that is printed holds or is explained, and nothing has moved.

Judging a paper already lists most of what can be wrong: a printed value that does not hold and has no ledger
entry, an entry that no longer applies, a numbered exhibit missing from the inventory, an exhibit that raised.
Here the comparison with the accepted state joins in, and the demand that something was compared at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from replicate.diff.changes import Change
from replicate.diff.comparison import compare
from replicate.outcome import Outcome


def check(outcome: Outcome, accepted: Path) -> list[str]:
    """Return one line for each problem; none means that everything is as accepted.

    Parameters
    ----------
    accepted
        The folder with the accepted state.

    Raises
    ------
    AcceptedStateError
        If an accepted file is damaged.
    """
    judgement = outcome.judgement
    problems = list(judgement.problems)
    if not any(row.match != "none" for row in judgement.results):
        problems.append("no printed value was compared with a computed one")
    return problems + [str(change) for change in _news(compare(outcome, accepted).changes)]


def _news(changes: Sequence[Change]) -> list[Change]:
    """Leave out exhibits that raised: judging has said so already."""
    return [change for change in changes if change.kind != "failed"]
