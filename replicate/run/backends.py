"""Where work is done: by processes on this machine (joblib), or by the workers of a Dask cluster.

Either calls the same function with the same arguments, so the results are the same. Dask is asked directly, not through
joblib's backend for it: that one computes in this process when the cluster has a single core, and gives up everything
when one task cannot be done.
"""

from __future__ import annotations

import asyncio
import logging
import os
import threading
import time
import warnings
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from itertools import islice
from queue import Empty, SimpleQueue
from typing import Any, Protocol, TypeVar

from replicate.errors import ReplicateError
from replicate.run.same_program import difference, program

Item = TypeVar("Item")
Made = TypeVar("Made")

LOCAL, DASK = "local", "dask"
NAMES = (LOCAL, DASK)
ANSWER = 10  # seconds in which a scheduler must answer, and have a worker
ABSENCE = 60  # seconds without any worker, after which none is waited for
_LOOK = 5.0  # seconds between two looks whether there is one
_ATTEMPTS = 3  # a local worker that dies takes joblib's pool with it: what is left is begun anew


class Backend(Protocol):
    """Something that applies a function to items."""

    def unordered(
        self, function: Callable[[Item], Made], items: Sequence[Item]
    ) -> Generator[tuple[Item, Made], None, None]:
        """Yield every item with what the function makes of it, as it is done; items are begun in the given order.

        Raises
        ------
        ReplicateError
            If workers are lost time and again, or the scheduler does not answer.
        """


@dataclass(frozen=True)
class LocalProcesses:
    """Processes on this machine.

    Parameters
    ----------
    jobs
        Their number.
    """

    jobs: int

    def unordered(
        self, function: Callable[[Item], Made], items: Sequence[Item]
    ) -> Generator[tuple[Item, Made], None, None]:
        """Yield every item with what the function makes of it, as it is done."""
        import joblib
        from joblib.externals.loky.process_executor import TerminatedWorkerError

        waiting = dict(enumerate(items))
        for attempt in range(1, _ATTEMPTS + 1):
            parallel = joblib.Parallel(
                self.jobs,
                return_as="generator_unordered",
                batch_size=1,
                initializer=_end_with_parent,
                initargs=(os.getpid(),),
            )
            found = parallel(joblib.delayed(_numbered)(function, *each) for each in list(waiting.items()))
            try:
                for number, made in found:
                    yield waiting.pop(number), made
            except TerminatedWorkerError as error:
                if attempt == _ATTEMPTS:
                    msg = f"worker processes were ended {attempt} times; perhaps for want of memory: try fewer --jobs"
                    raise ReplicateError(msg) from error
            finally:
                with warnings.catch_warnings():  # whoever stops early says why
                    warnings.filterwarnings("ignore", r"\d+ tasks which were still being processed", UserWarning)
                    found.close()
            if not waiting:
                return


@dataclass(frozen=True)
class DaskCluster:
    """The workers of a Dask cluster, which see the same files and have the same packages.

    Parameters
    ----------
    scheduler
        Its address, such as ``tcp://host:8786``.
    """

    scheduler: str

    def unordered(
        self, function: Callable[[Item], Made], items: Sequence[Item]
    ) -> Generator[tuple[Item, Made], None, None]:
        """Yield every item with what the function makes of it, as it is done; a lost worker's items are done anew."""
        distributed = import_module("distributed")
        with _client(self.scheduler) as client:
            waiting = iter(enumerate(items))
            begun: dict[str, Item] = {}
            ready: SimpleQueue[Any] = SimpleQueue()
            there = partial(_by_the_same_program, program(), function)

            def give(most: int) -> None:
                # A few more than there are cores, so that none waits for its next one; all would fill the memory.
                for number, item in islice(waiting, max(0, most - len(begun))):
                    future = client.submit(there, item, pure=False, priority=-number)
                    begun[future.key] = item
                    future.add_done_callback(ready.put)

            give(self._ahead(client))
            while begun:
                future = self._next(ready, client)
                item = begun.pop(future.key)
                give(self._ahead(client))
                try:
                    made = future.result()
                except (distributed.KilledWorker, CancelledError) as error:
                    msg = f"{item}: the workers that were at it were lost, or the scheduler {self.scheduler} was"
                    raise ReplicateError(msg) from error
                yield item, made

    def _next(self, ready: SimpleQueue[Any], client: Any) -> Any:
        """Return the next task that is done; while there is no worker, none will be."""
        alone = 0.0
        while alone < ABSENCE:
            try:
                return ready.get(timeout=_LOOK)
            except Empty:
                alone = 0.0 if self._cores(client) else alone + _LOOK
        msg = f"the scheduler {self.scheduler} has had no worker for {ABSENCE} s: what ended them is in their logs"
        raise ReplicateError(msg)

    def _ahead(self, client: Any) -> int:
        """Return how many tasks may be under way."""
        return 2 * max(1, self._cores(client))

    def _cores(self, client: Any) -> int:
        try:
            return sum(client.ncores().values())
        except OSError as error:
            msg = f"the scheduler {self.scheduler} was lost"
            raise ReplicateError(msg) from error


