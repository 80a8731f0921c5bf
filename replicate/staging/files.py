"""The file operations of a swap.

A name or content counts as safe only once file and folder are flushed: without that, a disk may keep a later step and
lose an earlier one when the power fails.
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

# Flushing waits for the disk, and the disk takes several at a time: 20 times as fast as one after the other.
_THREADS = 8


def flush(paths: Iterable[Path]) -> None:
    """Wait until files and folders are on the disk."""
    with ThreadPoolExecutor(_THREADS) as pool:
        list(pool.map(_flush, paths))


def _flush(path: Path) -> None:
    try:
        descriptor = os.open(path, os.O_RDONLY)
    except PermissionError:  # Windows opens no folder
        return
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.EBADF, errno.ENOTSUP):  # a file system that flushes nothing
            raise
    finally:
        os.close(descriptor)


def write(path: Path, content: bytes) -> Path:
    """Write a file and its folders, and return it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    return path


def partial_of(path: Path) -> Path:
    """Return where a file is written before it is whole: hidden, so that who reads the folder passes over it."""
    return path.with_name(f".{path.name}.partial")


def write_safely(path: Path, content: bytes) -> None:
    """Write a file that is whole at every moment, and on the disk when this returns."""
    partial = partial_of(path)
    partial.write_bytes(content)
    flush([partial])
    partial.replace(path)
    flush([path.parent])


def move(source: Path, place: Path) -> None:
    """Rename a file over another; `place` is whole at every moment, also on another disk behind a symbolic link."""
    try:
        source.replace(place)
    except OSError as error:
        if error.errno != errno.EXDEV:
            raise
        beside = place.with_name(f".{place.name}.replicate")
        try:
            shutil.copyfile(source, beside)
            flush([beside])
            beside.replace(place)
        except OSError:
            beside.unlink(missing_ok=True)
            raise
        source.unlink()


def keep(place: Path, aside: Path) -> None:
    """Give a file a second name, or where the file system has no such thing, a copy."""
    aside.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.link(place, aside, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copyfile(place, aside)


def files_below(folder: Path) -> list[str]:
    """Return the files in a folder and its sub-folders, sorted, with forward slashes."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir())


def folders_of(root: Path, names: Iterable[str]) -> list[Path]:
    """Return the folders between a root and files in it, the root among them, the innermost first."""
    found = {root}
    for name in names:
        found.update(root / parent for parent in Path(name).parents)
    return sorted(found, key=lambda path: (-len(path.parts), path))


def remove_empty(root: Path, names: Iterable[str]) -> None:
    """Remove the folders that files left empty; a folder that holds something, or is a link, stays."""
    for folder in folders_of(root, names):
        if folder != root:
            with suppress(OSError):
                folder.rmdir()
