"""Prove that no inputs that round to the print give a quantity, by halving the box until every part is excluded.

A search that finds no such inputs may have missed them. Where a reading can rule out, with certainty, that a quantity
takes a value of some interval anywhere in a part of the box, the search becomes a proof: a part is excluded if one of
the quantities that ought to hold together cannot; any other part is halved along its longest side. A part that is still
open after several halvings ends the attempt: it says soon that there is no proof.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

Ends = tuple[float, float]
Box = Mapping[str, Ends]
Rule = Callable[[str, Box, Ends], bool]
"""From a case, a box of its inputs and an interval: whether certainly no inputs of the box give such a value."""

_MOST_PARTS = 64
_MOST_HALVINGS = 8  # of all sides together


def excluded(rules: Mapping[str, Rule], case: str, box: Box, targets: Mapping[str, Ends]) -> bool:
    """Say whether it is proven that no inputs of a box give all targets together.

    Parameters
    ----------
    rules
        By quantity; a rule says no where it cannot tell. They are asked in this order, the quick ones first.
    targets
        By quantity: the interval in which it ought to lie.

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
    whole = {name: high - low for name, (low, high) in box.items()}
    waiting: list[tuple[dict[str, Ends], int]] = [(dict(box), 0)]
    for _ in range(_MOST_PARTS):
        if not waiting:
            return True
        part, halvings = waiting.pop()
        if any(rule(case, part, targets[quantity]) for quantity, rule in rules.items() if quantity in targets):
            continue
        longest = max(part, key=lambda name: (part[name][1] - part[name][0]) / whole[name] if whole[name] else 0.0)
        low, high = part[longest]
        middle = (low + high) / 2
        if halvings == _MOST_HALVINGS or not low < middle < high:
            return False
        waiting += [(part | {longest: half}, halvings + 1) for half in ((low, middle), (middle, high))]
    return False
