"""Messages from a process whose code may write anything into its pipe: data, which are read without running anything.

Nobody waits for the rest of a message, and what is none is noticed: each begins with a byte that says of which kind it
is, and is read as that kind.
"""

from __future__ import annotations

import base64
import json
import os
import struct
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any

_CHUNK = 2**20
_LARGEST = 2**30  # bytes of a message
_LENGTH = struct.Struct("!i")  # as `Connection.send_bytes` writes it

#: What is said of code that has written into the pipe of its process.
WRITTEN = "it has written into the pipe of its process"


class NoMessageError(ValueError):
    """What has come through a pipe is no message."""


@dataclass
class Messages:
    """What `Connection.send_bytes` has sent through a pipe, read as it comes.

    Parameters
    ----------
    connection
        The near end.
    readers
        By the byte with which a message of a kind begins, what reads the rest of it.
    """

    connection: Connection
    readers: Mapping[bytes, Callable[[bytes], Any]]
    _begun: bytearray = field(default_factory=bytearray)

    def read(self) -> Iterator[tuple[bytes, Any]]:
        """Read what is there, and yield kind and content of the messages that are whole.

        To be called when the connection is ready.

        Raises
        ------
        NoMessageError
            If something else has come.
        EOFError
            If the far end has been closed.
        OSError
            If the near end has.
        """
        if sys.platform == "win32":
            yield self._content(self.connection.recv_bytes())
            return
        content = os.read(self.connection.fileno(), _CHUNK)
        if not content:
            raise EOFError
        self._begun += content
        while len(self._begun) > _LENGTH.size:
            (length,) = _LENGTH.unpack_from(self._begun)
            end = _LENGTH.size + length
            if not 0 < length <= _LARGEST or bytes(self._begun[_LENGTH.size : _LENGTH.size + 1]) not in self.readers:
                raise NoMessageError(WRITTEN)
            if len(self._begun) < end:
                return
            message = bytes(self._begun[_LENGTH.size : end])
            del self._begun[:end]
            yield self._content(message)

    def _content(self, message: bytes) -> tuple[bytes, Any]:
        kind = message[:1]
        try:
            return kind, self.readers[kind](message[1:])
        except Exception as error:
            raise NoMessageError(WRITTEN) from error


def packed(value: Any) -> bytes:
    """Return numbers, texts, bytes, and tuples of such, as JSON.

    Examples
    --------
    >>> unpacked(packed(("sheet.pdf", b"%PDF", 1)))
    ('sheet.pdf', b'%PDF', 1)
    """
    return json.dumps(value, default=lambda content: {"base64": base64.b64encode(content).decode("ascii")}).encode()


def unpacked(content: bytes) -> Any:
    """Return what was `packed`."""
    return _tuples(json.loads(content, object_hook=lambda given: base64.b64decode(given["base64"])))


def _tuples(value: Any) -> Any:
    return tuple(map(_tuples, value)) if isinstance(value, list) else value
