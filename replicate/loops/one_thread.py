"""Linear algebra on one thread.

The matrices of loops are small: where a library shares one out among threads, these wait for each other longer than
they work, and the last bits of a result depend on how many there are.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache

from threadpoolctl import ThreadpoolController


def one_thread() -> AbstractContextManager[object]:
    """Return a context in which the linear algebra of the whole process uses one thread."""
    limited: AbstractContextManager[object] = _controller().limit(limits=1, user_api="blas")
    return limited


@cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()
