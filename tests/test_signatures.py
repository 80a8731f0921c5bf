"""A file at a place that the user names is replaced only if it is as an earlier run wrote it."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from PIL import Image

from replicate.errors import OutputError
from replicate.staging import signed, write_signed
from replicate.staging.signatures import is_signed

NAMESPACE = "http://www.w3.org/2000/svg"
SVG = f'<svg xmlns="{NAMESPACE}"><path d="M 0 0"/></svg>'.encode()


def png(colour: int) -> bytes:
    picture = io.BytesIO()
    Image.new("L", (8, 4), colour).save(picture, "png")
    return picture.getvalue()


@pytest.mark.parametrize(
    "content", [SVG, SVG + b"\n", b"<!DOCTYPE html>\n<p>a</p>\n", png(3)], ids=["svg", "line", "html", "png"]
)
def test_a_signed_file_is_what_it_was(content: bytes) -> None:
    there = signed(content)
    assert is_signed(there)
    assert not is_signed(content)
    if content.startswith(b"\x89PNG"):
        with Image.open(io.BytesIO(there)) as picture:
            picture.verify()  # checksums of all chunks
        with Image.open(io.BytesIO(there)) as picture, Image.open(io.BytesIO(content)) as before:
            assert picture.tobytes() == before.tobytes()
    elif content == SVG:
        root = ET.fromstring(there)  # noqa: S314  -- our own text
        assert [element.tag for element in root.iter()] == [f"{{{NAMESPACE}}}svg", f"{{{NAMESPACE}}}path"]


@pytest.mark.parametrize("content", [SVG, png(3)], ids=["svg", "png"])
def test_every_altered_byte_breaks_the_signature(content: bytes) -> None:
    there = signed(content)
    for place in range(len(there)):
        altered = bytearray(there)
        altered[place] ^= 1
        assert not is_signed(bytes(altered)), place
    for cut in range(len(there)):
        assert not is_signed(there[:cut])


@pytest.mark.parametrize(
    ("first", "second"), [(SVG, SVG.replace(b"0 0", b"1 1")), (png(3), png(4))], ids=["svg", "png"]
)
def test_only_what_an_earlier_run_wrote_is_replaced(tmp_path: Path, first: bytes, second: bytes) -> None:
    path = tmp_path / "file"
    write_signed(path, first)
    write_signed(path, second)
    write_signed(path, second)
    assert path.read_bytes() == signed(second)
    for own in (b"", b"mine", signed(second) + b" ", png(5), first):
        path.write_bytes(own)
        with pytest.raises(OutputError, match=r"file: is in the way, and is not as an earlier run wrote it; move it"):
            write_signed(path, second)
        assert path.read_bytes() == own
    path.write_bytes(second)  # what the run would write, without the signature
    write_signed(path, second)
    assert path.read_bytes() == signed(second)


@pytest.mark.skipif(not Path("/dev/zero").is_char_device(), reason="needs a system with devices")
def test_a_device_that_never_ends_is_not_read() -> None:
    with pytest.raises(OutputError, match="zero: is in the way, and is not a file"):
        write_signed(Path("/dev/zero"), SVG)


def test_a_link_stays_one_and_a_folder_is_refused(tmp_path: Path) -> None:
    place, link = tmp_path / "place" / "a.svg", tmp_path / "link.svg"
    write_signed(place, SVG)
    link.symlink_to(place)
    write_signed(link, SVG.replace(b"0 0", b"1 1"))
    assert link.is_symlink()
    assert b"1 1" in place.read_bytes()
    with pytest.raises(OutputError, match="place: cannot be replaced: Is a directory"):
        write_signed(tmp_path / "place", SVG)
