"""Replace files and folders all together or not at all.

What is written goes into a folder beside the final place, and takes its place by renaming when everything is
there. An interrupted or failing run leaves the earlier state whole.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from replicate.errors import OutputError


@contextmanager
def staged(target: Path) -> Iterator[Path]:
    """Yield an empty folder; whatever it holds at the end replaces what has the same name in `target`.

    Other things in `target` stay as they are. If the block raises, nothing is replaced.

    Parameters
    ----------
    target
        The folder to write to; it is created if it does not exist.

    Raises
    ------
    OutputError
        If something cannot be written.
    """
    try:
        target.mkdir(parents=True, exist_ok=True)
        aside = Path(tempfile.mkdtemp(prefix=".partial-", dir=target))
    except OSError as error:
        msg = f"{target}: cannot be written: {error.strerror or error}"
        raise OutputError(msg) from error
    try:
        fresh, old = aside / "new", aside / "old"
        fresh.mkdir()
        old.mkdir()
        yield fresh
        _swap(fresh, target, old)
    except OSError as error:
        raise _unwritable(target, error) from error
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _swap(fresh: Path, target: Path, old: Path) -> None:
    """Move every entry of `fresh` into `target`, and everything back if one of the moves fails."""
    names = sorted(entry.name for entry in fresh.iterdir())
    try:
        for name in names:
            place = target / name
            if place.exists():
                place.rename(old / name)
            (fresh / name).rename(place)
    except BaseException:
        # Where everything is tells how far it came; an interruption may fall between any two steps.
        for name in names:
            if not (fresh / name).exists():
                (target / name).rename(fresh / name)
            if (old / name).exists():
                (old / name).rename(target / name)
        raise


def _unwritable(target: Path, error: OSError) -> OSError | OutputError:
    """Return the error to raise: one about another place, say a file that is read, is none of ours."""
    if error.errno is None or (error.filename and not Path(error.filename).is_relative_to(target)):
        return error
    return OutputError(f"{target}: cannot be written: {error.strerror or error}")
