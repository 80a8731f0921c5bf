"""A limit on the time of code that has to run in this process: what a paper's modules do while they are imported."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_AGAIN = 1.0  # seconds after which code that catches the alarm has it again


class OverdueError(BaseException):
    """The time is up; no `Exception`, so that code which catches those does not go on."""


@contextmanager
def alarmed(seconds: float) -> Iterator[None]:
    """Raise `OverdueError` inside the ``with`` block when its time is up, where the system has such alarms.

    One call of C code that never looks at signals is not interrupted.
    """
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return

    def late(*_: object) -> None:
        msg = f"it did not end within {seconds:g} s"
        raise OverdueError(msg)

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, seconds, _AGAIN)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
