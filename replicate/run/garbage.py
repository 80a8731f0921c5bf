"""When a process looks for garbage: for objects in circles, to which nothing else leads.

Python does so again and again, through all objects that there are, which are many where papers and their texts are
loaded. Of those that stay as long as the process it need not look at any.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def staying() -> Iterator[None]:
    """Take all that is there after a ``with`` block for what stays: nothing looks through it, in the block or later."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()  # before it is looked through when the next object is made
        if was_on:
            gc.enable()
