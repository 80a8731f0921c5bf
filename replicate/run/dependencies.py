"""What a result depends on: recorded where it is computed, looked at again before it is used.

A worker records what it has loaded when a unit is done:

* the framework's own rooms, whole folders by content;
* the paper's folder by content, without what only judges, explains or tries results (``ledger.toml``, ``notes.md``,
  ``handout.md``, ``handout.py``, ``slides.md``, ``test_*.py``, ``conftest.py``), so that editing it recomputes nothing,
  and without modules that the exhibit does not use (`replicate.run.exhibit_modules`): one that has changed counts only
  if it may be used now;
* every other module that is not the standard library's: by content, or by the version of its distribution if it is
  an installed one;
* the project file above the paper's folder, by what it says;
* data files that the paper reads through `Paper.data` or that its exhibits declare with ``depends=``;
* the versions of Python and of the machine, and the settings that choose numerical kernels.

Names are relative (to the package, the paper's folder, the path of modules): a project can move.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import os
import platform
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from replicate.errors import ProjectError
from replicate.exhibits import Exhibit, Paper
from replicate.run.exhibit_modules import PaperModules
from replicate.run.modules import distributions_of, file_of, is_standard
from replicate.run.project import project_text

Dependencies = dict[str, dict[str, str]]

# Files of a paper that judge, explain or try its results.
_ABOUT = re.compile(r"(ledger|notes|handout|slides)([-.]\w+)?\.(toml|md)|handout\.py|test_\w+\.py|conftest\.py")
# Settings that choose the numerical kernels, and with them the last bits of a result.
_KERNELS = ("OPENBLAS_CORETYPE", "NPY_DISABLE_CPU_FEATURES", "MKL_CBWR")
_ROOT = __name__.split(".")[0]
_GONE = "missing"
_UNUSED = "unused "  # before the digest of a module that an exhibit does not use
_LENGTH = 24  # of a digest; 96 bits


@dataclass(frozen=True)
class _Loaded:
    """Loaded modules, by how they count: rooms of the framework, distributions, others by content, and the paper's."""

    rooms: set[str]
    distributions: set[str]
    by_content: set[str]
    of_paper: frozenset[str]

    @classmethod
    def among(cls, modules: Iterable[str], paper: Paper) -> _Loaded:
        """Sort the modules that are loaded for a paper."""
        rooms: set[str] = set()
        distributions: set[str] = set()
        by_content: set[str] = set()
        own = {name for name in modules if _is_own(paper, name)}
        for name in modules:
            if name == _ROOT or name.startswith(f"{_ROOT}."):
                rooms.add(name.split(".")[1] if "." in name else "__init__")
            elif not is_standard(name):
                found = distributions_of(name)
                distributions.update(found)
                if not found and name not in own:
                    by_content.add(name)
        return cls(rooms - {"papers"}, distributions, by_content, frozenset(own))


