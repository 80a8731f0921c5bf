"""Starts worker processes: quickly, in the same surroundings as the main process, and also from several threads."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Collection, Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from types import ModuleType
from typing import Any

from replicate.errors import ReplicateError
from replicate.run.worker import Surroundings

#: What a worker that draws will import.
DRAWING = ("matplotlib.figure", "matplotlib.backends.backend_agg", "matplotlib.backends.backend_svg")
_HEAVY = (
    *("numpy", "pandas", "scipy.integrate", "scipy.interpolate", "scipy.linalg", "scipy.optimize"),
    *("control", "schemdraw", "replicate.loops"),
    *DRAWING,
)
_ATTEMPTS, _BETWEEN_ATTEMPTS = 4, 0.1  # seconds
_STARTING = threading.Lock()  # what is changed for a start and put back after it belongs to all threads
_LONGEST_FOLDER = 70  # bytes: of the 103 that the path of a socket may have everywhere, its name takes 32
_SHORT_FOLDERS = ("/tmp", "/var/tmp", "/usr/tmp")  # noqa: S108  -- a folder of this user's is made in it


def started(
    service: Callable[[Connection, Surroundings], None], output: Path, imported: Collection[str] = ()
) -> tuple[Any, Connection]:
    """Start a worker process and return it with the near end of its pipe.

    Parameters
    ----------
    service
        Is called there with the far end.
    output
        A file for what it writes.
    imported
        Modules that workers will want: the first worker says which of them all workers share.

    Raises
    ------
    ReplicateError
        If none can be started.
    """
    method = "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else "spawn"
    context: Any = multiprocessing.get_context(method)
    here, there = context.Pipe(duplex=True)
    with _STARTING:
        surroundings = Surroundings(_folder(), dict(os.environ), output)
    attempts = _ATTEMPTS
    while True:
        attempts -= 1
        process = context.Process(target=service, args=(there, surroundings), name="replicate worker")
        try:
            with _STARTING:
                if method == "forkserver":
                    _start_server(imported)
                with _without_program():
                    process.start()
        except (OSError, EOFError) as error:
            if not attempts:
                msg = f"a worker process cannot be started: {str(error) or type(error).__name__}"
                raise ReplicateError(msg) from error
            time.sleep(_BETWEEN_ATTEMPTS)  # a unit may have killed the process that starts them
        else:
            there.close()
            return process, here


def _start_server(imported: Collection[str]) -> None:
    """Start the process that workers are forked from, if there is none: with what this process has imported, too."""
    from multiprocessing import forkserver  # Windows has none

    _choose_folder_of_sockets()
    shared = [name for name in _HEAVY if name in sys.modules or name in imported]
    forkserver.set_forkserver_preload([f"{__package__}.preload", *shared])
    before = os.environ.get("PYTHONSAFEPATH")
    os.environ["PYTHONSAFEPATH"] = "1"  # a numpy.py of the user's in the current folder is not numpy
    try:
        forkserver.ensure_running()
    finally:
        if before is None:
            del os.environ["PYTHONSAFEPATH"]
        else:
            os.environ["PYTHONSAFEPATH"] = before


def _choose_folder_of_sockets() -> None:
    """Have the standard library keep its sockets where their paths are short enough, as later versions do."""
    from multiprocessing import util

    before = tempfile.gettempdir()
    if len(os.fsencode(before)) > _LONGEST_FOLDER:
        tempfile.tempdir = next((place for place in _SHORT_FOLDERS if os.access(place, os.W_OK | os.X_OK)), before)
    try:
        util.get_temp_dir()
    finally:
        tempfile.tempdir = before


@contextlib.contextmanager
def _without_program() -> Iterator[None]:
    """Start processes that do not import the program that starts them: no unit needs it, and none depends on it."""
    program = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = program


def _folder() -> str:
    try:
        return str(Path.cwd())
    except FileNotFoundError as error:
        msg = "the current folder has been removed"
        raise ReplicateError(msg) from error
