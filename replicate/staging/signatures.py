"""One file at a place that the user names: it says itself that we wrote it, and that nobody changed it since.

An output folder has a manifest. A single file, say a chart for a lecture, lies among files of the user's, where a
manifest would be in the way. So the file carries a digest of itself: a comment at the end of SVG and HTML, a text
chunk in PNG.
"""

from __future__ import annotations

import hashlib
import os
import re
import struct
import zlib
from pathlib import Path

from replicate.errors import OutputError
from replicate.staging.stage import replace_files

_COMMENT = re.compile(rb"<!-- written by replicate, ([0-9a-f]{64}) -->\n\Z")

_PNG = b"\x89PNG\r\n\x1a\n"
_KEY = b"replicate\0"
_END = struct.pack(">I", 0) + b"IEND" + struct.pack(">I", zlib.crc32(b"IEND"))
_CHUNK = 4 + len(b"tEXt") + len(_KEY) + 64 + 4  # length, type, text, checksum


def signed(content: bytes) -> bytes:
    """Return the content of an SVG, HTML or PNG file with a digest of itself; pictures and pages look as before.

    Parameters
    ----------
    content
        The whole file.

    Examples
    --------
    >>> is_signed(signed(b"<svg/>")), is_signed(b"<svg/>")
    (True, False)
    """
    if content.startswith(_PNG):
        body = content.removesuffix(_END)
        text = b"tEXt" + _KEY + _digest(body)
        return body + struct.pack(">I", len(text) - 4) + text + struct.pack(">I", zlib.crc32(text)) + _END
    body = content.removesuffix(b"\n") + b"\n"
    return body + b"<!-- written by replicate, " + _digest(body) + b" -->\n"


def is_signed(content: bytes) -> bool:
    """Return whether `signed` made this content and nobody changed it since."""
    if content.startswith(_PNG):
        cut = len(content) - len(_END) - _CHUNK
        return cut > 0 and signed(content[:cut] + _END) == content
    found = _COMMENT.search(content)
    return found is not None and _digest(content[: found.start()]) == found[1]


def write_signed(path: Path, content: bytes) -> None:
    """Write a file that the user named, signed; a file of the user's in its place is never replaced.

    Parameters
    ----------
    path
        Where to write. A symbolic link stays one: the file it leads to is written.
    content
        An SVG, HTML or PNG file as a whole.

    Raises
    ------
    OutputError
        If another file is there, or one that was changed after we wrote it, or nothing can be written.
    """
    place = Path(os.path.realpath(path)) if path.is_symlink() else path
    new = signed(content)
    if place.exists() and not (place.is_file() or place.is_dir()):  # a device may never come to an end
        msg = f"{path}: is in the way, and is not a file; choose another --out"
        raise OutputError(msg)
    try:
        there = place.read_bytes() if place.exists() else new
    except OSError as error:
        msg = f"{path}: cannot be replaced: {error.strerror or error}"
        raise OutputError(msg) from error
    if there not in (new, content) and not is_signed(there):
        msg = f"{path}: is in the way, and is not as an earlier run wrote it; move it away, or choose another --out"
        raise OutputError(msg)
    replace_files(place.parent, {place.name: new})


def _digest(body: bytes) -> bytes:
    return hashlib.sha256(body).hexdigest().encode()
