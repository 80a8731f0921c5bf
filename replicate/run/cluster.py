"""Units done by the workers of a cluster: each in a process of its own beside the worker, as on this machine.

So a unit that ends its process, never ends or changes what is around it does no more harm there than here.
"""

from __future__ import annotations

import importlib
import multiprocessing
import os
import sys
from collections.abc import Generator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from replicate.errors import ReplicateError
from replicate.exhibits import Claims, Exhibit, NotComputable
from replicate.run.backends import Backend, worker_address
from replicate.run.performance import Performance
from replicate.run.pool import LocalPool
from replicate.run.units import Unit

#: Where a worker looks for modules by itself: what is added for one project must not lead another astray.
_PATH = tuple(sys.path)


@dataclass(frozen=True)
class Order:
    """A unit, and what a worker must know of its exhibit; it imports no paper, which may be another one tomorrow."""

    unit: Unit
    exhibit: Exhibit

    @classmethod
    def of(cls, unit: Unit, exhibit: Exhibit) -> Order:
        """Leave out all that belongs to the paper's modules."""
        if isinstance(exhibit, Claims):
            return cls(unit, Claims(exhibit.id, exhibit.title, claims=dict.fromkeys(exhibit.claims)))  # type: ignore[arg-type]
        return cls(unit, NotComputable(exhibit.id, exhibit.kind, exhibit.title, "done elsewhere"))

    def __str__(self) -> str:
        return str(self.unit)


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
            If the scheduler does not answer, or workers do not see the paper or are lost time and again.
        """
        there = partial(_perform, timeout=self.unit_timeout, folder=str(Path.cwd()), path=tuple(sys.path))
        orders = [Order.of(unit, exhibit) for unit, exhibit in units.items()]
        for order, (content, output) in self.backend.unordered(there, orders):
            yield order.unit, Performance.from_bytes(content, output)


def _perform(order: Order, *, timeout: float, folder: str, path: tuple[str, ...]) -> tuple[bytes, str]:
    """Do a unit in a process beside a cluster's worker; this runs in the worker."""
    sys.path[:] = [*_PATH, *(entry for entry in path if entry not in _PATH)]
    importlib.invalidate_caches()
    with suppress(OSError):
        os.chdir(folder)
    # Dask's nanny marks its worker as one that has no children, which the standard library enforces.
    multiprocessing.current_process()._config["daemon"] = False  # type: ignore[attr-defined]  # noqa: SLF001
    unit = order.unit
    if find_spec(unit.package) is None:
        msg = f"{unit}: the worker {worker_address()} has no '{unit.package}':"
        msg += " it must see the papers' folders at the same paths"
        raise ReplicateError(msg)
    done = next(performance for _, performance in LocalPool(1, timeout).run({unit: order.exhibit}))
    return replace(done, output="").to_bytes(), done.output
