"""Messages from a process whose code may write anything into its pipe: nobody waits for the rest of one."""

from __future__ import annotations

import os
import struct
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import Connection

_CHUNK = 2**20
_LENGTH, _LONG = struct.Struct("!i"), struct.Struct("!Q")  # as `Connection.send_bytes` writes them


@dataclass
class Messages:
    """What `Connection.send_bytes` has sent through a pipe, read as it comes.

    Parameters
    ----------
    connection
        The near end.
    """

    connection: Connection
    _begun: bytearray = field(default_factory=bytearray)

    def read(self) -> Iterator[bytes]:
        """Read what is there, and yield the messages that are whole; to be called when the connection is ready.

        Raises
        ------
        EOFError
            If the far end has been closed.
        OSError
            If the near end has.
        """
        if sys.platform == "win32":
            yield self.connection.recv_bytes()
            return
        content = os.read(self.connection.fileno(), _CHUNK)
        if not content:
            raise EOFError
        self._begun += content
        while (found := self._whole()) is not None:
            yield found

    def _whole(self) -> bytes | None:
        """Take a message from what has been read, if all of it has."""
        if len(self._begun) < _LENGTH.size:
            return None
        start = _LENGTH.size
        (length,) = _LENGTH.unpack_from(self._begun)
        if length == -1:  # a long one
            start += _LONG.size
            if len(self._begun) < start:
                return None
            (length,) = _LONG.unpack_from(self._begun, _LENGTH.size)
        if length < 0 or len(self._begun) < start + length:
            return None
        message = bytes(self._begun[start : start + length])
        del self._begun[: start + length]
        return message
