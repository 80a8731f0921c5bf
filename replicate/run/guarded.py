"""A process for code of others: what does not end there is stopped, also inside C code, and its line is known.

A fault handler, which needs no interpreter, ends the process when the time of what is `watched` is up, and writes where
it was. What a function yields in the process is yielded here at once.
"""

from __future__ import annotations

import contextlib
import faulthandler
import os
import signal
import tempfile
import time
import traceback
from collections.abc import Callable, Iterable, Iterator
from dataclasses import astuple, dataclass, field
from multiprocessing.connection import Connection, wait
from pathlib import Path
from types import TracebackType
from typing import Any

from replicate.errors import ReplicateError
from replicate.run.fault_reports import frames
from replicate.run.limits import MOST_OUTPUT
from replicate.run.messages import WRITTEN, Messages, NoMessageError, packed, unpacked
from replicate.run.starting import started
from replicate.run.worker import Surroundings, settled

_OVERDUE, _FAULT = "Timeout (", "Fatal Python error"  # what the fault handler writes first
_PATIENCE = 5.0  # seconds after which a process is ended whose fault handler is gone
_TICK = 0.5
_AT, _ITEM, _END = b"p", b"i", b"e"  # kinds of messages: what it is at, what a function yields, that it has ended


@dataclass(frozen=True)
class Place:
    """What a process is at.

    Attributes
    ----------
    file
        The code's file, as its frames name it.
    source
        What messages call it.
    what
        Which part of it.
    line
        Where that part begins.
    """

    file: str
    source: str
    what: str
    line: int = 1


_NOWHERE = Place("", "", "")  # in nothing that is watched


@dataclass(frozen=True)
class _End:
    """A function has ended, or failed: with the text for the user, and the traceback."""

    error: str = ""
    trace: str = ""


_READERS: dict[bytes, Callable[[bytes], Any]] = {
    _AT: lambda content: Place(*unpacked(content)),
    _ITEM: unpacked,
    _END: lambda content: _End(*unpacked(content)),
}


