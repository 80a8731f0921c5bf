"""Compute and draw the exhibits of papers, in worker processes, keeping results between runs.

The result does not depend on the number of workers: every unit of work is computed alone, by the same code, in the same
surroundings, with one thread for linear algebra, and results are put together in the order of the paper.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

# Before numpy is imported anywhere: it reads these once. More threads would change the last bits of results.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"):
    os.environ.setdefault(_variable, "1")

from replicate.errors import ReplicateError
from replicate.exhibits import Exhibit, Paper
from replicate.exhibits.results import Result, Results, TableResult, errors_of
from replicate.run.cache import Cache
from replicate.run.costs import Costs, user_folder
from replicate.run.limits import UNIT_TIMEOUT
from replicate.run.performance import Performance
from replicate.run.units import Unit, units_of

CACHE_DIR = Path("build/cache")


class Executor(Protocol):
    """Something that does units: processes on this machine, or the workers of a cluster."""

    def run(self, units: Mapping[Unit, Exhibit]) -> Generator[tuple[Unit, Performance], None, None]:
        """Yield every unit once, as it is done; units are best begun in the given order."""


@dataclass(frozen=True)
class Progress:
    """Reported after every unit: how far the run is, and what this unit came to.

    Attributes
    ----------
    why
        Why the unit was computed; empty if its result was kept.
    output
        What the unit wrote to standard output and error.
    changed
        Names of what the unit left changed around it.
    """

    done: int
    total: int
    unit: Unit
    errors: dict[str, str] = field(default_factory=dict)
    from_cache: bool = False
    why: str = ""
    output: str = ""
    changed: tuple[str, ...] = ()


def run(
    papers: Sequence[Paper],
    exhibits: Collection[tuple[str, str]] | None = None,
    *,
    jobs: int | None = None,
    cache_dir: Path | None = CACHE_DIR,
    progress: Callable[[Progress], None] | None = None,
    unit_timeout: float = UNIT_TIMEOUT,
    executor: Executor | None = None,
) -> Results:
    """Compute exhibits.

    Parameters
    ----------
    papers
        Loaded or not.
    exhibits
        ``(paper, exhibit)`` pairs to compute; all of the papers' exhibits if not given.
    jobs
        Number of worker processes; that of the processor's cores if not given.
    cache_dir
        Where results are kept between runs; ``None`` computes everything anew.
    progress
        Called after every unit of work, in the order in which they finish.
    unit_timeout
        Seconds after which a unit (of claims: one of them) is stopped.
    executor
        Does the units; processes on this machine if not given.

    Returns
    -------
    dict
        By ``(paper, exhibit)``, in the papers' order; exhibits that are not computable have no entry. An
        exhibit or reading that raised, ended its process or took too long is there with its reason.

    Raises
    ------
    ReplicateError
        If `jobs` or `unit_timeout` is not positive, or a unit is never reported.
    """
    if jobs is not None and jobs < 1:
        msg = f"the number of jobs must be at least 1, not {jobs}"
        raise ReplicateError(msg)
    if not unit_timeout > 0:
        msg = f"the time limit of a unit must be more than 0 s, not {unit_timeout:g}"
        raise ReplicateError(msg)
    wanted = [
        (paper, exhibit)
        for paper in papers
        for exhibit in paper.load().exhibits.values()
        if exhibits is None or (paper.id, exhibit.id) in exhibits
    ]
    owner = {unit: paper for paper, exhibit in wanted for unit in units_of(paper, exhibit)}
    cache = Cache(cache_dir)
    report = progress or (lambda _: None)
    finished: dict[Unit, Result] = {}
    why: dict[Unit, str] = {}
    for unit, paper in owner.items():
        kept, reason = cache.get(paper, unit)
        if kept is None:
            why[unit] = reason
        else:
            finished[unit] = kept
            report(Progress(len(finished), len(owner), unit, from_cache=True))
    if why:
        if executor is None:
            from replicate.run.pool import LocalPool

            executor = LocalPool(jobs or os.cpu_count() or 1, unit_timeout)
        for unit, done in _compute(owner, why, executor, cache):
            finished[unit] = done.result
            errors = errors_of(done.result)
            report(
                Progress(
                    len(finished), len(owner), unit, errors, why=why[unit], output=done.output, changed=done.changed
                )
            )
    missing = [unit for unit in owner if unit not in finished]
    if missing:
        msg = f"{missing[0]} has not been reported, and {len(missing) - 1} more"
        raise ReplicateError(msg)
    together: Results = {}
    for paper, exhibit in wanted:
        parts = [finished[unit] for unit in units_of(paper, exhibit)]
        if parts:
            together[paper.id, exhibit.id] = _together(exhibit, parts)
    return together


def _compute(
    owner: Mapping[Unit, Paper], units: Collection[Unit], executor: Executor, cache: Cache
) -> Iterator[tuple[Unit, Performance]]:
    """Yield units with what came of them, the longest begun first; keep what did not fail."""
    costs = Costs(user_folder())
    ordered = costs.longest_first(units)
    try:
        with closing(executor.run({unit: owner[unit].exhibits[unit.exhibit] for unit in ordered})) as performances:
            for unit, done in performances:
                costs.add(unit, done.seconds)
                if not errors_of(done.result):
                    cache.put(unit, done.text, done.dependencies)
                yield unit, done
    finally:
        costs.save()
    cache.trim()


def failures(results: Results) -> list[str]:
    """Return one line for every reading, figure or claim that raised: its name and the reason."""
    lines = []
    for (paper, exhibit), result in results.items():
        for part, why in errors_of(result).items():
            lines.append(f"{paper}/{exhibit}{f' ({part})' if part else ''}: {why}")
    return lines


def _together(exhibit: Exhibit, parts: Iterable[Result]) -> Result:
    """Put the readings of a table together; every other exhibit is one part."""
    first, *rest = parts
    if not isinstance(first, TableResult):
        return first
    tables = [part for part in (first, *rest) if isinstance(part, TableResult)]
    return TableResult(
        first.paper,
        exhibit.id,
        frames={id: frame for part in tables for id, frame in part.frames.items()},
        errors={id: why for part in tables for id, why in part.errors.items()},
        ranges={id: ranges for part in tables for id, ranges in part.ranges.items()},
        trials=first.trials,
    )
