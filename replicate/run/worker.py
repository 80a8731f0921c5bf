"""A worker process: it does units, one at a time, and survives nothing that it need not survive.

Each worker has a pipe of its own to the main process, writes its output to a file of its own, and leads a group of
processes of its own, which ends as a whole. When the main process is gone, however it went, the worker ends at once.
"""

from __future__ import annotations

import contextlib
import faulthandler
import gc
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Collection
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from replicate.run.units import Unit, reason

if sys.platform == "linux":
    import fcntl

#: First byte of a message to the main process: a claim is begun, a unit is done, or it cannot even be begun.
BEGUN, DONE, FAILED = b"b", b"d", b"f"


@dataclass(frozen=True)
class Task:
    """A unit to do, and the claims in it to leave out."""

    unit: Unit
    without: Collection[str] = ()


@dataclass(frozen=True)
class Surroundings:
    """What a worker takes over from the main process."""

    folder: str
    environment: dict[str, str]
    output: Path


def serve(connection: Connection, surroundings: Surroundings) -> None:
    """Do tasks until the connection is closed; this is what runs in a worker process."""
    output = settled(surroundings)

    from replicate.run.performance import Performer

    performer = Performer()
    pid = os.getpid()
    try:
        while True:
            task: Task = connection.recv()
            output.begin()
            try:
                done = performer.perform(
                    task.unit, task.without, lambda claim: connection.send_bytes(BEGUN + claim.encode())
                )
                message, is_last = DONE + done.to_bytes(), done.is_last
            except BaseException as error:  # noqa: BLE001  -- an import that exits here and not in the main process
                message, is_last = FAILED + reason(error).encode(), True
            if os.getpid() != pid:
                os._exit(0)  # a child that the unit made: the parent reports
            output.end()
            connection.send_bytes(message)
            if is_last:
                break
    except (EOFError, BrokenPipeError):
        pass
    os._exit(0)  # without waiting for threads of a unit, and without code that a paper has registered for the end


def settled(surroundings: Surroundings) -> Output:
    """Make this process a worker: alone, in the surroundings of the main process, its output in a file."""
    _stand_alone()
    os.environ.clear()
    os.environ.update(surroundings.environment)
    with contextlib.suppress(OSError):
        os.chdir(surroundings.folder)
    output = Output(surroundings.output)
    try:
        output.begin()
    except FileNotFoundError:  # the main process has ended meanwhile, and taken its folder with it
        os._exit(0)

    from replicate.run.isolation import isolate_matplotlib

    isolate_matplotlib()
    gc.freeze()  # what comes from the process that workers are forked from stays
    gc.set_threshold(5000)  # a drawing makes many more objects than Python's 700 and throws nearly all away at once
    return output


def _stand_alone() -> None:
    """Leave the terminal's group, so that Ctrl-C is the main process' business; end with the main process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    with contextlib.suppress(OSError, AttributeError):
        os.setsid()
    with contextlib.suppress(ImportError, OSError, ValueError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    main = multiprocessing.parent_process()
    if main is not None:
        _end_with_pipe(main.sentinel)
        threading.Thread(target=_end_with, args=(main,), name="end with the main process", daemon=True).start()


def _end_with_pipe(sentinel: int) -> None:
    """Have the kernel end this group of processes when the main process is gone: also while a unit keeps the lock."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            fcntl.fcntl(sentinel, fcntl.F_SETOWN, -os.getpgrp())
            fcntl.fcntl(sentinel, fcntl.F_SETSIG, signal.SIGKILL)
            fcntl.fcntl(sentinel, fcntl.F_SETFL, fcntl.fcntl(sentinel, fcntl.F_GETFL) | fcntl.FASYNC)


def _end_with(main: multiprocessing.process.BaseProcess) -> None:
    main.join()
    if hasattr(os, "killpg"):
        os.killpg(0, signal.SIGKILL)  # with everything that units have started
    os._exit(1)


class Output:
    """Sends what units write, by Python or below it, to a file; each unit has new streams."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def begin(self) -> None:
        """Begin an empty file; faults are reported in it, too."""
        nothing = os.open(os.devnull, os.O_RDONLY)
        there = os.open(self._path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o600)
        for source, target in ((nothing, 0), (there, 1), (there, 2)):
            os.dup2(source, target)
        for source in (nothing, there):
            if source > 2:
                os.close(source)
        sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115  -- for as long as the process
        sys.stdout = open(1, "w", encoding="utf-8", errors="replace", closefd=False)  # noqa: SIM115
        sys.stderr = open(2, "w", encoding="utf-8", errors="replace", closefd=False)  # noqa: SIM115
        faulthandler.enable(2)

    def end(self) -> None:
        """Write what is still to be written."""
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(Exception):  # closed by the unit, or replaced by something else
                stream.flush()