class GuardedProcess:
    """Runs functions in a process of their own, which starts with the first and ends with the ``with`` block.

    Parameters
    ----------
    seconds
        That what is `watched` may take.
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._process: Any = None
        self._messages: Messages
        self._folder = tempfile.TemporaryDirectory(prefix="replicate-", ignore_cleanup_errors=True)
        self._output = Path(self._folder.name) / "output"

    def __enter__(self) -> GuardedProcess:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._end()
        self._folder.cleanup()

    def stream(self, function: Callable[..., Iterable[Any]], *arguments: Any) -> Iterator[Any]:
        """Yield what a function of a module yields, or `tell`s, there: numbers, texts, bytes and tuples of them.

        Raises
        ------
        ReplicateError
            If it raises one, or something that is watched does not end in time, ends the process or writes into its
            pipe.
        """
        if self._process is None:
            self._process, connection = started(_serve, self._output)
            self._messages = Messages(connection, _READERS)
        self._at(_NOWHERE)
        with contextlib.suppress(OSError):  # the process is gone: noticed below
            self._messages.connection.send((function, arguments, self._seconds))
        while True:
            for kind, content in self._received():
                if kind == _ITEM:
                    yield content
                elif kind == _AT:
                    self._at(content)
                elif content.error:
                    raise _error(content)
                else:
                    return

    def _at(self, place: Place) -> None:
        self._place, self._since = place, time.monotonic()

    def _received(self) -> Iterator[tuple[bytes, Any]]:
        """Wait a moment for messages and yield them; what was sent before the process ended is still there."""
        ready = wait([self._messages.connection, self._process.sentinel], _TICK)
        if not ready:
            self._check()
            return
        try:
            if self._messages.connection in ready:
                yield from self._messages.read()
                return
        except NoMessageError:
            why = f"fails: {WRITTEN}"
            raise self._lost(why) from None
        except (OSError, EOFError):
            pass
        raise self._lost()

    def _check(self) -> None:
        """End a process whose fault handler does not, or which fills the disk."""
        if self._place != _NOWHERE and time.monotonic() - self._since > self._seconds + _PATIENCE:
            raise self._lost(self._too_long)
        if self._output.exists() and self._output.stat().st_size > MOST_OUTPUT:
            why = f"has written more than {MOST_OUTPUT // 2**20} MB of output"
            raise self._lost(why)

    @property
    def _too_long(self) -> str:
        return f"did not end within {self._seconds:g} s"

    def _lost(self, why: str = "") -> ReplicateError:
        """Say where the process was when it was ended, or ended itself; the next function gets another one."""
        place = self._place
        if self._process.is_alive() and why:
            with contextlib.suppress(OSError):
                os.kill(self._process.pid, signal.SIGABRT)  # its fault handler writes where it is
        self._process.join(_PATIENCE)
        status = self._process.exitcode
        self._end()
        with self._output.open("rb") as file:
            file.seek(max(0, self._output.stat().st_size - 2**20))
            output = file.read().decode(errors="replace")
        why = why or (self._too_long if _OVERDUE in output else _ended(status))
        if place == _NOWHERE:
            return ReplicateError(f"a process of this run {why}")
        report = output.rpartition(_OVERDUE if _OVERDUE in output else _FAULT)[2]
        lines = [line for file, line in frames(report) if file == place.file]
        stopped = "; it was stopped in this line" if lines and why == self._too_long else ""
        return ReplicateError(f"{place.source}:{lines[0] if lines else place.line}: {place.what} {why}{stopped}")

    def _end(self) -> None:
        if self._process is None:
            return
        self._messages.connection.close()
        with contextlib.suppress(OSError):
            if hasattr(os, "killpg"):
                os.killpg(self._process.pid, signal.SIGKILL)  # with everything that it has started
        self._process.kill()
        self._process.join()
        self._process = None


def _ended(status: int | None) -> str:
    if status is not None and status < 0 and -status in set(signal.Signals):
        hint = "; perhaps for want of memory" if -status == signal.SIGKILL else ""
        return f"fails: it has ended its process ({signal.Signals(-status).name}){hint}"
    return "fails: it has ended its process"


def _error(end: _End) -> ReplicateError:
    error = ReplicateError(end.error)
    error.add_note(end.trace)
    return error


@dataclass
class _Watch:
    """How a guarded process is watched over."""

    connection: Connection
    seconds: float
    busy: bool = False
    pid: int = field(default_factory=os.getpid)

    def send(self, kind: bytes, value: Any) -> None:
        self.connection.send_bytes(kind + packed(value))


_watch: _Watch | None = None  # in a process that is guarded


@contextlib.contextmanager
def watched(place: Place) -> Iterator[None]:
    """Have a guarded process ended if what is inside the ``with`` block does not end in time; the outermost counts."""
    watch = _watch
    if watch is None or watch.busy:
        yield
        return
    watch.busy = True
    watch.send(_AT, astuple(place))
    faulthandler.dump_traceback_later(watch.seconds, exit=True, file=2)
    try:
        yield
    finally:
        if os.getpid() != watch.pid:
            os._exit(0)  # a child that the code made: the parent reports
        faulthandler.cancel_dump_traceback_later()
        watch.send(_AT, astuple(_NOWHERE))
        watch.busy = False


def tell(value: Any) -> None:
    """Have a value yielded by the `stream` that this guarded process works for; elsewhere nothing."""
    if _watch is not None:
        _watch.send(_ITEM, value)


def _serve(connection: Connection, surroundings: Surroundings) -> None:
    """Run functions until the connection is closed."""
    global _watch  # noqa: PLW0603  -- one process, one watch
    settled(surroundings)
    tempfile.tempdir = str(surroundings.output.parent)  # which is removed, however this process ends
    with contextlib.suppress(EOFError, OSError):
        while True:
            function, arguments, seconds = connection.recv()
            _watch = _Watch(connection, seconds)
            _watch.send(_END, astuple(_run(function, arguments)))
    os._exit(0)


def _run(function: Callable[..., Iterable[Any]], arguments: tuple[Any, ...]) -> _End:
    try:
        for value in function(*arguments):
            tell(value)
    except ReplicateError as error:
        return _End(str(error), traceback.format_exc())
    except OSError as error:  # say a full disk, or one for temporary files
        place = f"{error.filename}: " if error.filename else ""
        return _End(f"a process of this run cannot go on: {place}{error.strerror or error}", traceback.format_exc())
    except Exception as error:  # noqa: BLE001  -- whatever it is, it is reported
        return _End(f"unexpected {type(error).__name__}: {error} (--debug shows where)", traceback.format_exc())
    return _End()
