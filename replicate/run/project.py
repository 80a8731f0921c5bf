"""A project: a folder with a project file that says which papers it holds, what its report is called, what is where.

The file is ``replicate.toml``, or the table ``[tool.replicate]`` of a ``pyproject.toml``. It is found from the current
folder upwards. All paths in it are relative to its folder::

    title = "My replications"
    intro = "What a reader should know first."     # Markdown
    methods = "methods.md"                         # a page on how the numbers are computed
    papers = ["papers"]                            # folders of papers, or names of installed ones
    accepted = "accepted"                          # the state that diff and check compare with
    out = "build"
    language = "en"                                # also de, or a file such as fr.toml

    [theme]                                        # colours of the report
    accent = "#0b5cad"
"""

from __future__ import annotations

import contextlib
import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from replicate.errors import ProjectError, ReplicateError
from replicate.languages import Language, language
from replicate.plain_text import parse_toml, read_text, toml_line

FILE = "replicate.toml"
PYPROJECT = "pyproject.toml"

_TEXTS = ("title", "intro", "language")
_PATHS = ("accepted", "out")
_KEYS = ("title", "intro", "methods", "papers", "bundled", "accepted", "out", "language", "theme")
_THEME = ("accent", "paper", "ink")
_COLOUR = re.compile(r"#[0-9a-fA-F]{3}([0-9a-fA-F]{3})?")


@dataclass(frozen=True)
class Project:
    """A project file, read and checked.

    Attributes
    ----------
    root, file
        Its folder, and the file itself.
    methods
        A Markdown file; ``None`` if the report has no page on methods.
    papers
        Folders that hold papers.
    installed
        Ids of installed papers that belong to the project.
    bundled
        Whether the papers that come with this package belong to it.
    accepted, out
        Folder of the accepted state, and of what a run leaves behind.
    theme
        Colours by name: ``accent``, ``paper``, ``ink``.
    """

    root: Path
    file: Path
    title: str = ""
    intro: str = ""
    methods: Path | None = None
    papers: tuple[Path, ...] = ()
    installed: tuple[str, ...] = ()
    bundled: bool = False
    accepted: Path = Path("accepted")
    out: Path = Path("build")
    language: Language = field(default_factory=language)
    theme: dict[str, str] = field(default_factory=dict)


def find_project(start: Path | None = None) -> Project | None:
    """Return the project of a folder: the nearest project file in it or above; ``None`` if there is none.

    Parameters
    ----------
    start
        Default: the current folder.

    Raises
    ------
    ProjectError
        If the file is malformed; the message names file, line and what is allowed.
    """
    here = (start or Path()).resolve()
    for folder in (here, *here.parents):
        pyproject = folder / PYPROJECT
        also = pyproject.is_file() and "replicate" in _tables(pyproject).get("tool", {})
        if (folder / FILE).is_file():
            if also:
                why = f"[tool.replicate] beside {FILE}: there are two project files; allowed: one of them"
                raise _wrong(pyproject, "", why)
            return read_project(folder / FILE)
        if also:
            return read_project(pyproject)
    return None


def project_text(start: Path) -> tuple[str, str] | None:
    """Return name and text of what the nearest project file says, spelled in one way, without comments.

    Raises
    ------
    ProjectError
        If it is not readable.
    """
    here = start.resolve()
    for folder in (here, *here.parents):
        for name in (FILE, PYPROJECT):
            if (folder / name).is_file():
                said = _tables(folder / name)
                said = said if name == FILE else said.get("tool", {}).get("replicate")
                if said is not None:
                    return name, json.dumps(said, sort_keys=True, default=str)
    return None


