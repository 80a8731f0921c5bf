"""Run a sweep block by block into a folder; what is there already is not computed again.

A block's file is written beside its place, flushed and renamed, so that a file with a block's name is a whole block:
an interrupted run has lost at most the blocks it was at. The folder says which sweep it holds and which program has
computed it (``_sweep.json``: readers of folders of Parquet files pass over such names), and nothing but that sweep's
blocks is ever written there.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from replicate.errors import OutputError
from replicate.run.backends import Backend
from replicate.run.same_program import difference, program
from replicate.staging import ROOM, keep_file, locked_folder, partial_of, say
from replicate.sweeps.blocks import compute_block, file_name, is_kept, rows_of
from replicate.sweeps.sweep_file import Block, SweepFile

SPECIFICATION = "_sweep.json"
_GOLDEN = (5**0.5 - 1) / 2  # its multiples fall evenly into the unit interval, however many they are


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
            if path.is_file() and is_kept(path, sweep, block):
                kept += rows_of(sweep, block)
            else:
                missing.append(block)
        done = kept
        compute = partial(compute_block, sweep, file_format=file_format)
        try:
            progress(SweepProgress(kept, done, sweep.loops))
            for block, content in backend.unordered(compute, scattered(missing)):
                keep_file(folder / file_name(block, file_format), content)
                done += rows_of(sweep, block)
                progress(SweepProgress(kept, done, sweep.loops))
        except KeyboardInterrupt:
            say(f"{folder}: interrupted; {done} of {sweep.loops} loops stay, and the next run goes on from there")
            raise
    return len(missing)


def scattered(blocks: Iterable[Block]) -> list[Block]:
    """Return blocks in an order whose beginnings are like the whole, so that the time left can be told from them.

    A grid has regions that are quick and regions that are slow, one after the other in the order of its rows.
    """
    return sorted(blocks, key=lambda block: block.number * _GOLDEN % 1.0)


@contextmanager
def _folder(folder: Path, sweep: SweepFile, file_format: str) -> Iterator[None]:
    """Lock the folder for one run, and see that it is this sweep's."""
    with locked_folder(folder):
        path = folder / SPECIFICATION
        about = {"sweep": sweep.name, "format": file_format, "loops": sweep.loops, "digest": sweep.digest}
        try:
            there = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            foreign = sorted(
                entry.name for entry in folder.iterdir() if entry.name not in {ROOM, partial_of(path).name}
            )
            if foreign:
                msg = f"{folder}: holds {foreign[0]}, which belongs to no sweep: name another folder with --out"
                raise OutputError(msg) from None
            keep_file(path, (json.dumps({**about, "program": program()}, indent=1) + "\n").encode())
        except (OSError, ValueError, RecursionError) as error:
            msg = f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}"
            raise OutputError(msg) from error
        else:
            why = _foreign(there, about)
            if why:
                msg = f"{folder}: holds {why}: remove the folder, or name another with --out"
                raise OutputError(msg)
        yield


def _foreign(there: object, about: dict[str, object]) -> str:
    """Say what a folder holds if it is not what this run would write."""
    if not isinstance(there, dict) or there.get("digest") != about["digest"]:
        return "the blocks of another sweep"
    if there.get("format") != about["format"]:
        return f"this sweep as {there.get('format')}, not {about['format']}"
    made_by = there.get("program")
    why = difference(made_by, program()) if isinstance(made_by, dict) else "an unknown program"
    return f"blocks that were computed by {why}" if why else ""
