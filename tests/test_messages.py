"""Messages of a process are read as they come; what code of a paper writes into its pipe holds nobody up."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from multiprocessing import Pipe

import pytest
from hypothesis import given
from hypothesis import strategies as st

from replicate.run.messages import Messages, NoMessageError, packed, unpacked

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="pipes of POSIX are streams of bytes")
READERS: dict[bytes, Callable[[bytes], object]] = {b"t": bytes.decode, b"n": int}
SENT = [(b"t", ""), (b"t", "claim"), (b"n", 12), (b"t", "x" * 100_000), (b"t", "last")]
SMALL = SENT[:3]


def as_bytes(message: tuple[bytes, object]) -> bytes:
    kind, content = message
    return kind + str(content).encode()


def test_what_was_sent_arrives_in_order() -> None:
    here, there = Pipe()
    for message in SENT:
        there.send_bytes(as_bytes(message))
    there.close()
    messages = Messages(here, READERS)
    assert list(messages.read()) == SENT
    with pytest.raises(EOFError):
        list(messages.read())


@pytest.mark.parametrize("piece", [1, 3, 4096])
def test_a_message_may_come_in_pieces(piece: int) -> None:
    here, there = Pipe()
    sent, received = Pipe()
    for message in SMALL:
        sent.send_bytes(as_bytes(message))
    stream = os.read(received.fileno(), 2**16)
    messages = Messages(here, READERS)
    found: list[tuple[bytes, object]] = []
    for start in range(0, len(stream), piece):
        os.write(there.fileno(), stream[start : start + piece])
        found += messages.read()
    assert found == SMALL


@pytest.mark.parametrize("garbage", [b"garbage", b"\xff" * 12, b"\x80\0\0\0t", b"\xff\xff\xff\xff\0", b"\0\0\0\0t"])
def test_what_is_no_message_is_noticed_at_once(garbage: bytes) -> None:
    here, there = Pipe()
    os.write(there.fileno(), garbage)
    with pytest.raises(NoMessageError, match="written into the pipe"):
        list(Messages(here, READERS).read())


@pytest.mark.parametrize("garbage", [b"\0", b"\0\0\0\x09t", b"\x3f\xff\xff\xfft" + b"x" * 1000])
def test_nobody_waits_for_the_rest_of_one(garbage: bytes) -> None:
    here, there = Pipe()
    os.write(there.fileno(), garbage)
    assert list(Messages(here, READERS).read()) == []


@pytest.mark.parametrize("content", [b"nmany", b"t\xff", b"n"])
def test_a_message_whose_content_cannot_be_read_is_none(content: bytes) -> None:
    here, there = Pipe()
    there.send_bytes(content)
    with pytest.raises(NoMessageError):
        list(Messages(here, READERS).read())


VALUES = st.recursive(
    st.none() | st.integers() | st.floats(allow_nan=False) | st.text(st.characters(codec="utf-8")) | st.binary(),
    lambda inside: st.lists(inside).map(tuple),
)


@given(VALUES)
def test_what_is_packed_is_unpacked(value: object) -> None:
    assert unpacked(packed(value)) == value