def read_project(path: Path) -> Project:
    """Read a project file.

    Raises
    ------
    ProjectError
        If it is malformed, or names a file or folder that does not exist.
    """
    data: Any = _tables(path)
    if path.name == PYPROJECT:
        data = data["tool"]["replicate"]
        if not isinstance(data, dict):
            raise _wrong(path, "", "[tool.replicate] is not a table")
    for key in data:
        if key not in _KEYS:
            raise _wrong(path, key, f"'{key}' is unknown; allowed: {', '.join(_KEYS)}")
    for key in (*_TEXTS, *_PATHS, "methods"):
        if not isinstance(data.get(key, ""), str):
            raise _wrong(path, key, f"{key} is {data[key]!r}; expected: a text in quotes")
    if not isinstance(data.get("bundled", False), bool):
        raise _wrong(path, "bundled", f"bundled is {data['bundled']!r}; expected: true or false")
    root = path.parent
    methods = root / data["methods"] if data.get("methods") else None
    if methods is not None and not methods.is_file():
        raise _wrong(path, "methods", f"methods: there is no file {data['methods']}")
    folders, installed = _papers(path, data)
    out = root / (data.get("out") or "build")
    for taken in (*folders, root / (data.get("accepted") or "accepted")):
        if taken.resolve() in (out.resolve(), *out.resolve().parents):
            why = f"out is {data.get('out', 'build')!r}, inside {taken.name}/; allowed: a folder of its own"
            raise _wrong(path, "out", why)
    if out.resolve() in (root.resolve(), *root.resolve().parents):
        why = f"out is {data['out']!r}, which holds the project itself; allowed: a folder of its own"
        raise _wrong(path, "out", why)
    return Project(
        root,
        path,
        title=data.get("title", ""),
        intro=data.get("intro", ""),
        methods=methods,
        papers=folders,
        installed=installed,
        bundled=data.get("bundled", False),
        accepted=root / (data.get("accepted") or "accepted"),
        out=out,
        language=_language(path, data.get("language", "en")),
        theme=_theme(path, data.get("theme", {})),
    )


def _papers(path: Path, data: dict[str, Any]) -> tuple[tuple[Path, ...], tuple[str, ...]]:
    """Tell folders from names of installed papers: a name is one if there is no such folder."""
    names = data.get("papers", [] if data.get("bundled") else ["papers"])
    if not isinstance(names, list) or not all(isinstance(name, str) and name for name in names):
        raise _wrong(path, "papers", f"papers is {names!r}; expected: a list of folders or names of installed papers")
    folders, installed = [], []
    for name in names:
        if (path.parent / name).is_dir():
            folders.append(path.parent / name)
        elif re.fullmatch(r"[A-Za-z][\w.-]*", name) and name != "papers":
            installed.append(name)
        elif "papers" in data:
            raise _wrong(path, "papers", f"papers: there is no folder {name}")
    return tuple(folders), tuple(installed)


def _language(path: Path, given: str) -> Language:
    """Return a language that comes with this package, or that of a file beside the project file."""
    tag = str(path.parent / given) if given.endswith(".toml") else given
    with contextlib.suppress(ReplicateError):
        return language(tag)
    try:
        return language(tag, f"{place_of(path, 'language')}: language")  # which says where it is asked for
    except ReplicateError as error:
        raise ProjectError(str(error)) from error


def _theme(path: Path, theme: object) -> dict[str, str]:
    if not isinstance(theme, dict):
        raise _wrong(path, "theme", f"theme is {theme!r}; expected: a table of colours")
    for name, colour in theme.items():
        if name not in _THEME or not isinstance(colour, str) or not _COLOUR.fullmatch(colour):
            allowed = f"{', '.join(_THEME)}, each a colour such as '#0b5cad'"
            raise _wrong(path, f"theme.{name}", f"theme: {name} = {colour!r}; allowed: {allowed}")
    return theme


def _tables(path: Path) -> dict[str, Any]:
    return parse_toml(read_text(path, path.name, ProjectError), path.name, ProjectError)


def _wrong(path: Path, key: str, why: str) -> ProjectError:
    return ProjectError(f"{place_of(path, *key.split('.'))}: {why}")


def place_of(path: Path, *keys: str) -> str:
    """Return file and line of a value in a project file, as messages name it."""
    text = read_text(path, path.name, ProjectError)
    return f"{path.name}:{toml_line(text, *(('tool', 'replicate') if path.name == PYPROJECT else ()), *keys)}"
