"""The results of the bundled papers, kept with those of `make report`, and computed once for all processes of tests."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from replicate.staging.lock import locked

_BUILD = Path(__file__).parent.parent / "build"


@contextmanager
def kept_results() -> Iterator[Path]:
    """Yield the folder of kept results; another process that asks waits, and finds what has been computed here."""
    kept = _BUILD / "cache"
    with locked(_BUILD / "tests.lock", lambda _: None):
        kept.mkdir(parents=True, exist_ok=True)
        yield kept
