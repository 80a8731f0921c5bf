"""Names of files inside a folder: none of them leads out of it."""

from __future__ import annotations

from pathlib import PurePosixPath, PureWindowsPath


def checked_name(name: object) -> str:
    """Return the name of a file below a folder.

    Raises
    ------
    ValueError
        If it is none: absolute, with a drive, with ``..``, or empty.

    Examples
    --------
    >>> checked_name("report/index.html")
    'report/index.html'
    >>> checked_name("../index.html")
    Traceback (most recent call last):
    ValueError: '../index.html' is not the name of a file inside the folder
    """
    if isinstance(name, str) and name and "\0" not in name and "\\" not in name:
        path = PurePosixPath(name)
        if path.parts and path.as_posix() == name and ".." not in path.parts:
            windows = PureWindowsPath(name)
            if not path.is_absolute() and not windows.drive:
                return name
    msg = f"{name!r} is not the name of a file inside the folder"
    raise ValueError(msg)
