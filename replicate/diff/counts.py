"""How many exhibits were compared and how many changed, in one line."""

from __future__ import annotations

from replicate.diff.comparison import Comparison


def summary(comparison: Comparison) -> str:
    """Return one line that counts what was compared and what changed.

    Examples
    --------
    >>> summary(Comparison())
    'nothing was compared'
    """
    total, changes = len(comparison.exhibits), len(comparison.changes)
    failed = sum(exhibit.failed for exhibit in comparison.exhibits)
    damaged = sum(exhibit.damaged for exhibit in comparison.exhibits)
    parts = []
    if not comparison.compared:
        parts.append("nothing was compared")
    if changes:
        where = f"{len(comparison.changed)} of {total} exhibit{'s' if total != 1 else ''}"
        parts.append(f"{changes} change{'s' if changes != 1 else ''} in {where}")
    elif comparison.compared:
        parts.append(f"nothing differs from the accepted state; exhibits compared: {comparison.compared}")
    if failed:
        parts.append(f"could not be computed: {failed}")
    if damaged:
        parts.append(f"damaged in the accepted state: {damaged}")
    return "; ".join(parts)
