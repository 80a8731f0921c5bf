"""What a result may depend on: the versions of Python and of the libraries that compute, draw and write."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

import replicate

_LIBRARIES = (
    "control", "jinja2", "matplotlib", "numpy", "pandas", "pypandoc_binary", "schemdraw", "scipy",
)  # fmt: skip


def versions() -> dict[str, str]:
    """Return versions by name: nothing of the clock or the machine, which would change the report's bytes."""
    found = {"replicate": replicate.__version__, "Python": platform.python_version()}
    for library in _LIBRARIES:
        try:
            found[library] = version(library)
        except PackageNotFoundError:
            continue  # not needed to compute anything, then
    return found
