"""What differs from the accepted state, on one screen: of many changes those that matter most."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence

from rich.console import Console
from rich.text import Text

from replicate.diff.changes import Change
from replicate.diff.comparison import Comparison, ExhibitDiff
from replicate.diff.counts import summary

# A change of a rule may move every value of a paper; nobody reads hundreds of lines.
_MOST_LINES = 20
_MOST_NAMES = 6

# What is said of a change whatever its size comes first, and of this the worst.
_WEIGHTS = {"damaged": 6, "failed": 5, "removed": 4, "new": 3, "altered": 3, "verdict": 2, "printed": 1, "axes": 1}


def print_comparison(comparison: Comparison, console: Console) -> None:
    """Print the changes, at most a screen of them, and a line that counts them."""
    print_changes(comparison, console)
    console.print(Text(summary(comparison)), soft_wrap=True)


def print_changes(comparison: Comparison, console: Console) -> None:
    """Print one line for each change; if they are too many, the largest ones of each exhibit."""
    for name, text in _lines(comparison.changed):
        # Lines stay whole, so that they can be searched.
        console.print(Text.assemble((f"{name}:", "bold"), " ", text), soft_wrap=True)


def _lines(changed: Sequence[ExhibitDiff]) -> Iterator[tuple[str, str]]:
    """Yield paper or exhibit, and what to say of it."""
    nothing = [diff for diff in changed if _has_nothing(diff)]
    papers = Counter(diff.paper for diff in nothing)
    others = [diff for diff in changed if diff not in nothing or papers[diff.paper] == 1]
    for paper, count in papers.items():
        if count > 1:
            names = [diff.exhibit for diff in nothing if diff.paper == paper]
            more = f" and {count - _MOST_NAMES} more" if count > _MOST_NAMES else ""
            yield paper, f"{count} exhibits have no accepted state: {', '.join(names[:_MOST_NAMES])}{more}"
    # The worst exhibits, in the order of the papers, share the lines.
    order = sorted(others, key=lambda diff: max(map(_weight, diff.changes)), reverse=True)
    told = order[: _MOST_LINES if len(order) <= _MOST_LINES else _MOST_LINES - 1]
    shares = _shares([len(diff.changes) for diff in told], _MOST_LINES)
    share = {diff.name: lines for diff, lines in zip(told, shares, strict=True)}
    for diff in others:
        if diff.name in share:
            yield from ((diff.name, text) for text in _worst(diff, share[diff.name]))
    left = Counter(diff.paper for diff in others if diff.name not in share)
    if left:
        where = ", ".join(f"{count} of {paper}" for paper, count in left.items())
        yield "further", f"{left.total()} exhibits with smaller changes, not listed here: {where}"


def _has_nothing(diff: ExhibitDiff) -> bool:
    return diff.before is None and all(change.kind == "new" for change in diff.changes)


def _worst(diff: ExhibitDiff, count: int) -> list[str]:
    """Return the changes that matter most, in their own order; the last line counts the others."""
    if count >= len(diff.changes):
        return diff.texts
    worst = sorted(diff.changes, key=_weight, reverse=True)[:count]
    texts = [change.text for change in diff.changes if change in worst][:count]
    left = len(diff.changes) - count
    parts = [texts[-1], f"{left} more change{'s' if left > 1 else ''} not listed here", diff.same]
    return [*texts[:-1], "; ".join(part for part in parts if part)]


def _weight(change: Change) -> tuple[int, float]:
    size = math.inf if change.size is None else abs(change.size)
    return _WEIGHTS.get(change.kind, 0), size


def _shares(wanted: Sequence[int], lines: int) -> list[int]:
    """Divide lines fairly: everyone gets one, then another one as long as there are some and they are wanted.

    Examples
    --------
    >>> _shares([1, 9, 3], 8)
    [1, 4, 3]
    """
    shares = [1] * len(wanted)
    left = lines - len(wanted)
    while left > 0 and shares != list(wanted):
        for place, want in enumerate(wanted):
            if left > 0 and shares[place] < want:
                shares[place] += 1
                left -= 1
    return shares
