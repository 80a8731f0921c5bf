"""The measurement as text: for each kind of value how many digits, the median and the worst."""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Mapping, Sequence

from replicate.loops.conformance.digits import Quantity
from replicate.loops.conformance.goldens import Golden
from replicate.loops.conformance.library import Library

#: The digits of every value, by setting and loop.
Results = Mapping[tuple[str, str], Mapping[Quantity, float | None]]

GROUPS = ("stability", "poles", "peaks", "margins", "responses", "metrics")


def overview(library: Library, loops: Sequence[Golden], results: Results) -> Iterator[str]:
    """Yield the lines of the table over all loops: median and, in brackets, worst number of digits."""
    columns = []
    for setting in library.settings:
        digits: dict[str, list[float]] = {group: [] for group in GROUPS}
        for golden in loops:
            for quantity, right in results[setting, golden.id].items():
                if right is not None:
                    digits[quantity.group].append(right)
        columns.append(digits)
    yield f"{library.title}: right digits in {len(loops)} loops, median [worst], of at most 15"
    yield "".join([" " * 10, *(f"{setting:>11}" for setting in library.settings)])
    for group in GROUPS:
        cells = [f"{statistics.median(c[group]):.1f} [{min(c[group]):.0f}]" if c[group] else "-" for c in columns]
        yield "".join([f"{group:10}", *(f"{cell:>11}" for cell in cells)])


def each_loop(loops: Sequence[Golden], setting: str, results: Results) -> Iterator[str]:
    """Yield one line for each loop: the fewest right digits of each kind of value."""
    yield "".join([f"{setting:32}", *(f"{group:>11}" for group in GROUPS)])
    for golden in loops:
        worst: dict[str, float] = {}
        for quantity, right in results[setting, golden.id].items():
            if right is not None:
                worst[quantity.group] = min(right, worst.get(quantity.group, right))
        cells = [f"{worst[group]:.1f}" if group in worst else "-" for group in GROUPS]
        yield "".join([f"{golden.id:32}", *(f"{cell:>11}" for cell in cells)])
