"""The exit status is ours alone: code of a paper cannot end the program as if all were well."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn


@contextmanager
def only_ours() -> Iterator[None]:
    """Turn ``os._exit``, which nothing can catch, into `SystemExit` inside a ``with`` block."""
    leave = os._exit
    os._exit = _raise_instead
    try:
        yield
    finally:
        os._exit = leave


def _raise_instead(status: int) -> NoReturn:
    raise SystemExit(status)
