"""A limit on the time of code that has to run in this process: what a paper's modules do while they are imported."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

_TICK = 1.0  # seconds; code that catches the alarm has it again
_BUSY = 5.0  # times as long where the processor is busy with others, or the code waits


class OverdueError(BaseException):
    """The time is up; no `Exception`, so that code which catches those does not go on."""


@contextmanager
def alarmed(seconds: float) -> Iterator[None]:
    """Raise `OverdueError` inside the ``with`` block when its time is up, where the system has such alarms.

    Seconds are those of the processor, or five times as many of the clock.
    One call of C code that never looks at signals is not interrupted.
    """
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return

    begun, used = time.monotonic(), time.process_time()

    def late(*_: object) -> None:
        if time.process_time() - used > seconds or time.monotonic() - begun > _BUSY * seconds:
            msg = f"it did not end within {seconds:g} s"
            raise OverdueError(msg)

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, min(seconds, _TICK), _TICK)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
