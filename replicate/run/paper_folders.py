"""Papers in a folder: a package for each, that is a folder with an ``__init__.py`` that defines ``paper``.

Nothing need be installed. The folder is put at the end of the import path, so that nothing in it hides a library, and
worker processes inherit it.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from pathlib import Path

from replicate.errors import UnknownPaperError
from replicate.run.discovery import Found, found_as

# What tells a paper that cannot be used from a package of helpers, which is left alone.
_MARKS = ("ledger.toml", "printed", "notes.md")

_added: set[str] = set()


def papers_in(folder: Path) -> list[Found]:
    """Return the papers in a folder, which may also be the folder of one paper.

    A distribution in the folder (``pyproject.toml`` and beside it, or in ``src``, the paper's package) is looked into.
    The papers are imported anew, whatever an earlier call has imported.

    Raises
    ------
    UnknownPaperError
        If there is no such folder.
    """
    if not folder.is_dir():
        msg = f"there is no folder {folder}"
        raise UnknownPaperError(msg)
    packages = _packages(folder.resolve())
    _forget(packages)
    return [found for package in packages if (found := _look_into(package)) is not None]


def _packages(folder: Path) -> list[Path]:
    if (folder / "__init__.py").is_file():
        return [folder]
    packages = []
    for entry in sorted(folder.iterdir()):
        if entry.name.startswith((".", "_")):
            continue
        if (entry / "__init__.py").is_file():
            packages.append(entry)
        elif (entry / "pyproject.toml").is_file():
            inside = (*entry.glob("*/__init__.py"), *entry.glob("src/*/__init__.py"))
            packages += [init.parent for init in sorted(inside)]
    return packages


def _forget(packages: list[Path]) -> None:
    """Forget what was imported from these folders, and from other folders of papers that have one of the same name."""
    names, roots = {package.name for package in packages}, {str(package.parent) for package in packages}
    others = {root for root in _added - roots if any((Path(root) / name).is_dir() for name in names)}
    for name, module in list(sys.modules.items()):
        file = Path(getattr(module, "__file__", None) or "")
        root = next((root for root in _added if file.is_relative_to(root)), None)
        if root is not None and (root in roots | others or name.partition(".")[0] in names):
            del sys.modules[name]
    for root in others:
        if root in sys.path:
            sys.path.remove(root)
        _added.discard(root)


def _look_into(package: Path) -> Found | None:
    name, where = package.name, f"{package.parent.name}/{package.name}"
    is_paper = any((package / mark).exists() for mark in _MARKS)
    if not name.isidentifier():
        error = f"{where}: '{name}' is not the name of a Python package; allowed: letters, digits and _"
        return Found(name, where, error=error) if is_paper else None
    importlib.invalidate_caches()
    spec = importlib.util.find_spec(name)
    if spec is not None and Path(spec.origin or "").resolve() != package / "__init__.py":
        error = f"{where}: another module on this machine is called '{name}'; rename the folder"
        return Found(name, where, error=error) if is_paper else None
    if spec is None:
        sys.path.append(str(package.parent))
        _added.add(str(package.parent))
        importlib.invalidate_caches()
    found = found_as(name, name, where)
    helpers = found.paper is None and name in sys.modules and not hasattr(sys.modules[name], "paper")
    return None if helpers and not is_paper else found
