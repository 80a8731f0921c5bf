"""Progress of a sweep: a bar with an estimate of the end on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from replicate.sweeps.running import SweepProgress

_EVERY = 10.0  # seconds between two lines


@contextmanager
def sweep_progress_on(console: Console) -> Iterator[Callable[[SweepProgress], None]]:
    """Yield the function to give to a sweep as its ``progress``."""
    with _bar(console) if console.is_terminal else _lines(console) as report:
        yield report


@contextmanager
def _bar(console: Console) -> Iterator[Callable[[SweepProgress], None]]:
    columns = (TextColumn("loops"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None)

        def report(step: SweepProgress) -> None:
            bar.update(task, total=step.total, completed=step.done)

        yield report


@contextmanager
def _lines(console: Console) -> Iterator[Callable[[SweepProgress], None]]:
    begun = shown = time.monotonic()

    def report(step: SweepProgress) -> None:
        nonlocal shown
        now = time.monotonic()
        if step.done == step.kept:
            if step.kept:
                console.print(f"{step.kept} of {step.total} loops kept from an earlier run", markup=False)
        elif now - shown >= _EVERY or step.done == step.total:
            shown = now
            left = (now - begun) * (step.total - step.done) / (step.done - step.kept)
            rest = "" if step.done == step.total else f", about {_duration(left)} left"
            console.print(f"{step.done} of {step.total} loops{rest}", markup=False)

    yield report


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s" if minutes else f"{rest} s"
