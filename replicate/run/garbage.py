"""When a process looks for garbage: for objects in circles, to which nothing else leads.

Python does so again and again, through all objects that there are, which are many where papers and their texts are
loaded. Of those that stay as long as the process it need not look at any.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected() -> Iterator[None]:
    """Look for no garbage inside a ``with`` block, whose circles are few."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


@contextmanager
def staying() -> Iterator[None]:
    """Take all that is there after a ``with`` block for what stays: nothing looks through it any more."""
    gc.collect()  # what is garbage before the block does not stay
    with uncollected():
        yield
        gc.freeze()
