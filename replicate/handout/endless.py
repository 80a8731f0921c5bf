"""Stop a program of a handout that does not end, wherever it is in its own code."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Iterator
from contextlib import contextmanager


class TimeIsUp(BaseException):
    """Raised inside a program that takes too long; no `Exception`, so that the program does not catch it in passing."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise `TimeIsUp` in the code of the block if it takes longer; a single call of C code is not interrupted."""
    thread = threading.get_ident()
    over = threading.Event()

    def watch() -> None:
        if not over.wait(seconds):
            # Asynchronous, in the thread that runs the program: there it appears between two steps of Python.
            ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(TimeIsUp))

    watcher = threading.Thread(target=watch, name="time limit", daemon=True)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        watcher.join()
