"""What a fault handler has written of a process that was ended: which lines it was at."""

from __future__ import annotations

import re

_FRAME = re.compile(r'File "([^"\n]+)", line (\d+) in ')
_LETTER = re.compile(r"\\(?:x([0-9a-f]{2})|u([0-9a-f]{4})|U([0-9a-f]{8}))")


def frames(report: str) -> list[tuple[str, int]]:
    r"""Return file and line of each frame, the innermost first.

    The handler cannot encode: it writes a letter that is not ASCII by its number.

    Examples
    --------
    >>> frames('  File "/home/m\\xfcller/fig_1.py", line 7 in draw')
    [('/home/müller/fig_1.py', 7)]
    """
    return [(_LETTER.sub(_letter, file), int(line)) for file, line in _FRAME.findall(report)]


def _letter(number: re.Match[str]) -> str:
    return chr(int(number[1] or number[2] or number[3], 16))
