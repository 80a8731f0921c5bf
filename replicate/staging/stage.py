"""What writers use: an empty folder to write into, or named files, put in place all together or not at all."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from replicate.errors import OutputError
from replicate.staging.files import files_below, write
from replicate.staging.journal import ROOM, finish, is_interrupted, new_folder, room_of, swap, throw_away
from replicate.staging.lock import locked
from replicate.staging.manifest import MANIFEST, Manifest, digest, refuse_foreign

LOCK = "lock"


def _everything(_: str) -> bool:
    return True


@contextmanager
def staged(
    target: Path, part: str = "report", *, renews: Callable[[str], bool] = _everything, expects: Iterable[str] = ()
) -> Iterator[Path]:
    """Yield an empty folder; what it holds at the end takes its place in `target`.

    Files that an earlier run wrote for the same part, and this one did not, are removed. Whatever else is in `target`
    stays as it is. If the block raises, nothing is replaced.

    Parameters
    ----------
    target
        The folder to write to; it is created if it does not exist.
    part
        What is written: ``report``, ``diff``, ``handouts``, ``charts``.
    renews
        Whether a file of an earlier run, by its name inside `target`, is one that this run writes anew or removes.
    expects
        Files that will be written, as far as known before: what stands in their way is reported before the block runs.

    Raises
    ------
    OutputError
        If something cannot be written, or a file is in the way that no earlier run of ours wrote.
    """
    with _room(target) as fresh:
        manifest = Manifest.read(target)
        refuse_foreign(target, manifest, dict.fromkeys((*manifest.of(part, renews), *expects)))
        with unchanged(target):
            yield fresh
        written = files_below(fresh)
        gone = manifest.obsolete(part, written, renews)
        refuse_foreign(target, manifest, (*written, *gone), fresh)
        after = manifest.renewed(part, {name: digest(fresh / name) for name in written}, gone)
        write(fresh / MANIFEST, after.text().encode())
        swap(target, (*written, MANIFEST), gone)


@contextmanager
def unchanged(target: Path) -> Iterator[None]:
    """Say of a run that the user interrupts inside the ``with`` block that a folder is as it was."""
    try:
        yield
    except KeyboardInterrupt:
        say(f"{target}: interrupted; nothing was changed there")
        raise


def files_of(target: Path, part: str) -> list[str]:
    """Return the files that earlier runs wrote for a part of a folder.

    Raises
    ------
    OutputError
        If the manifest is damaged.
    """
    return Manifest.read(target).of(part, _everything)


def replace_files(target: Path, files: Mapping[str, bytes], remove: Iterable[str] = ()) -> None:
    """Replace or make files, and remove others, all or nothing; the caller knows that they are ours.

    Parameters
    ----------
    target
        The folder; it is created if it does not exist.
    files
        New content by name inside the folder, with forward slashes.
    remove
        Files inside the folder; one that is not there is no error.

    Raises
    ------
    OutputError
        If something cannot be written; everything is as it was, then.
    """
    with _room(target) as fresh:
        for name, content in files.items():
            write(fresh / name, content)
        swap(target, list(files), list(remove))


def finish_interrupted(target: Path) -> None:
    """Finish, or undo, what a run that was killed had begun in a folder; for those that read it.

    Raises
    ------
    OutputError
        If that fails.
    """
    if is_interrupted(target):
        with _room(target):
            pass


@contextmanager
def _room(target: Path) -> Iterator[Path]:
    """Make, lock and finally remove the hidden folder of a run; yield the empty folder for what is new."""
    existed = target.is_dir()
    try:
        with locked(room_of(target) / LOCK, say):
            done = finish(target)
            if done:
                say(f"{target}: {done}")
            fresh = new_folder(target)
            fresh.mkdir()
            try:
                yield fresh
            finally:
                throw_away(target)
    except OSError as error:
        raise unwritable(target, error) from error
    finally:
        with suppress(OSError):  # it holds a manifest, or another run is waiting
            (target / ROOM).rmdir()
            if not existed:
                target.rmdir()


def unwritable(target: Path, error: OSError) -> OSError | OutputError:
    """Return the error to raise: one about another place, say a file that is read, is none of ours."""
    folder = target.absolute()
    named = [Path(name).absolute() for name in (error.filename2, error.filename) if isinstance(name, str)]
    ours = [name for name in named if name.is_relative_to(folder) or folder.is_relative_to(name)]
    if error.errno in (None, errno.EPIPE) or (named and not ours):
        return error
    seen = [name.relative_to(folder) for name in ours if name.is_relative_to(folder)]
    place = next((target / name for name in seen if ROOM not in name.parts), target)
    leads_nowhere = os.path.islink(place) and not os.path.exists(place)  # noqa: PTH110, PTH114  -- of long names, too
    why = "it is a link that leads nowhere" if leads_nowhere else error.strerror or error
    return OutputError(f"{place}: cannot be written: {why}")


def say(text: str) -> None:
    """Tell whoever waits for the run, on standard error."""
    print(text, file=sys.stderr)  # noqa: T201  -- as progress is