def backend_of(name: str, scheduler: str | None, jobs: int | None) -> Backend:
    """Return the backend that options name.

    Raises
    ------
    ReplicateError
        As `cluster_of`.
    """
    return cluster_of(name, scheduler) or LocalProcesses(jobs or os.cpu_count() or 1)


def cluster_of(name: str, scheduler: str | None) -> DaskCluster | None:
    """Return the cluster that options name; ``None`` if they mean this machine.

    Raises
    ------
    ReplicateError
        If there is no backend of this name, or it lacks a scheduler or a package.
    """
    if name not in NAMES:
        msg = f"--backend must be {' or '.join(NAMES)}, not {name!r}"
        raise ReplicateError(msg)
    if name == LOCAL:
        if scheduler is not None:
            msg = "--scheduler belongs to --backend dask"
            raise ReplicateError(msg)
        return None
    if find_spec("distributed") is None:
        msg = "--backend dask needs Dask, which is not installed: pip install 'paper-replicate[cluster]'"
        raise ReplicateError(msg)
    if not scheduler:
        msg = "--backend dask needs the address of a scheduler: --scheduler tcp://HOST:8786"
        raise ReplicateError(msg)
    return DaskCluster(scheduler)


def worker_address() -> str:
    """Return the address of the cluster's worker that this is."""
    return str(import_module("distributed").get_worker().address)


def _numbered(function: Callable[[Item], Made], number: int, item: Item) -> tuple[int, Made]:
    return number, function(item)


def _end_with_parent(main: int) -> None:
    """Have this worker process end when the main process is killed: joblib's would wait for work for ever."""

    def watch() -> None:
        while os.getppid() == main:
            time.sleep(1.0)
        os._exit(1)

    if os.name == "posix":
        threading.Thread(target=watch, name="end with the main process", daemon=True).start()


def _by_the_same_program(here: Mapping[str, str], function: Callable[[Item], Made], item: Item) -> Made:
    """Apply a function in a worker of a cluster, if its program is the one that asks.

    Raises
    ------
    ReplicateError
        If it has other code, another Python or other libraries: its digits would be others.
    """
    why = difference(program(), here)
    if why:
        msg = f"the worker {worker_address()} has {why}:"
        msg += " every machine needs the same version of replicate, Python and the libraries"
        raise ReplicateError(msg)
    return function(item)


@contextmanager
def _client(scheduler: str) -> Iterator[Any]:
    """Yield a client of a scheduler that answers in time; what the library logs of lost connections is not shown."""
    distributed = import_module("distributed")
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        with ThreadPoolExecutor(1) as aside:  # a loop may be running here: that of a notebook, say
            aside.submit(asyncio.run, _greet(scheduler)).result()
        client = distributed.Client(scheduler, timeout=ANSWER, set_as_default=False)
    except Exception as error:  # whatever else listens there may say anything
        msg = f"no scheduler answers at {scheduler} within {ANSWER} s"
        raise ReplicateError(msg) from error
    with client:
        try:
            client.wait_for_workers(1, timeout=ANSWER)
        except TimeoutError as error:
            msg = f"the scheduler {scheduler} has no worker after {ANSWER} s: start one with 'dask worker {scheduler}'"
            raise ReplicateError(msg) from error
        yield client


async def _greet(scheduler: str) -> None:
    """Connect to a scheduler and leave again: a client waits for ever for one that takes calls and says nothing."""
    connect, security = import_module("distributed.comm").connect, import_module("distributed").Security()
    call = connect(scheduler, timeout=ANSWER, **security.get_connection_args("client"))
    (await asyncio.wait_for(call, ANSWER)).abort()
