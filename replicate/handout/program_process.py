"""A process in which the programs of a handout run: one that does not end is stopped, also inside C code, and named.

The programs share their names, as the cells of a notebook do. A fault handler, which needs no interpreter, ends the
process when the time of a program is up and writes where it was.
"""

from __future__ import annotations

import contextlib
import faulthandler
import io
import os
import re
import signal
import tempfile
import traceback
from contextlib import redirect_stdout
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from pathlib import Path
from types import TracebackType
from typing import Any

from replicate.errors import ReplicateError
from replicate.run.pool import started
from replicate.run.worker import Surroundings, settled

_NAME = "<program>"
_FRAME = re.compile(rf'File "{_NAME}", line (\d+) in ')
_TIMEOUT = "Timeout ("  # what the fault handler writes first
_PATIENCE = 5.0  # seconds after which a process is ended whose fault handler is gone


@dataclass(frozen=True)
class Written:
    """What a program wrote."""

    text: str


class ProgramError(ReplicateError):
    """A program of a handout that failed; its message says how.

    Parameters
    ----------
    line
        Of the program, from 1.
    """

    def __init__(self, line: int, why: str) -> None:
        super().__init__(why)
        self.line = line


@dataclass(frozen=True)
class _Failed:
    line: int
    why: str


class ProgramProcess:
    """Runs programs in a process of their own, which starts with the first and ends with the ``with`` block."""

    def __init__(self) -> None:
        self._process: Any = None
        self._connection: Connection
        self._folder = tempfile.TemporaryDirectory(prefix="replicate-", ignore_cleanup_errors=True)
        self._output = Path(self._folder.name) / "output"

    def __enter__(self) -> ProgramProcess:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, place: TracebackType | None
    ) -> None:
        if self._process is not None:
            self._connection.close()
            with contextlib.suppress(OSError):
                if hasattr(os, "killpg"):
                    os.killpg(self._process.pid, signal.SIGKILL)  # with everything that a program has started
            self._process.kill()
            self._process.join()
        self._folder.cleanup()

    def run(self, program: str, seconds: float) -> str:
        """Return what a program writes.

        Parameters
        ----------
        seconds
            After which it is stopped.

        Raises
        ------
        ProgramError
            If it fails, does not end in time, or ends the process.
        """
        if self._process is None:
            self._process, self._connection = started(_serve, self._output)
        answer: Written | _Failed | None = None
        ended = True
        with contextlib.suppress(OSError, EOFError):  # the process is gone: what it was at is in its output
            self._connection.send((program, seconds))
            ready = wait([self._connection, self._process.sentinel], seconds + _PATIENCE)
            ended = bool(ready)
            answer = self._connection.recv() if self._connection in ready else None
        if isinstance(answer, Written):
            return answer.text
        if isinstance(answer, _Failed):
            raise ProgramError(answer.line, answer.why)
        raise self._lost(seconds, ended=ended)

    def _lost(self, seconds: float, *, ended: bool) -> ProgramError:
        """Say where the program was when its process was ended, or ended itself."""
        output = self._output.read_text(encoding="utf-8", errors="replace")
        report = output.rpartition(_TIMEOUT)[2] if _TIMEOUT in output else output.partition("Fatal Python error")[2]
        frame = _FRAME.search(report)
        if _TIMEOUT in output or not ended:
            why = f"the program did not end within {seconds:g} s"
            return ProgramError(int(frame[1]), f"{why}; it was stopped in this line") if frame else ProgramError(1, why)
        return ProgramError(int(frame[1]) if frame else 1, "the program fails: it has ended its process")


def _serve(connection: Connection, surroundings: Surroundings) -> None:
    """Run programs until the connection is closed."""
    settled(surroundings)
    names: dict[str, Any] = {"__name__": "handout"}
    with contextlib.suppress(EOFError, OSError):
        while True:
            program, seconds = connection.recv()
            faulthandler.dump_traceback_later(seconds, exit=True, file=2)
            answer = _answer(program, names)
            faulthandler.cancel_dump_traceback_later()
            connection.send(answer)
    os._exit(0)


def _answer(program: str, names: dict[str, Any]) -> Written | _Failed:
    written = io.StringIO()
    try:
        with redirect_stdout(written):
            exec(compile(program, _NAME, "exec"), names)  # noqa: S102  -- the paper's own text
    except (Exception, SystemExit, KeyboardInterrupt) as error:  # noqa: BLE001  -- whatever it is, it is reported
        inside = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == _NAME]
        line = (inside[-1].lineno if inside else getattr(error, "lineno", 1)) or 1
        return _Failed(line, f"the program fails: {type(error).__name__}: {error}")
    return Written(written.getvalue())
