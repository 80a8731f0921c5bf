"""Imported once by the process that workers are forked from, so that none of them need do it again."""

from __future__ import annotations

import gc

gc.disable()  # all that is imported stays; workers look for garbage again

from replicate.run.isolation import isolate_matplotlib

isolate_matplotlib()

from replicate.run import performance  # which may import matplotlib
from replicate.run.modules import installed

__all__ = ["performance"]

installed()
