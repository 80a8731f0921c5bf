"""What differs from the accepted state, one line for each change."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from replicate.diff.changes import Change
from replicate.diff.comparison import Comparison
from replicate.diff.counts import summary

# A change of a rule may move every value of a table; nobody reads hundreds of lines.
_MOST_LINES = 12


def print_comparison(comparison: Comparison, console: Console) -> None:
    """Print the changes and a line that counts them."""
    print_changes(comparison.changes, console)
    console.print(Text(summary(comparison)), soft_wrap=True)


def print_changes(changes: Sequence[Change], console: Console) -> None:
    """Print one line for each change, of every exhibit only the first ones."""
    by_exhibit: dict[tuple[str, str], list[Change]] = {}
    for change in changes:
        by_exhibit.setdefault((change.paper, change.exhibit), []).append(change)
    for (paper, exhibit), found in by_exhibit.items():
        shown = found if len(found) <= _MOST_LINES else [*found[: _MOST_LINES - 2], found[-1]]
        left = len(found) - len(shown)
        for place, change in enumerate(shown, start=1):
            if left and place == len(shown):
                _print(console, paper, exhibit, f"{left} more changes not listed here, and")
            _print(console, paper, exhibit, change.text)


def _print(console: Console, paper: str, exhibit: str, text: str) -> None:
    # Lines stay whole, so that they can be searched.
    console.print(Text.assemble((f"{paper}/{exhibit}:", "bold"), " ", text), soft_wrap=True)
