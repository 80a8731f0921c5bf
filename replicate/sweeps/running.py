"""Run a sweep block by block into a folder; what is there already is not computed again.

A block's file is written beside its place, flushed and renamed, so that a file with a block's name is a whole block:
an interrupted run has lost at most the blocks it was at. The folder says which sweep it holds (``sweep.json``), and
nothing but that sweep's blocks is ever written there.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from replicate.errors import OutputError
from replicate.run.backends import Backend
from replicate.staging import keep_file, locked_folder
from replicate.sweeps.blocks import compute_block, file_name, rows_in, rows_of
from replicate.sweeps.sweep_file import Block, SweepFile

SPECIFICATION = "sweep.json"


@dataclass(frozen=True)
class SweepProgress:
    """How far a sweep is, in loops: kept from an earlier run, done by now, and all."""

    kept: int
    done: int
    total: int


def run_sweep(
    sweep: SweepFile,
    folder: Path,
    file_format: str,
    backend: Backend,
    progress: Callable[[SweepProgress], None] = lambda _: None,
) -> int:
    """Compute what is missing of a sweep.

    Parameters
    ----------
    folder
        Where the blocks go; it is made if need be.
    file_format
        ``csv`` or ``parquet``.
    backend
        What computes the blocks.
    progress
        Called at the beginning and after every block.

    Returns
    -------
    int
        The number of blocks computed.

    Raises
    ------
    OutputError
        If the folder holds something else, or cannot be written; blocks that are written stay.
    """
    with _folder(folder, sweep, file_format):
        missing: list[Block] = []
        kept = 0
        for block in sweep.blocks():
            path = folder / file_name(block, file_format)
            if path.is_file() and rows_in(path) == rows_of(sweep, block):
                kept += rows_of(sweep, block)
            else:
                missing.append(block)
        done = kept
        progress(SweepProgress(kept, done, sweep.loops))
        for block, content in backend.unordered(partial(compute_block, sweep, file_format=file_format), missing):
            keep_file(folder / file_name(block, file_format), content)
            done += rows_of(sweep, block)
            progress(SweepProgress(kept, done, sweep.loops))
    return len(missing)


@contextmanager
def _folder(folder: Path, sweep: SweepFile, file_format: str) -> Iterator[None]:
    """Lock the folder for one run, and see that it is this sweep's."""
    with locked_folder(folder):
        path = folder / SPECIFICATION
        about = {"sweep": sweep.name, "format": file_format, "loops": sweep.loops, "digest": sweep.digest}
        try:
            there = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            foreign = sorted(entry.name for entry in folder.iterdir() if entry.name != ".replicate")
            if foreign:
                msg = f"{folder}: holds {foreign[0]}, which belongs to no sweep: name another folder with --out"
                raise OutputError(msg) from None
            keep_file(path, (json.dumps(about, indent=1) + "\n").encode())
        except (OSError, ValueError, RecursionError) as error:
            msg = f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}"
            raise OutputError(msg) from error
        else:
            if not isinstance(there, dict) or {**there, "sweep": sweep.name} != about:
                msg = f"{folder}: holds the blocks of another sweep: remove the folder, or name another with --out"
                raise OutputError(msg)
        yield