class Looked:
    """Looks at what is there now, each thing once: results of one run share nearly everything.

    Attributes
    ----------
    newest
        When the newest of the files that were looked at was written, in seconds.
    """

    def __init__(self) -> None:
        self.newest = 0.0
        self._folders: dict[tuple[str, str], dict[str, str]] = {}
        self._modules: dict[str, str] = {}
        self._versions: dict[str, str] = {}
        self._rooms: dict[tuple[str, ...], dict[str, str]] = {}
        self._projects: dict[Path, dict[str, str]] = {}
        self._loaded: dict[tuple[str, frozenset[str]], _Loaded] = {}
        self._uses: dict[tuple[str, frozenset[str]], PaperModules] = {}
        self._environment = {
            "version": f"{platform.python_version()} {platform.system()} {platform.machine()}",
            **{name: os.environ.get(name, "") for name in _KERNELS},
        }

    def record(self, paper: Paper, exhibit: Exhibit, modules: Iterable[str]) -> Dependencies:
        """Return what the result of an exhibit depends on, by group and name.

        Parameters
        ----------
        modules
            Names of the modules that were loaded for it.
        """
        key = (paper.package, frozenset(modules))
        if key not in self._loaded:
            self._loaded[key] = _Loaded.among(key[1], paper)
        loaded = self._loaded[key]
        present = self._folder("paper", paper.package, paper.folder())
        unused = self._unused(paper, exhibit, loaded.of_paper | loaded.by_content)
        groups = {
            "framework": dict.fromkeys(loaded.rooms, ""),
            "paper": {name: f"{_UNUSED}{present[name]}" for name in unused},
            "distribution": dict.fromkeys(loaded.distributions, ""),
            "module": dict.fromkeys(loaded.by_content, ""),
            "data": dict.fromkeys(paper.data_of(exhibit), ""),
        }
        return {group: dict(sorted(names.items())) for group, names in self.now(paper, exhibit.id, groups).items()}

    def _unused(self, paper: Paper, exhibit: Exhibit, loaded: frozenset[str]) -> set[str]:
        """Return the files of the paper's modules that an exhibit does not use, by their names in its folder."""
        key = (paper.package, loaded)
        if key not in self._uses:
            self._uses[key] = PaperModules(*key)
        modules = self._uses[key].unused(exhibit)
        inside = [name.removeprefix(f"{paper.package}.").replace(".", "/") for name in modules]
        files = {file for name in inside for file in (f"{name}.py", f"{name}/__init__.py")}
        return files & self._folder("paper", paper.package, paper.folder()).keys()

    def _still_unused(self, paper: Paper, exhibit: str, recorded: Mapping[str, Mapping[str, str]]) -> set[str]:
        """Return the files of modules that an exhibit does not use as they are now, if they are loaded."""
        loaded = frozenset(name for name in sys.modules if _is_own(paper, name) or name in recorded["module"])
        return self._unused(paper, paper.exhibits[exhibit], loaded)

    def now(self, paper: Paper, exhibit: str, recorded: Mapping[str, Mapping[str, str]]) -> Dependencies:
        """Return the present state of everything that was recorded, and of files that came beside it."""
        return {
            "python": self._environment,
            "framework": self._framework(tuple(recorded["framework"])),
            "paper": self._of_paper(paper, exhibit, recorded),
            "project": self._project(Path(str(paper.folder()))),
            "distribution": {name: self._version(name) for name in recorded["distribution"]},
            "module": {name: self._module(name) for name in recorded["module"]},
            "data": {name: self._data(paper, name) for name in recorded["data"]},
        }

    def _of_paper(self, paper: Paper, exhibit: str, recorded: Mapping[str, Mapping[str, str]]) -> dict[str, str]:
        """Return the present files of a paper; a module that was and is not used stands as it was recorded.

        So does every one that was not used if the paper is not loaded: who asks then knows that its folder is as it was
        when it was.
        """
        present = self._folder("paper", paper.package, paper.folder())
        unused = {name: known for name, known in recorded["paper"].items() if known.startswith(_UNUSED)}
        changed = {name for name, known in unused.items() if name in present and known != f"{_UNUSED}{present[name]}"}
        ask = changed and exhibit in paper.exhibits
        used = changed - self._still_unused(paper, exhibit, recorded) if ask else set()
        still = unused.keys() - used
        return {name: unused[name] if name in still else digest for name, digest in present.items()}

    def difference(self, paper: Paper, exhibit: str, recorded: Mapping[str, Mapping[str, str]]) -> str:
        """Return what has changed since, in words; empty if nothing has."""
        return first_difference(recorded, self.now(paper, exhibit, recorded), paper.id)

    def _framework(self, files: tuple[str, ...]) -> dict[str, str]:
        """Return the present files of the rooms of some files, which most results of a run share."""
        if files not in self._rooms:
            rooms = sorted({name.split("/")[0] for name in files})
            self._rooms[files] = {name: digest for room in rooms for name, digest in self._room(room).items()}
        return self._rooms[files]

    def rooms(self, rooms: Iterable[str], distributions: Iterable[str]) -> Dependencies:
        """Return the present state of rooms of the framework and of installed distributions."""
        return {
            "python": self._environment,
            "framework": {name: digest for room in rooms for name, digest in self._room(room).items()},
            "distribution": {name: self._version(name) for name in distributions},
        }

    def _room(self, room: str) -> dict[str, str]:
        place: Traversable = files(_ROOT) / room
        return self._folder("room", room, place if place.is_dir() else files(_ROOT) / f"{room}.py")

    def _folder(self, kind: str, name: str, place: Traversable) -> dict[str, str]:
        key = (kind, name)
        if key not in self._folders:
            self._folders[key] = dict(self._contents(place, name if kind == "room" else ""))
        return self._folders[key]

    def _project(self, folder: Path) -> dict[str, str]:
        """Return name and digest of what the nearest project file above a folder says; empty if there is none."""
        if folder not in self._projects:
            try:
                found = project_text(folder)
            except ProjectError as error:
                found = ("project file", str(error))
            digest = hashlib.sha256(found[1].encode()).hexdigest()[:_LENGTH] if found else ""
            self._projects[folder] = {found[0]: digest} if found else {}
        return self._projects[folder]

    def _version(self, distribution: str) -> str:
        if distribution not in self._versions:
            try:
                self._versions[distribution] = importlib.metadata.version(distribution)
            except importlib.metadata.PackageNotFoundError:
                self._versions[distribution] = _GONE
        return self._versions[distribution]

    def _module(self, name: str) -> str:
        if name not in self._modules:
            path = file_of(name)
            places = (path, *path.parents) if path is not None else ()  # a module in an archive has that as a parent
            file = next((place for place in places if place.is_file()), None)
            self._modules[name] = self._digest(file) if file is not None else _GONE
        return self._modules[name]

    def _data(self, paper: Paper, name: str) -> str:
        """Return the digest of a data file, or of all files in a folder of data."""
        place = Path(str(paper.folder())) / name
        try:
            if not place.exists():
                return _GONE
            return hashlib.sha256(repr(list(self._contents(place, place.name))).encode()).hexdigest()[:_LENGTH]
        except OSError as error:
            return f"cannot be read: {error.strerror}"

    def _contents(self, place: Traversable, name: str) -> Iterator[tuple[str, str]]:
        """Yield name and digest of a file, or of every file in a folder in alphabetical order."""
        if place.is_dir():
            for entry in sorted(place.iterdir(), key=lambda entry: entry.name):
                if entry.name != "__pycache__" and not entry.name.startswith(".") and not _ABOUT.fullmatch(entry.name):
                    yield from self._contents(entry, f"{name}/{entry.name}".lstrip("/"))
        elif place.is_file():
            yield name, self._digest(place)

    def _digest(self, file: Traversable) -> str:
        if isinstance(file, Path):
            self.newest = max(self.newest, file.stat().st_mtime)
        return hashlib.sha256(file.read_bytes()).hexdigest()[:_LENGTH]


def first_difference(
    recorded: Mapping[str, Mapping[str, str]], now: Mapping[str, Mapping[str, str]], paper: str = ""
) -> str:
    """Return in words what has changed between two states; empty if nothing has."""
    for group, present in now.items():
        before = recorded.get(group, {})
        if before != present:
            name = next(name for name in (*before, *present) if before.get(name) != present.get(name))
            return _said(group, name, before.get(name), present.get(name), paper)
    return ""


def _is_own(paper: Paper, module: str) -> bool:
    """Say whether a module's file counts with the paper's folder."""
    inside = module == paper.package or module.startswith(f"{paper.package}.")
    return inside and not _ABOUT.fullmatch(f"{module.rpartition('.')[2]}.py")


def _said(group: str, name: str, before: str | None, now: str | None, paper: str) -> str:
    if group == "distribution":
        return f"{name} was {before}, is {now}"
    if group == "python":
        subject = "Python" if name == "version" else name
        return f"{subject} was '{before}', is '{now}'"
    where = {"framework": f"{_ROOT}/{name}", "paper": f"{paper}/{name}", "module": f"module {name}"}.get(group, name)
    if before is None:
        return f"{where} is new"
    return f"{where} {'is gone' if now in {None, _GONE} else 'has changed'}"
