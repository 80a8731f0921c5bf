"""Messages of a process are read as they come; what code of a paper writes into its pipe holds nobody up."""

from __future__ import annotations

import os
import sys
from multiprocessing import Pipe

import pytest

from replicate.run.messages import Messages

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="pipes of POSIX are streams of bytes")
SENT = [b"", b"x", b"claim", bytes(range(256)) * 100, b"last"]


def test_what_was_sent_arrives_in_order() -> None:
    here, there = Pipe()
    for content in SENT:
        there.send_bytes(content)
    there.close()
    messages = Messages(here)
    assert list(messages.read()) == SENT
    with pytest.raises(EOFError):
        list(messages.read())


@pytest.mark.parametrize("piece", [1, 3, 4096])
def test_a_message_may_come_in_pieces(piece: int) -> None:
    here, there = Pipe()
    sent, received = Pipe()
    for content in SENT[:3]:
        sent.send_bytes(content)
    stream = os.read(received.fileno(), 2**16)
    messages = Messages(here)
    found: list[bytes] = []
    for start in range(0, len(stream), piece):
        os.write(there.fileno(), stream[start : start + piece])
        found += messages.read()
    assert found == SENT[:3]


@pytest.mark.parametrize("garbage", [b"\0", b"garbage" * 10, b"\xff" * 12, b"\x80\0\0\0rest", b"\xff\xff\xff\xff\0"])
def test_nobody_waits_for_the_rest_of_garbage(garbage: bytes) -> None:
    here, there = Pipe()
    os.write(there.fileno(), garbage)
    messages = Messages(here)
    assert list(messages.read()) == []
    os.write(there.fileno(), b"more")
    assert list(messages.read()) == []
