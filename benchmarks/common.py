"""What the benchmarks share: processor time, python-control's usual way, and tables to print and keep."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import control

REPORT = Path(__file__).resolve().parents[1] / "build" / "bench.md"
PADE_ORDER = 10


def processor_time(function: Callable[[], Any], repeats: int) -> float:
    """Return the shortest processor time of several calls, in seconds: the machine's noise only ever adds."""
    shortest = float("inf")
    for _ in range(repeats):
        start = time.process_time()
        function()
        shortest = min(shortest, time.process_time() - start)
    return shortest


def open_loop(k: float, ki: float, num: Sequence[float], den: Sequence[float], dead_time: float) -> Any:
    """Return C G as python-control users build it, with a Pade approximation of the dead time."""
    delay = control.tf(*control.pade(dead_time, PADE_ORDER))
    return control.tf([k, ki], [1.0, 0.0]) * control.tf(num, den) * delay


@dataclass
class Table:
    """A table of results, printed as it grows and kept as Markdown."""

    title: str
    columns: tuple[str, ...]
    rows: list[tuple[str, ...]] = field(default_factory=list)

    def add(self, *cells: str) -> None:
        """Print a row and keep it."""
        if not self.rows:
            print(f"\n{self.title}\n  {'  |  '.join(self.columns)}", flush=True)
        self.rows.append(cells)
        print(f"  {'  |  '.join(cells)}", flush=True)

    def to_markdown(self) -> str:
        """Return the table as Markdown."""
        lines = [f"## {self.title}", "", f"| {' | '.join(self.columns)} |", f"|{'---|' * len(self.columns)}"]
        return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in self.rows)]) + "\n"


def seconds(value: float) -> str:
    """Return a time with its unit."""
    for limit, factor, unit in ((1e-3, 1e6, "us"), (1.0, 1e3, "ms")):
        if value < limit:
            return f"{value * factor:.3g} {unit}"
    return f"{value:.3g} s"


def times(value: float) -> str:
    """Return a ratio."""
    return f"{value:.3g}"
