"""JSON as files of a user hold it: what is damaged is refused before anything is made of it."""

from __future__ import annotations

import json
import re
from typing import Any

_HALF = re.compile(r"\\u[dD][89a-fA-F]")


def parse_json(text: str, **options: Any) -> Any:
    r"""Return the value of a JSON text; one with half a character in it, such as ``\ud800``, is refused as no JSON.

    Raises
    ------
    ValueError
        Among them `json.JSONDecodeError`, which knows the line.
    """
    try:
        value = json.loads(text, **options)
        if _HALF.search(text):
            json.dumps(value, ensure_ascii=False).encode()
    except RecursionError as error:
        msg = "too many brackets inside each other"
        raise ValueError(msg) from error
    return value
