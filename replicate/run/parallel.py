"""Compute and draw the exhibits of papers, in parallel processes, keeping results between runs.

The result does not depend on the number of workers: every unit of work is computed alone, by the same code,
with one thread for linear algebra, and results are put together in the order of the paper.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

# Before numpy is imported anywhere: it reads these once. More threads would change the last bits of results.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"):
    os.environ.setdefault(_variable, "1")

from replicate.errors import ReplicateError  # noqa: E402
from replicate.exhibits import Exhibit, Paper  # noqa: E402
from replicate.exhibits.results import Result, Results, TableResult, errors_of  # noqa: E402
from replicate.run.cache import Cache  # noqa: E402  -- after the environment is set
from replicate.run.units import Unit, compute, units_of  # noqa: E402

CACHE_DIR = Path("build/cache")


@dataclass(frozen=True)
class Progress:
    """Reported after every unit: how far the run is, and what this unit came to."""

    done: int
    total: int
    unit: Unit
    errors: dict[str, str] = field(default_factory=dict)
    from_cache: bool = False


def run(
    papers: Sequence[Paper],
    exhibits: Collection[tuple[str, str]] | None = None,
    *,
    jobs: int | None = None,
    cache_dir: Path | None = CACHE_DIR,
    progress: Callable[[Progress], None] | None = None,
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

    Returns
    -------
    dict
        By ``(paper, exhibit)``, in the papers' order; exhibits that are not computable have no entry. An
        exhibit or reading that raised is there with its reason.

    Raises
    ------
    ReplicateError
        If `jobs` is not positive, or a worker process died.
    """
    if jobs is not None and jobs < 1:
        msg = f"the number of jobs must be at least 1, not {jobs}"
        raise ReplicateError(msg)
    wanted = [
        (paper, exhibit)
        for paper in papers
        for exhibit in paper.load().exhibits.values()
        if exhibits is None or (paper.id, exhibit.id) in exhibits
    ]
    cache = Cache(cache_dir)
    owner = {unit: paper for paper, exhibit in wanted for unit in units_of(paper, exhibit)}
    report = progress or (lambda _: None)
    finished: dict[Unit, Result] = {}

    for unit, paper in owner.items():
        kept = cache.get(paper, str(unit))
        if kept is not None:
            finished[unit] = kept
            report(Progress(len(finished), len(owner), unit, from_cache=True))
    for unit, result in _compute_all([unit for unit in owner if unit not in finished], jobs or os.cpu_count() or 1):
        finished[unit] = result
        errors = errors_of(result)
        if not errors:
            cache.put(owner[unit], str(unit), result)
        report(Progress(len(finished), len(owner), unit, errors))

    together: Results = {}
    for paper, exhibit in wanted:
        parts = [finished[unit] for unit in units_of(paper, exhibit)]
        if parts:
            together[paper.id, exhibit.id] = _together(exhibit, parts)
    return together


def failures(results: Results) -> list[str]:
    """Return one line for every reading, figure or claim that raised: its name and the reason."""
    lines = []
    for (paper, exhibit), result in results.items():
        for part, why in errors_of(result).items():
            lines.append(f"{paper}/{exhibit}{f' ({part})' if part else ''}: {why}")
    return lines


def _compute_all(units: Sequence[Unit], jobs: int) -> Iterator[tuple[Unit, Result]]:
    """Yield units with their results as they finish."""
    if jobs == 1 or len(units) < 2:
        for unit in units:
            yield unit, compute(unit)
        return
    from joblib import Parallel, delayed, parallel_config
    from joblib.externals.loky.process_executor import TerminatedWorkerError

    try:
        with parallel_config(backend="loky", inner_max_num_threads=1):
            workers = Parallel(n_jobs=min(jobs, len(units)), batch_size=1, return_as="generator_unordered")
            yield from workers(delayed(_named)(unit) for unit in units)
    except TerminatedWorkerError as error:
        msg = f"a worker process died, perhaps because memory ran out; try fewer --jobs: {_first_line(error)}"
        raise ReplicateError(msg) from error


def _named(unit: Unit) -> tuple[Unit, Result]:
    return unit, compute(unit)


def _first_line(error: Exception) -> str:
    return str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__


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
    )
