"""Set attributes of single objects for a while, without a trace of it on the objects afterwards."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

_MISSING = object()


@contextmanager
def attributes(changes: Iterable[tuple[Any, str, Any]]) -> Iterator[None]:
    """Hide attributes, or methods of a class, behind others for the length of a ``with`` block.

    Parameters
    ----------
    changes
        Objects with the name of an attribute and what it is to be.
    """
    kept: list[tuple[dict[str, Any], str, Any]] = []
    try:
        for owner, name, value in changes:
            kept.append((owner.__dict__, name, owner.__dict__.get(name, _MISSING)))
            owner.__dict__[name] = value
        yield
    finally:
        for own, name, before in reversed(kept):
            if before is _MISSING:
                own.pop(name, None)
            else:
                own[name] = before
