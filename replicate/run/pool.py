"""A pool of worker processes in which a worker that dies takes nothing with it but the unit that it was at.

Each worker has a pipe of its own. In the pools of the standard library, joblib and pebble all workers share one: there,
one that is killed while it sends its result leaves the others and the main process waiting for the rest.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Collection, Generator, Iterator, Mapping
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from replicate.exhibits import Claims, Exhibit, Figure
from replicate.exhibits.file_names import display_name
from replicate.run.fault_reports import frames
from replicate.run.limits import MOST_OUTPUT
from replicate.run.messages import WRITTEN, Messages, NoMessageError
from replicate.run.performance import Performance, with_errors
from replicate.run.starting import DRAWING, started
from replicate.run.units import Unit, failed
from replicate.run.waiting import Waiting
from replicate.run.worker import BEGUN, DONE, FAILED, Task, serve

_TICK = 0.5
_PATIENCE = 2.0  # seconds in which a worker that is stopped may say where it was
_SHOWN_OUTPUT = 20_000
_UNKNOWN = 255  # the process that watches over the workers is gone, too
_READERS: dict[bytes, Callable[[bytes], Any]] = {
    BEGUN: bytes.decode,
    DONE: Performance.from_bytes,
    FAILED: bytes.decode,
}


@dataclass
class _Worker:
    process: Any
    messages: Messages
    output: Path
    task: Task | None = None
    folders: list[str] = field(default_factory=list)  # whose units it has done, the latest last
    begun: float = 0.0
    claim: str = ""
    failed: str = ""

    @property
    def connection(self) -> Connection:
        """The near end of its pipe."""
        return self.messages.connection


@dataclass
class LocalPool:
    """Does units in processes on this machine.

    Parameters
    ----------
    jobs
        Number of processes.
    unit_timeout
        Seconds after which a unit is stopped.
    """

    jobs: int
    unit_timeout: float
    _errors: dict[Unit, dict[str, str]] = field(default_factory=dict)

    def run(self, units: Mapping[Unit, Exhibit]) -> Generator[tuple[Unit, Performance], None, None]:
        """Yield units as they are done; those of one folder of code are begun in the given order.

        Raises
        ------
        ReplicateError
            If no worker can be started.
        """
        waiting = Waiting(units)
        imported = DRAWING if any(isinstance(exhibit, Figure) for exhibit in units.values()) else ()
        workers: list[_Worker] = []
        with tempfile.TemporaryDirectory(prefix="replicate-", ignore_cleanup_errors=True) as folder:
            started = 0
            try:
                while waiting or any(worker.task for worker in workers):
                    workers[:] = [worker for worker in workers if worker.task or worker.process.is_alive()]
                    while len(workers) < self.jobs and sum(not worker.task for worker in workers) < len(waiting):
                        workers.append(_start(Path(folder) / f"output-{started}", imported))
                        started += 1
                    for worker in workers:
                        if worker.task is None and waiting:
                            taken = {other.folders[-1] for other in workers if other is not worker and other.folders}
                            task = waiting.take(worker.folders, taken)
                            worker.folders.append(waiting.folder(task))
                            self._give(worker, task)
                    yield from self._harvest(workers, waiting, units)
            finally:
                for worker in workers:
                    _kill(worker)

    def _give(self, worker: _Worker, task: Task) -> None:
        worker.task, worker.begun, worker.claim = task, time.monotonic(), ""
        with contextlib.suppress(OSError):  # it has died this moment: noticed below
            worker.connection.send(task)

    def _harvest(
        self, workers: list[_Worker], waiting: Waiting, units: Mapping[Unit, Exhibit]
    ) -> Iterator[tuple[Unit, Performance]]:
        ready = wait([entry for worker in workers for entry in _signs(worker)], _TICK)
        for worker in list(workers):
            task = worker.task
            if task is None:
                continue
            done, gone = None, False
            if worker.connection in ready:
                done, gone = _received(worker)
            elif worker.process.sentinel in ready:
                gone = not _orphaned(worker)
            why = (worker.failed or _left(worker)) if gone else "" if done else self._overdue(worker)
            if done is not None:
                worker.task = None
                yield task.unit, self._finished(task.unit, done)
            if gone or why or (done is not None and done.is_last):
                workers.remove(worker)
                place = _kill(worker)
                if done is None:
                    yield from self._lost(worker, task, f"{why}{place}", units[task.unit], waiting)

    def _overdue(self, worker: _Worker) -> str:
        if time.monotonic() - worker.begun > self.unit_timeout:
            return f"stopped after {self.unit_timeout:g} s (--unit-timeout allows more)"
        if _size(worker.output) > MOST_OUTPUT:
            return f"stopped because it has written more than {MOST_OUTPUT // 2**20} MB of output"
        return ""

    def _finished(self, unit: Unit, done: Performance) -> Performance:
        errors = self._errors.pop(unit, {})
        return replace(done, result=with_errors(done.result, errors), text="") if errors else done

    def _lost(
        self, worker: _Worker, task: Task, why: str, exhibit: Exhibit, waiting: Waiting
    ) -> Iterator[tuple[Unit, Performance]]:
        """Report a unit that has ended its worker; of claims only the one it was at, and the others are tried again."""
        if isinstance(exhibit, Claims) and worker.claim:
            self._errors.setdefault(task.unit, {})[worker.claim] = why
            waiting.put_back(Task(task.unit, (*task.without, worker.claim)))
            return
        seconds = time.monotonic() - worker.begun
        lost = Performance(failed(task.unit, exhibit, why), {}, seconds, output=_output(worker))
        yield task.unit, self._finished(task.unit, lost)


def _signs(worker: _Worker) -> list[Any]:
    """Return what tells that a worker has sent something, or has gone."""
    return [worker.connection] if _orphaned(worker) else [worker.connection, worker.process.sentinel]


def _orphaned(worker: _Worker) -> bool:
    """Whether the process that watches over workers has gone: all seem to have, then, and only the pipes know."""
    return bool(worker.process.exitcode == _UNKNOWN)


def _start(output: Path, imported: Collection[str]) -> _Worker:
    process, here = started(serve, output, imported)
    return _Worker(process, Messages(here, _READERS), output)


def _received(worker: _Worker) -> tuple[Performance | None, bool]:
    """Return what a worker has sent if it is a result, and whether the worker is lost."""
    try:
        for kind, content in worker.messages.read():
            if kind == FAILED:
                worker.failed = content
                return None, True
            if kind == DONE:
                return replace(content, output=_output(worker)), False
            worker.claim, worker.begun = content, time.monotonic()  # each has the whole time
    except NoMessageError:
        worker.failed = WRITTEN
        return None, True
    except (OSError, EOFError):  # it has gone
        return None, True
    return None, False


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _output(worker: _Worker) -> str:
    """Return the end of what a unit has written."""
    try:
        with worker.output.open("rb") as file:
            file.seek(max(0, _size(worker.output) - _SHOWN_OUTPUT))
            return file.read().decode(errors="replace")
    except OSError:
        return ""


def _kill(worker: _Worker) -> str:
    """End a worker and all that it has started; return where it was, as `` (file:line)``, if it says so."""
    worker.connection.close()
    pid = worker.process.pid
    place = ""
    if worker.task is not None and not worker.failed:
        if worker.process.is_alive():
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGABRT)  # its fault handler writes where it is, and it ends
            wait([worker.process.sentinel], _PATIENCE)
        place = _place(_output(worker))
    with contextlib.suppress(OSError):
        if hasattr(os, "killpg"):
            os.killpg(pid, signal.SIGKILL)
    if worker.process.is_alive():
        worker.process.kill()
    worker.process.join(_PATIENCE)
    return place


def _place(output: str) -> str:
    """Return the innermost line of a fault handler's report that is not in a library or here."""
    report = output.partition("Fatal Python error")[2]
    for file, line in frames(report.partition("Current thread")[2] or report):
        if "site-packages" not in file and not file.startswith((sys.base_prefix, "<", str(Path(__file__).parent))):
            return f" ({display_name(Path(file))}:{line})"
    return ""


def _left(worker: _Worker) -> str:
    """Say how a worker has gone that nobody has ended."""
    wait([worker.process.sentinel], _PATIENCE)
    code = worker.process.exitcode
    if code is None:
        return "it has closed the pipe of its worker process"
    if code >= 0:
        return f"it has ended its worker process{'' if code == _UNKNOWN else f' with status {code}'}"
    name = signal.Signals(-code).name if -code in set(signal.Signals) else f"signal {-code}"
    hint = "; perhaps for want of memory: try fewer --jobs" if -code == signal.SIGKILL else ""
    return f"its worker process was ended by {name}{hint}"
