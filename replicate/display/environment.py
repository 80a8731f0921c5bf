"""What a result may depend on: the versions of Python and of the libraries that compute, draw and write."""

from __future__ import annotations

import platform
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version

import replicate

_LIBRARIES = ("jinja2", "matplotlib", "numpy", "pandas", "pypandoc_binary")  # those of every report


def versions(used: Iterable[str] = ()) -> dict[str, str]:
    """Return versions by name: nothing of the clock or the machine, which would change the report's bytes.

    Parameters
    ----------
    used
        Names of the distributions that the papers use besides those of every report.
    """
    found = {"replicate": replicate.__version__, "Python": platform.python_version()}
    for library in sorted({*_LIBRARIES, *(name.lower() for name in used)} - {"paper-replicate"}):
        try:
            found[library] = version(library)
        except PackageNotFoundError:
            continue  # not needed to compute anything, then
    return found
