"""The modules that a process has loaded: whose they are, and where their files lie."""

from __future__ import annotations

import importlib.machinery
import importlib.metadata
import os
import sys
import sysconfig
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cache, lru_cache
from pathlib import Path

from replicate.run.module_text import module_text

_ROOT = __name__.partition(".")[0]
_NUMERICS = (f"{_ROOT}.loops", f"{_ROOT}.papers")


def modules_of(package: str, others: Collection[str]) -> frozenset[str]:
    """Return the loaded modules that code of a package may use.

    That is every loaded one, except those of other packages that the same process has served: they count only if
    something that the package imports, directly or not, imports them.
    """
    return _modules_of(package, frozenset(others), tuple(sys.modules))


@lru_cache(maxsize=16)  # most units load nothing new
def _modules_of(package: str, others: frozenset[str], names: Sequence[str]) -> frozenset[str]:
    loaded = frozenset(name for name in names if not _is_inner(name))
    foreign = {name for name in loaded if any(_is_in(name, other) for other in others if other != package)}
    if not foreign:
        return loaded
    return loaded - foreign | _reached(filter(_may_import_papers, loaded - foreign))


def _is_inner(name: str) -> bool:
    """Say whether a module is an inner part of an installed package of another name.

    Several packages carry one called ``_cyutility``, and which of them a process has depends on what it loaded first.
    Each counts with its package.
    """
    file = None if "." in name else getattr(sys.modules.get(name), "__file__", None)
    if file is None:
        return False
    path = _real(file)
    site = next((site for site in _sites() if path.startswith(site + os.sep)), None)
    inside = Path(path).relative_to(site).parts if site is not None else ()
    return len(inside) > 1 and inside[0] != name


def _is_in(module: str, package: str) -> bool:
    return module == package or module.startswith(f"{package}.")


def _reached(start: Iterable[str]) -> set[str]:
    """Return what modules import, directly or not, of what is loaded; what imports no paper is not looked into."""
    found: set[str] = set()
    waiting = list(start)
    while waiting:
        name = waiting.pop()
        if name in found or name not in sys.modules:
            continue
        found.add(name)
        if _may_import_papers(name):
            waiting += imports_of(name)
    return found


def _may_import_papers(name: str) -> bool:
    """Say whether a module is neither the framework's nor the standard library's nor an installed distribution's."""
    return not is_framework(name) and not is_standard(name) and not distributions_of(name)


@cache
def imports_of(name: str) -> tuple[str, ...]:
    """Return every name that may be a module in the import statements of a loaded module, wherever they stand."""
    path = file_of(name)
    return module_text(path, name).imports if path is not None and path.suffix == ".py" else ()


def read_imports(package: str) -> None:
    """Read the loaded modules of a package, so that nobody need do so later."""
    for name in [name for name in sys.modules if _is_in(name, package)]:
        imports_of(name)


def numerical_imports() -> dict[str, tuple[str, ...]]:
    """Return what each module of the numerical core imports, loaded or not."""
    folder = Path(__file__).parents[1]
    parts = [path.relative_to(folder.parent).with_suffix("").parts for path in sorted(folder.glob("loops/**/*.py"))]
    names = [".".join(part[:-1] if part[-1] == "__init__" else part) for part in parts]
    return {name: imports_of(name) for name in names}


def distributions_used(packages: Iterable[str], imports: Callable[[str], Sequence[str]] = imports_of) -> set[str]:
    """Return the distributions that packages import anywhere in their code, or in that of the modules of ours they use.

    Only statements count, so the answer does not depend on what was run. The framework's rooms do not count: what they
    import belongs to every report.

    Parameters
    ----------
    imports
        Returns what a module imports.
    """
    packages = tuple(packages)
    found: set[str] = set()
    seen: set[str] = set()
    waiting = [name for name in sys.modules if any(_is_in(name, package) for package in packages)]
    while waiting:
        name = waiting.pop()
        if name in seen or is_standard(name):
            continue
        seen.add(name)
        top = name.partition(".")[0]
        ours = top == _ROOT or any(_is_in(name, package) for package in packages) or top not in installed()
        if not ours:
            found.update(installed()[top])
        elif top != _ROOT or any(_is_in(name, room) for room in (*_NUMERICS, *packages)):
            waiting += imports(name)
    return found


def is_framework(name: str) -> bool:
    """Say whether a module is of this package, and not of a paper that comes with it."""
    return _is_in(name, _ROOT) and not _is_in(name, _NUMERICS[1])


def is_standard(name: str) -> bool:
    """Say whether a module is of the standard library, or the program itself."""
    top = name.partition(".")[0]
    return top in sys.stdlib_module_names or top in {"__main__", "__mp_main__"}


@cache
def installed() -> Mapping[str, list[str]]:
    """Return the distributions that hold each top-level module."""
    return importlib.metadata.packages_distributions()


@cache
def _real(path: str) -> str:
    """Return where a path leads; asked for every module with every folder of modules."""
    return os.path.realpath(path)


@cache
def _sites() -> tuple[str, ...]:
    paths = {sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}
    return tuple(sorted({os.path.realpath(path) for path in paths if path}))


@cache
def distributions_of(name: str) -> tuple[str, ...]:
    """Return the distributions that installed a module; none for one that lies in a folder of its author's.

    A module of an editable installation lies outside the folder of installed packages and counts by content.
    """
    file = getattr(sys.modules.get(name), "__file__", None)
    if file is not None:
        path = _real(file)
        if not path.startswith(_sites()) and "site-packages" not in path and "dist-packages" not in path:
            return ()
        around = (_real(entry) for entry in sys.path if entry)
        beside = max((entry for entry in around if path.startswith(entry + os.sep)), key=len, default="")
        if beside and beside not in _sites():
            return _owners(name.partition(".")[0], beside)
    return tuple(sorted(set(installed().get(name.partition(".")[0], []))))


@cache
def _owners(top: str, folder: str) -> tuple[str, ...]:
    """Return the distributions in another folder of installed packages that hold a top-level module."""
    return tuple(
        sorted(
            distribution.metadata["Name"]
            for distribution in importlib.metadata.distributions(path=[folder])
            if any(file.parts[0] in {top, f"{top}.py"} for file in distribution.files or ())
        )
    )


def file_of(name: str) -> Path | None:
    """Return the file of a module, found without running the packages that it lies in."""
    module = sys.modules.get(name)
    file = getattr(module, "__file__", None)
    if file is not None:
        return Path(file)
    parent = sys.modules.get(name.rpartition(".")[0])
    if parent is not None and not hasattr(parent, "__path__"):
        return None  # it is something else that the module above defines
    search: Iterable[str] | None = None
    full = ""
    spec = None
    for part in name.split("."):
        full = f"{full}.{part}".lstrip(".")
        spec = importlib.machinery.PathFinder.find_spec(full, None if search is None else list(search))
        if spec is None:
            return None
        search = spec.submodule_search_locations or ()
    return Path(spec.origin) if spec is not None and spec.origin and spec.has_location else None
