"""Whether the report that stands is the one that a run would write again, and which of its files are.

A report is if nothing that it is made of has changed since (the kept results and all that they depend on, the papers'
folders with their prose, the project's texts, the package and its templates, the versions of libraries) and every file
of it is as it was written. The pages and data of a paper are if that holds of what is the paper's.

What a report was made of is kept beside the results, signed, as data of which nothing is run. The papers need not be
loaded to compare it: which results they have follows from all this.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, astuple, dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from replicate.display.environment import versions
from replicate.exhibits import Paper
from replicate.report.site import Site
from replicate.resources import templates_dir
from replicate.run.cache import Cache
from replicate.run.entries import write_whole
from replicate.run.signing import is_signed, signature
from replicate.run.units import Unit, units_of
from replicate.staging import files_of

FILE = "report.json"
_FORM = "replicate report 3"
_PACKAGE = __name__.partition(".")[0]


@dataclass(frozen=True)
class Standing:
    """A report that has been written.

    Attributes
    ----------
    texts
        By paper: digest of what its part of the report was made of besides results.
    results
        By paper: digest of the results and of all that they depend on.
    units
        Its results, each as paper, package, exhibit and reading.
    versions
        Of the libraries that it names.
    files
        Digest of every file by its name inside the output folder.
    said
        What the command said of it: the counts of its summary, and lines that are of no use any more.
    """

    texts: Mapping[str, str]
    results: Mapping[str, str]
    units: Sequence[Sequence[str]]
    versions: Mapping[str, str]
    files: Mapping[str, str]
    counts: Mapping[str, Mapping[str, Mapping[str, int]]]
    unused: Sequence[str]

    @property
    def shown(self) -> list[Unit]:
        """The units whose results it shows."""
        return [Unit(*names) for names in self.units]

    def of(self, paper: str) -> tuple[str | None, str | None]:
        """Return what a paper's part of it was made of."""
        return self.texts.get(paper), self.results.get(paper)


@dataclass(frozen=True)
class Material:
    """What each paper's part of a report is made of.

    Attributes
    ----------
    texts
        What `texts_of` returns.
    results
        By paper: digest of its results and of all that they depend on. A paper of which a result is not kept is left
        out, and so is one without results: nothing says what its modules import.
    """

    texts: Mapping[str, str]
    results: Mapping[str, str]


@dataclass(frozen=True)
class KeptFiles:
    """Takes files of a paper from the report that stands: a `replicate.display.keeping.Keep`.

    Attributes
    ----------
    folder
        Of the output.
    files
        Digest of every file by its name inside that.
    """

    folder: Path
    files: Mapping[str, str]

    def __call__(self, name: str, make: Callable[[], str], of: str = "") -> str:  # noqa: ARG002 -- as a `Keep`
        """Return the text of a file if it is as it was written, or have it made."""
        with contextlib.suppress(OSError):
            content = (self.folder / name).read_bytes() if name in self.files else b""
            if _digest(content) == self.files.get(name):
                return content.decode()
        return make()


def texts_of(papers: Sequence[Paper], about: Site) -> dict[str, str]:
    """Return what a report is made of besides results, as a digest by paper; to be taken before it is read."""
    package = Path(str(files(_PACKAGE)))
    shared = [repr(about), versions(), _contents(package, but="papers"), _contents(templates_dir())]
    return {
        paper.id: _digest(json.dumps([*shared, paper.id, _contents(Path(str(paper.folder())))]).encode())
        for paper in papers
    }


def read_note(folder: Path) -> Standing | None:
    """Return what the last report in a folder was made of; ``None`` if no run of this user noted it."""
    try:
        kept = json.loads((folder / "cache" / FILE).read_text(encoding="utf-8"))
        form, sign = kept.pop("form"), kept.pop("signature")
        return Standing(**kept) if form == _FORM and is_signed(_text(kept), sign) else None
    except (OSError, ValueError, TypeError, AttributeError, KeyError, RecursionError):
        return None


def standing(folder: Path, papers: Sequence[Paper], texts: Mapping[str, str], note: Standing | None) -> Standing | None:
    """Return the report that stands in a folder, if a run of these papers would write the same again.

    Parameters
    ----------
    texts
        What `texts_of` returns.
    note
        What `read_note` returns.

    Raises
    ------
    OutputError
        If what is known of the files that earlier runs wrote is damaged.
    """
    if note is None or note.versions != versions(note.versions) or [*note.texts.items()] != [*texts.items()]:
        return None
    if note.files.keys() != {*files_of(folder, "report")}:  # a run with other options has left more
        return None
    if note.results != material(folder, papers, note.shown, texts).results:
        return None
    try:
        whole = all(_digest((folder / name).read_bytes()) == digest for name, digest in note.files.items())
    except OSError:
        return None
    return note if whole else None


def material(folder: Path, papers: Iterable[Paper], units: Iterable[Unit], texts: Mapping[str, str]) -> Material:
    """Return what a report on papers is made of, of these units."""
    cache = Cache(folder / "cache")
    owner = {paper.id: paper for paper in papers}
    states: dict[str, list[str]] = {id: [] for id in owner}
    for unit in units:
        states[unit.paper].append(f"{unit}: {state}" if (state := cache.state(owner[unit.paper], unit)) else "")
    results = {id: _digest(json.dumps(found).encode()) for id, found in states.items() if found and all(found)}
    return Material(texts, results)


def units_shown(papers: Iterable[Paper]) -> list[Unit]:
    """Return the units whose results a report on loaded papers shows."""
    return [unit for paper in papers for exhibit in paper.exhibits.values() for unit in units_of(paper, exhibit)]


def kept_files(folder: Path, note: Standing | None, now: Material) -> dict[str, KeptFiles]:
    """Return what takes files of a paper from the report that stands, by paper, for those of which nothing has changed.

    Parameters
    ----------
    note
        What `read_note` returns.
    """
    if note is None:
        return {}
    same = [id for id, digest in now.results.items() if note.of(id) == (now.texts[id], digest)]
    return dict.fromkeys(same, KeptFiles(folder, note.files))


def keep(
    folder: Path,
    made_of: Material,
    units: Iterable[Unit],
    stamp: Mapping[str, str],
    written: Iterable[Path],
    counts: Mapping[str, Mapping[str, Mapping[str, int]]],
    unused: Sequence[str],
) -> None:
    """Note what a report was made of; a full disk costs the next run time, nothing else."""
    if made_of.results.keys() != made_of.texts.keys():
        return
    with contextlib.suppress(OSError):
        digests = {path.as_posix(): _digest((folder / path).read_bytes()) for path in sorted(written)}
        names = [list(astuple(unit)) for unit in units]
        found = asdict(Standing(made_of.texts, made_of.results, names, stamp, digests, counts, unused))
        note = {"form": _FORM, "signature": signature(_text(found)), **found}
        write_whole(folder / "cache" / FILE, json.dumps(note).encode())


def _text(note: Mapping[str, Any]) -> bytes:
    return json.dumps(note, sort_keys=True).encode()


def _contents(place: Path, but: str = "") -> str:
    """Return the digest of every file in a folder, with its name, but for those in one of its folders."""
    found = [
        [path.relative_to(place).as_posix(), _digest(path.read_bytes())]
        for path in sorted(place.rglob("*"))
        if path.suffix != ".pyc" and path.relative_to(place).parts[0] != but and path.is_file()
    ]
    return _digest(json.dumps(found).encode())


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
