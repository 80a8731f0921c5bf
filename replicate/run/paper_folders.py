"""Papers in a folder: a package for each, that is a folder with an ``__init__.py`` that defines ``paper``.

Nothing need be installed. The folder is put at the end of the import path, so that nothing in it hides a library, and
worker processes inherit it.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Container
from pathlib import Path

from replicate.errors import UnknownPaperError
from replicate.run.discovery import Found, found_as

# What tells a paper that cannot be used from a package of helpers, which is left alone.
_MARKS = ("ledger.toml", "printed", "notes.md")

_added: set[str] = set()


def papers_in(folder: Path, known: dict[Path, Found | None], hidden: Container[str] = ()) -> list[Found]:
    """Return the papers in a folder, which may also be the folder of one paper.

    A distribution in the folder (``pyproject.toml`` and beside it, or in ``src``, the paper's package) is looked into.

    Parameters
    ----------
    known
        What was found before, by the folder of each package, and is not imported again; what is found is added.
        Everything else is imported anew, whatever this process has imported from there.
    hidden
        Names of packages that are left alone, unless they are known: others of these names are meant.

    Raises
    ------
    UnknownPaperError
        If there is no such folder.
    """
    if not folder.is_dir():
        msg = f"there is no folder {folder}"
        raise UnknownPaperError(msg)
    packages = [package for package in _packages(folder.resolve()) if package in known or package.name not in hidden]
    fresh = [package for package in packages if package not in known]
    _forget(fresh, {str(package.parent) for package in known})
    known.update((package, _look_into(package)) for package in fresh)
    return [found for package in packages if (found := known[package]) is not None]


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


def _forget(packages: list[Path], in_use: set[str]) -> None:
    """Forget what was imported from these folders, and from other folders of papers that have one of the same name.

    Folders that are in use are forgotten only where they have a package of the same name.
    """
    names, roots = {package.name for package in packages}, {str(package.parent) for package in packages}
    others = {root for root in _added - roots if any((Path(root) / name).is_dir() for name in names)}
    roots -= in_use
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
