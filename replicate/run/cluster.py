"""Units done by the workers of a cluster: each in a process of its own beside the worker, as on this machine.

So a unit that ends its process, never ends or changes what is around it does no more harm there than here.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
from collections.abc import Generator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from replicate.exhibits import Exhibit
from replicate.run.backends import Backend
from replicate.run.performance import Performance
from replicate.run.pool import LocalPool
from replicate.run.units import Unit, loaded


@dataclass(frozen=True)
class ClusterPool:
    """Does units on a cluster.

    Parameters
    ----------
    backend
        Gives units to workers, which see the same files at the same paths.
    unit_timeout
        Seconds after which a unit is stopped.
    """

    backend: Backend
    unit_timeout: float

    def run(self, units: Mapping[Unit, Exhibit]) -> Generator[tuple[Unit, Performance], None, None]:
        """Yield units as they are done; they are begun in the given order.

        Raises
        ------
        ReplicateError
            If the scheduler does not answer or workers are lost time and again.
        """
        there = partial(_perform, timeout=self.unit_timeout, folder=str(Path.cwd()), path=tuple(sys.path))
        for unit, (content, output) in self.backend.unordered(there, list(units)):
            yield unit, Performance.from_bytes(content, output)


def _perform(unit: Unit, *, timeout: float, folder: str, path: tuple[str, ...]) -> tuple[bytes, str]:
    """Do a unit in a process beside a cluster's worker; this runs in the worker."""
    sys.path += [entry for entry in path if entry not in sys.path]
    with suppress(OSError):
        os.chdir(folder)
    # Dask's nanny marks its worker as one that has no children, which the standard library enforces.
    multiprocessing.current_process()._config["daemon"] = False  # type: ignore[attr-defined]  # noqa: SLF001
    exhibit = loaded(unit.package).exhibits[unit.exhibit]
    done = next(performance for _, performance in LocalPool(1, timeout).run({unit: exhibit}))
    return replace(done, output="").to_bytes(), done.output
