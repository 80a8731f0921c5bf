"""Find papers: those that come with this package, and those of installed packages.

An installed package adds a paper with an entry point in the group ``replicate.papers`` that names its `Paper`, for
example ``mypaper = "mypaper:paper"``. Papers in a folder need not be installed: `replicate.run.paper_folders`.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import inspect
import pkgutil
import re
import sys
import sysconfig
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from replicate.errors import TERMINATED, PaperDefinitionError, UnknownPaperError
from replicate.exhibits import Exhibit, Paper
from replicate.exhibits.file_names import display_name
from replicate.run import alarm, exits
from replicate.run.alarm import OverdueError, alarmed
from replicate.run.exits import only_ours
from replicate.run.limits import IMPORT_TIMEOUT

ENTRY_POINTS = "replicate.papers"
_HERE = {__file__, alarm.__file__, exits.__file__}
_PAPER = str(inspect.getsourcefile(Paper))
_CORE = str(Path(_PAPER).parents[1])
_BUNDLED = str(Path(_CORE, "papers"))
_STANDARD, _SITE = sysconfig.get_path("stdlib"), "site-packages"


@dataclass(frozen=True)
class Found:
    """A paper, or why a package that should be one cannot be used.

    Attributes
    ----------
    name
        The paper's id; of one that cannot be used, the name of its package or entry point.
    """

    name: str
    where: str
    paper: Paper | None = None
    error: str = ""


def bundled_papers() -> list[Found]:
    """Return the papers that come with this package."""
    import replicate.papers as home

    names = [module.name for module in pkgutil.iter_modules(home.__path__, f"{home.__name__}.") if module.ispkg]
    return [found_as(name, name, name) for name in sorted(names)]


def installed_papers() -> list[Found]:
    """Return the papers of installed packages."""
    found = []
    for point in sorted(importlib.metadata.entry_points(group=ENTRY_POINTS)):
        where = f"entry point '{point.name}'"
        try:
            with importing(f"{where}: {point.value}"):
                found.append(checked(point.name, where, point.load()))
        except PaperDefinitionError as error:
            found.append(Found(point.name, where, error=str(error)))
    return found


def found_as(name: str, module: str, where: str) -> Found:
    """Import a module and return the paper that it defines, or why it defines none."""
    try:
        with importing(where):
            return checked(name.rpartition(".")[2], where, getattr(importlib.import_module(module), "paper", None))
    except PaperDefinitionError as error:
        return Found(name.rpartition(".")[2], where, error=str(error))


def checked(name: str, where: str, paper: object) -> Found:
    """Return what a module calls its paper, if it is one."""
    if not isinstance(paper, Paper):
        return Found(name, where, error=f"{where}: defines no 'paper' of type replicate.exhibits.Paper")
    return Found(paper.id, where, paper)


def find_exhibit(paper: Paper, id: str) -> Exhibit:
    """Return one exhibit of a loaded paper.

    Raises
    ------
    UnknownPaperError
        If the paper has none of this name; the message lists those it has.
    """
    if id not in paper.exhibits:
        msg = f"{paper.id} has no exhibit '{id}'; known: {', '.join(paper.exhibits) or 'none'}"
        raise UnknownPaperError(msg)
    return paper.exhibits[id]


@contextmanager
def importing(what: str) -> Iterator[None]:
    """Report whatever a paper's own code raises in one line, with the file and line; also that it ends the program.

    The exit status is ours alone: a module that exits while it is imported must not end a run as if all were well.
    """
    try:
        with only_ours(), alarmed(IMPORT_TIMEOUT):
            yield
    except KeyboardInterrupt:
        raise
    except PaperDefinitionError as error:
        place = _defined_at(error)
        if not place:
            raise
        msg = f"{place}: {error}"
        raise PaperDefinitionError(msg) from error
    except BaseException as error:
        if isinstance(error, SystemExit) and error.code == TERMINATED:
            raise
        if isinstance(error, SyntaxError) and error.filename:
            file, line, reason = error.filename, error.lineno, error.msg
        else:
            frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename not in _HERE]
            file, line = _raised_at(frames, error) or (what, 0)
            text = " ".join(str(error).split())
            ends = f"it tries to end the program, with status {text or 0}"
            said = text if isinstance(error, OverdueError) else f"{type(error).__name__}: {text}"
            reason = ends if isinstance(error, SystemExit) else said
        msg = f"{what} cannot be loaded: {display_name(Path(file))}:{line}: {reason}"
        raise PaperDefinitionError(msg) from error


def _raised_at(frames: list[traceback.FrameSummary], error: BaseException) -> tuple[str, int] | None:
    """Return file and line where an import failed: for a listed module that does not exist, the line that lists it."""
    outside = [frame for frame in frames if not frame.filename.startswith("<") and not _is_standard(frame.filename)]
    own = [frame for frame in outside if _SITE not in frame.filename and not _is_core(frame.filename)] or outside
    place = (own[-1].filename, own[-1].lineno or 0) if own else None
    if isinstance(error, ModuleNotFoundError) and error.name and (place is None or place[0] == _PAPER):
        package, _, module = error.name.rpartition(".")
        file = getattr(sys.modules.get(package), "__file__", None)
        if file:
            lines = Path(file).read_text(encoding="utf-8").splitlines()
            quoted = re.compile(rf"""["']{re.escape(module)}["']""")
            listed = (number for number, line in enumerate(lines, 1) if quoted.search(line))
            return file, next(listed, 1)
    return place


def _is_core(file: str) -> bool:
    return file.startswith(_CORE) and not file.startswith(_BUNDLED)


def _is_standard(file: str) -> bool:
    return file.startswith(_STANDARD) and _SITE not in file


def _defined_at(error: PaperDefinitionError) -> str:
    """Return file and line of the paper's own code that made a wrong definition, empty if it is none of its lines."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if frame.name == "<module>"]
    return f"{display_name(Path(own[-1].filename))}:{own[-1].lineno}" if own else ""
