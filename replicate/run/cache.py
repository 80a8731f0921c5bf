"""Results kept between runs, under a key that changes with everything they depend on.

The key of a result is a hash of the sources of the numerical core, of the exhibit vocabulary, of the paper's
own package with its data, and of the versions of the libraries. What only judges or explains
(``ledger.toml``, ``notes.md``, ``handout.md``, ``handout.py``) is left out, so that editing prose does not recompute
anything.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.metadata
import os
import pickle
import platform
import re
import sys
import tempfile
from collections.abc import Iterator
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from replicate.exhibits import Paper

_CORE = ("loops", "exhibits", "figures", "run")
_LIBRARIES = ("control", "matplotlib", "numpy", "pandas", "schemdraw", "scipy")
_PROSE = re.compile(r"(ledger|notes|handout)(-\w+)?\.(toml|md)|handout\.py")
# Settings that choose the numerical kernels, and with them the last bits of a result.
_KERNELS = ("OPENBLAS_CORETYPE", "NPY_DISABLE_CPU_FEATURES", "MKL_CBWR")


class Cache:
    """A folder of pickled results; a result that cannot be read counts as missing.

    Parameters
    ----------
    folder
        Created on the first write. ``None`` keeps nothing.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self._fingerprints: dict[str, str] = {}

    def get(self, paper: Paper, name: str) -> Any:
        """Return the result of that name, or ``None``."""
        if self.folder is None:
            return None
        try:
            return pickle.loads(self._path(paper, name).read_bytes())  # noqa: S301  -- written by `put` below
        except Exception:  # noqa: BLE001  -- whatever is wrong with it, the result is computed again
            return None

    def put(self, paper: Paper, name: str, result: object) -> None:
        """Keep a result. A full disk or a read-only folder costs the next run time, nothing else."""
        if self.folder is None:
            return
        path = self._path(paper, name)
        with contextlib.suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            # Written aside and renamed: a reader sees the whole result or none.
            with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as aside:
                aside.write(pickle.dumps(result))
            Path(aside.name).replace(path)

    def _path(self, paper: Paper, name: str) -> Path:
        assert self.folder is not None  # noqa: S101  -- for the type checker; both callers have looked
        if paper.package not in self._fingerprints:
            self._fingerprints[paper.package] = fingerprint(paper)
        key = hashlib.sha256(f"{self._fingerprints[paper.package]} {name}".encode()).hexdigest()
        return self.folder / paper.id / f"{key[:32]}.pickle"


def fingerprint(paper: Paper) -> str:
    """Return a hash of all that the results of a paper depend on."""
    digest = hashlib.sha256()
    for part in (*_environment(), *_sources(paper)):
        digest.update(len(part).to_bytes(8, "big") + part)
    return digest.hexdigest()


def _environment() -> Iterator[bytes]:
    yield f"python {sys.version_info[:3]} {platform.system()} {platform.machine()}".encode()
    for library in _LIBRARIES:
        yield f"{library} {importlib.metadata.version(library)}".encode()
    for name in _KERNELS:
        yield f"{name}={os.environ.get(name, '')}".encode()


def _sources(paper: Paper) -> Iterator[bytes]:
    core = files("replicate")
    for name in _CORE:
        yield from _content(core / name, name)
    yield from _content(paper.folder(), paper.package)


def _content(place: Traversable, name: str) -> Iterator[bytes]:
    """Yield name and bytes of a file, or of every file in a folder in alphabetical order."""
    if place.is_dir():
        for entry in sorted(place.iterdir(), key=lambda entry: entry.name):
            if entry.name != "__pycache__" and not _PROSE.fullmatch(entry.name):
                yield from _content(entry, f"{name}/{entry.name}")
    elif place.is_file():
        yield name.encode()
        yield place.read_bytes()
