"""Prove that no inputs that round to the print give a quantity, by halving the box until every part is excluded.

A search that finds no such inputs may have missed them. Where a reading can rule out, with certainty, that a quantity
takes a value of some interval anywhere in a part of the box, the search becomes a proof: a part is excluded if one of
the quantities that ought to hold together cannot; any other part is halved along its longest side. A part that is still
open after several halvings ends the attempt.

What can be said of a part can be said of all that it is divided into. So the smallest part around the point at which
the search came closest is tried before the halves: where it stays open, the end is known.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

Ends = tuple[float, float]
Box = Mapping[str, Ends]
Rule = Callable[[str, Box, Ends], bool]
"""From a case, a box of its inputs and an interval: whether certainly no inputs of the box give such a value."""

_MOST_PARTS = 64
_MOST_HALVINGS = 8  # of all sides together


def excluded(
    rules: Mapping[str, Rule],
    case: str,
    box: Box,
    targets: Mapping[str, Ends],
    closest: Mapping[str, float] | None = None,
) -> bool:
    """Say whether it is proven that no inputs of a box give all targets together.

    Parameters
    ----------
    rules
        By quantity; a rule says no where it cannot tell. They are asked in this order, the quick ones first.
    targets
        By quantity: the interval in which it ought to lie.
    closest
        A point of the box at which the targets are nearly met, if one is known; otherwise its middle is taken.

    Examples
    --------
    >>> def sum_misses(case, box, ends):
    ...     return box["x"][1] + box["y"][1] < ends[0] or box["x"][0] + box["y"][0] > ends[1]
    >>> def difference_misses(case, box, ends):
    ...     return box["x"][1] - box["y"][0] < ends[0] or box["x"][0] - box["y"][1] > ends[1]
    >>> rules = {"sum": sum_misses, "difference": difference_misses}
    >>> box = {"x": (0.0, 1.0), "y": (0.0, 1.0)}
    >>> excluded(rules, "A", box, {"sum": (1.9, 2.0)}), excluded(rules, "A", box, {"sum": (2.1, 2.2)})
    (False, True)
    >>> excluded(rules, "A", box, {"sum": (1.9, 2.0), "difference": (0.5, 0.6)})
    True
    """

    def is_out(part: Box) -> bool:
        return any(rule(case, part, targets[quantity]) for quantity, rule in rules.items() if quantity in targets)

    def halved(part: Box, halvings: int) -> list[tuple[Box, int]]:
        name, *halves = _halves(part, box)
        return [({**part, name: half}, halvings + 1) for half in halves]

    if is_out(box):
        return True
    if not is_out(_smallest(box, closest or {name: sum(ends) / 2 for name, ends in box.items()})):
        return False
    waiting = halved(box, 0)
    for _ in range(_MOST_PARTS - 1):
        if not waiting:
            return True
        part, halvings = waiting.pop()
        if is_out(part):
            continue
        if halvings == _MOST_HALVINGS:
            return False
        waiting += halved(part, halvings)
    return False


def _smallest(box: Box, point: Mapping[str, float]) -> Box:
    """Return the part of a box around a point that is left after as many halvings as there may be."""
    part = dict(box)
    for _ in range(_MOST_HALVINGS):
        name, lower, upper = _halves(part, box)
        part[name] = lower if point[name] <= lower[1] else upper
    return part


def _halves(part: Box, box: Box) -> tuple[str, Ends, Ends]:
    """Return the name of a part's side that is longest as a share of the box's, and its halves."""
    sides = {name: high - low for name, (low, high) in box.items()}
    name = max(part, key=lambda name: (part[name][1] - part[name][0]) / sides[name] if sides[name] else 0.0)
    low, high = part[name]
    middle = (low + high) / 2
    return name, (low, middle), (middle, high)
