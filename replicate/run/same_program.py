"""Whether two processes, or two runs, are of the same program: its code, and what else decides about digits.

That is the libraries, and Python: from 3.12 on, ``sum`` of floats has other last digits.
"""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import replicate

_LIBRARIES = ("numpy", "scipy", "pandas", "matplotlib")
_CODE = "code"


@cache
def program() -> dict[str, str]:
    """Return what tells this program from another: versions by name, and a digest of its code."""
    found = {"replicate": replicate.__version__, "Python": ".".join(platform.python_version_tuple()[:2])}
    for library in _LIBRARIES:
        try:
            found[library] = version(library)
        except PackageNotFoundError:
            found[library] = "missing"
    return {**found, _CODE: _code(Path(replicate.__file__).parent)}


def difference(other: Mapping[str, str], own: Mapping[str, str]) -> str:
    """Return in words what another program has, and not this one; empty if they are the same.

    Parameters
    ----------
    other, own
        What `program` returns there and here.

    Examples
    --------
    >>> difference({"numpy": "2.0.0", "code": "a"}, {"numpy": "2.1.0", "code": "a"})
    'numpy 2.0.0, not 2.1.0'
    """
    for name, here in own.items():
        if other.get(name) != here:
            return "other code of replicate" if name == _CODE else f"{name} {other.get(name, 'unknown')}, not {here}"
    return ""


def _code(package: Path) -> str:
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        content = path.read_bytes()
        digest.update(f"{path.relative_to(package).as_posix()} {len(content)}\n".encode() + content)
    return digest.hexdigest()[:24]
