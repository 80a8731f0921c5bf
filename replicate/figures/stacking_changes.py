"""Compare what lies over what in two states; apart from what records it, so that it loads no renderer."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from replicate.figures.differences import Difference


def stacking_changes(
    one: Mapping[str, Any],
    other: Mapping[str, Any],
    where: str,
    names: Mapping[str, str],
    curves: Collection[str] = (),
) -> Iterator[Difference]:
    """Yield what lies over what now, of the pairs that overlap in both states.

    Parameters
    ----------
    one, other
        Descriptions of the figure or of a panel, with pairs of names under ``over``.
    names
        Accepted names by new names, of what has another name now.
    curves
        Names that are those of curves.
    """
    new = {tuple(names.get(name, name) for name in pair) for pair in other.get("over", [])}
    for upper, lower in one.get("over", []):
        if (lower, upper) in new:
            above, below = (f"curve '{name}'" if name in curves else name for name in (lower, upper))
            yield Difference("look", f"{above} is drawn over {below} now", f"{where} / {lower}")
