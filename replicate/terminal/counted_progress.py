"""Progress of what is counted: a bar with an estimate of the end on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

_EVERY = 10.0  # seconds between two lines

#: Takes how many are done, how many there are, and how many of the done ones are of an earlier run.
Counted = Callable[[int, int, int], None]


@contextmanager
def counted_progress_on(console: Console, things: str) -> Iterator[Counted]:
    """Yield the function to give the counts to.

    Parameters
    ----------
    things
        What is counted, in the plural.
    """
    with _bar(console, things) if console.is_terminal else _lines(console, things) as report:
        yield report


@contextmanager
def _bar(console: Console, things: str) -> Iterator[Counted]:
    columns = (TextColumn(things), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, speed_estimate_period=math.inf) as bar:
        task = bar.add_task("", total=None)

        def report(done: int, total: int, kept: int) -> None:
            del kept  # a bar that begins further right says so
            bar.update(task, total=total, completed=done)

        yield report


@contextmanager
def _lines(console: Console, things: str) -> Iterator[Counted]:
    begun = shown = time.monotonic()

    def report(done: int, total: int, kept: int) -> None:
        nonlocal shown
        now = time.monotonic()
        if done == kept:
            if kept:
                console.print(f"{kept} of {total} {things} kept from an earlier run", markup=False)
        elif now - shown >= _EVERY or done == total:
            shown = now
            left = (now - begun) * (total - done) / (done - kept)
            rest = "" if done == total else f", about {_duration(left)} left"
            console.print(f"{done} of {total} {things}{rest}", markup=False)

    yield report


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s" if minutes else f"{rest} s"
