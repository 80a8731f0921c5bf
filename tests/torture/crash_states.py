"""What a disk holds if a command is killed at any of its file operations.

The audit events of Python tell of every file operation before it happens, whatever the code that asks for it looks
like. At each one inside the watched folder, either the process is killed by SIGKILL (`killed_swaps`), or, where that
would take too long, the folder is copied: that is what the disk would hold. Where a file is opened for writing there is
a second state, in which it is there but only half written.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path

EVENTS = {"os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.truncate", "shutil.copyfile"}
TORN = b"half a fi"


def watch(folder: Path, at_each: Callable[[str, str], None], ignore: str = "cache") -> Callable[[], None]:
    """Call ``at_each(event, path)`` before every file operation inside a folder; ``torn`` is a half-written file.

    Returns
    -------
    function
        What ends the watch.
    """
    busy = False

    def hook(event: str, arguments: tuple[object, ...]) -> None:
        nonlocal busy
        writing = event == "open" and isinstance(arguments[2], int) and arguments[2] & (os.O_WRONLY | os.O_RDWR)
        if busy or not (event in EVENTS or writing) or not isinstance(arguments[0], str | os.PathLike):
            return
        path = os.path.abspath(os.fspath(arguments[0]))  # noqa: PTH100  -- links must not be followed
        if not path.startswith(f"{folder}{os.sep}") or ignore in Path(path).relative_to(folder).parts:
            return
        busy = True
        try:
            at_each(event, path)
            if writing:
                at_each("torn", path)
        finally:
            busy = False

    def end() -> None:
        nonlocal busy
        busy = True

    sys.addaudithook(hook)
    return end


def kill_at(number: int, folder: Path) -> None:
    """Make this process kill itself at the file operation of that number."""
    count = 0

    def maybe(event: str, path: str) -> None:
        nonlocal count
        count += 1
        if count == number:
            if event == "torn" and Path(path).parent.is_dir():  # else it cannot be opened, and nothing is written
                Path(path).write_bytes(TORN)
            os.kill(os.getpid(), signal.SIGKILL)

    watch(folder, maybe)


def snapshot_each(folder: Path, states: Path) -> Callable[[], None]:
    """Copy the folder before each of its file operations to ``states/<number>``, until what is returned is called."""
    count = 0

    def copy(event: str, path: str) -> None:
        nonlocal count
        count += 1
        to = states / str(count)
        shutil.copytree(folder, to, symlinks=True, ignore=shutil.ignore_patterns("cache"))
        if event == "torn":
            (to / Path(path).relative_to(folder)).write_bytes(TORN)

    return watch(folder, copy)
