"""Import matplotlib without the user's configuration: what a run draws and whether it runs do not depend on it.

matplotlib reads a file ``matplotlibrc``, in the current folder first, and the variable ``MPLBACKEND`` while it is
imported. A file that is damaged or a backend that does not exist stops the import, others change every figure.
Who uses `replicate.figures` as a library keeps his own settings: only the command and its workers call this.
"""

from __future__ import annotations

import importlib.util
import logging
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType

_NAME = "matplotlib"

#: Holds an empty ``matplotlibrc``; the one in the current folder comes before all others.
_OWN = Path(__file__).parent / "settings"


def isolate_matplotlib() -> None:
    """Have matplotlib read our settings when it is imported, by whom and when so ever; to be called before that."""
    os.environ["MPLBACKEND"] = "agg"
    # No word of folders it would like to write to, or of settings it does not know: figures do without both.
    logging.getLogger(_NAME).setLevel(logging.ERROR)
    if _NAME not in sys.modules and not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder())


class _Finder(MetaPathFinder):
    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None = None,  # noqa: ARG002  -- the import system's signature
        target: ModuleType | None = None,  # noqa: ARG002
    ) -> ModuleSpec | None:
        if fullname != _NAME:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(fullname)
        if spec is not None and spec.loader is not None:
            spec.loader = _Loader(spec.loader)
        return spec


class _Loader(Loader):
    def __init__(self, loader: Loader) -> None:
        self._loader = loader

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        assert module.__spec__ is not None  # noqa: S101  -- the import system has just set it
        module.__spec__.loader = module.__loader__ = self._loader
        with _in_folder(_OWN):
            self._loader.exec_module(module)


@contextmanager
def _in_folder(folder: Path) -> Iterator[None]:
    try:
        here = Path.cwd()
    except FileNotFoundError:  # removed meanwhile; there is nothing to go back to
        here = None
    os.chdir(folder)
    try:
        yield
    finally:
        if here is not None:
            with suppress(OSError):
                os.chdir(here)
