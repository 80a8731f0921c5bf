"""Standard output that cannot take everything: a full disk is one line, a closed pipe none, neither is a success."""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, TextIO

import typer

from replicate.plain_text import visible

if TYPE_CHECKING:
    from typing_extensions import Buffer


@contextmanager
def whole_output(broken: int) -> Iterator[None]:
    """Let the block end the program, with the status `broken` instead of its own if its output was not written."""
    _open_closed_streams()
    stdout = sys.stdout = _remembering(sys.stdout)
    try:
        yield
    except SystemExit:
        why = lost_output(stdout)
        if why is None:
            raise
        _silence(stdout)
        if why.errno != errno.EPIPE:  # who closes a pipe has read enough
            say(f"replicate: standard output: cannot be written: {why.strerror or why}")
        raise SystemExit(broken) from None


def lost_output(stream: TextIO) -> OSError | None:
    """Return why a stream could not take what was printed, ``None`` if it did."""
    try:
        stream.flush()
    except OSError as error:
        return error
    except ValueError:  # it is closed
        pass
    raw = _raw(stream)
    return raw.error if isinstance(raw, _Remembering) else None


class _Remembering(io.FileIO):
    """A file that remembers what could not be written to it: what prints may have caught the error."""

    error: OSError | None = None

    def write(self, data: Buffer, /) -> int:
        try:
            return super().write(data) or 0
        except OSError as error:
            self.error = error
            raise


def _raw(stream: TextIO) -> object:
    """Return the file below a stream; with ``python -u`` there is nothing between the two."""
    buffer = getattr(stream, "buffer", None)
    return getattr(buffer, "raw", buffer)


def _remembering(stream: TextIO) -> TextIO:
    """Return a stream that writes to the same file and remembers; one that is not a file stays as it is."""
    if not isinstance(stream, io.TextIOWrapper) or not isinstance(_raw(stream), io.FileIO):
        return stream
    stream.flush()
    raw = _Remembering(stream.fileno(), "w", closefd=False)
    at_once = stream.write_through or stream.line_buffering
    return io.TextIOWrapper(
        io.BufferedWriter(raw), stream.encoding, "replace", line_buffering=at_once, write_through=stream.write_through
    )


def say(line: str) -> None:
    """Print on standard error if that is possible."""
    with suppress(OSError):
        print(visible(line), file=sys.stderr, flush=True)  # noqa: T201  -- the error is the output


def echo(text: str, *, err: bool = False) -> None:
    """Print a text, with characters that would steer the terminal written out."""
    typer.echo(visible(text), err=err)


def _open_closed_streams() -> None:
    """Point streams that the caller has closed at nothing: else the next file that is opened would take their place."""
    if sys.stdin is None or sys.stdout is None or sys.stderr is None:
        while (descriptor := os.open(os.devnull, os.O_RDWR)) < 3:
            os.set_inheritable(descriptor, True)  # else they are closed again in the process that workers come from
        os.close(descriptor)
    if sys.stdout is None:
        sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115  -- for as long as the process
    if sys.stderr is None:
        sys.stderr = open(2, "w", encoding="utf-8", closefd=False)  # noqa: SIM115


def _silence(stream: TextIO) -> None:
    """Throw away what is left in a stream, which Python would try to write once more at the end."""
    with suppress(OSError, ValueError):
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, stream.fileno())
        os.close(nothing)
        stream.flush()
