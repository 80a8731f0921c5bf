"""Progress of a run: a bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
from rich.progress import Progress as Bar

from replicate.run.parallel import Progress


@contextmanager
def progress_on(console: Console, *, verbose: bool = False) -> Iterator[Callable[[Progress], None]]:
    """Yield the function to give to a run as its ``progress``.

    Results that come out of the cache are counted, not named.

    Parameters
    ----------
    verbose
        Say also why each unit is computed, what it writes, and what it leaves changed around it.
    """
    with _bar(console) if console.is_terminal and not verbose else _lines(console, verbose=verbose) as report:
        yield report


@contextmanager
def _bar(console: Console) -> Iterator[Callable[[Progress], None]]:
    columns = (TextColumn("computing"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}"))
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None)

        def report(step: Progress) -> None:
            bar.update(task, total=step.total, completed=step.done, description=str(step.unit))

        yield report


@contextmanager
def _lines(console: Console, *, verbose: bool) -> Iterator[Callable[[Progress], None]]:
    kept = total = 0

    def report(step: Progress) -> None:
        nonlocal kept, total
        total = step.total
        if step.from_cache:
            kept += 1
            return
        outcome = "  FAILED" if step.errors else ""
        console.print(f"computed {step.done}/{step.total}  {step.unit}{outcome}", markup=False)
        if verbose:
            for line in _details(step):
                console.print(f"    {line}", markup=False, highlight=False, soft_wrap=True)

    yield report
    if kept:
        console.print(f"{kept} of {total} results kept from an earlier run", markup=False)


def _details(step: Progress) -> Iterator[str]:
    yield f"because {step.why}"
    for part, why in step.errors.items():
        yield f"{part or 'the figure'}: {why}"
    if step.changed:
        yield f"left changed: {', '.join(step.changed)}"
    for line in step.output.splitlines():
        yield "| " + "".join(sign if sign.isprintable() else " " for sign in line)
