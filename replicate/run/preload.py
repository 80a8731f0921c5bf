"""Imported once by the process that workers are forked from, so that none of them need do it again."""

from __future__ import annotations

from replicate.run.garbage import staying
from replicate.run.isolation import isolate_matplotlib

isolate_matplotlib()

with staying():
    from replicate.run import performance  # which may import matplotlib
    from replicate.run.modules import installed

    installed()

__all__ = ["performance"]
