"""Whether the report that stands is the one that a run would write again.

It is if nothing that it is made of has changed since (the kept results and all that they depend on, the papers' folders
with their prose, the project's texts, the package and its templates, the versions of libraries) and every file of it
is as it was written. What a report was made of is kept beside the results, as data of which nothing is run; the papers
need not be loaded to compare it: which results they have follows from all this.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, astuple, dataclass
from importlib.resources import files
from pathlib import Path

from replicate.display.environment import versions
from replicate.exhibits import Paper
from replicate.report.site import Site
from replicate.resources import templates_dir
from replicate.run.cache import Cache
from replicate.run.entries import write_whole
from replicate.run.modules import distributions_used
from replicate.run.units import Unit, units_of

FILE = "report.json"
_FORM = "replicate report 2"
_PACKAGE = __name__.partition(".")[0]


@dataclass(frozen=True)
class Standing:
    """A report that has been written.

    Attributes
    ----------
    made_of
        Digest of all that it was made of.
    units
        Its results, each as paper, package, exhibit and reading.
    versions
        Of the libraries that it names.
    files
        Digest of every file by its name inside the output folder.
    said
        What the command said of it: the counts of its summary, and lines that are of no use any more.
    """

    made_of: str
    units: Sequence[Sequence[str]]
    versions: Mapping[str, str]
    files: Mapping[str, str]
    counts: Mapping[str, Mapping[str, Mapping[str, int]]]
    unused: Sequence[str]

    @property
    def results(self) -> list[Unit]:
        """The units whose results it shows."""
        return [Unit(*names) for names in self.units]


def texts_of(papers: Sequence[Paper], about: Site) -> str:
    """Return the digest of all that a report is made of besides results; to be taken before anything of it is read."""
    folders = [Path(str(files(_PACKAGE))), templates_dir(), *(Path(str(paper.folder())) for paper in papers)]
    return _digest(json.dumps([repr(about), [paper.id for paper in papers], *map(_contents, folders)]).encode())


def standing(folder: Path, papers: Sequence[Paper], texts: str) -> Standing | None:
    """Return the report that stands in a folder, if a run of these papers would write the same again.

    Parameters
    ----------
    texts
        What `texts_of` returns.
    """
    try:
        kept = json.loads((folder / "cache" / FILE).read_text(encoding="utf-8"))
        if kept.pop("form") != _FORM:
            return None
        found = Standing(**kept)
        if found.versions != versions(found.versions):
            return None
        if found.made_of != _made_of(folder, papers, found.results, texts):
            return None
        whole = all(_digest((folder / name).read_bytes()) == digest for name, digest in found.files.items())
    except (OSError, ValueError, TypeError, AttributeError, KeyError, RecursionError):
        return None
    return found if whole else None


def keep(
    folder: Path,
    papers: Sequence[Paper],
    texts: str,
    written: Iterable[Path],
    counts: Mapping[str, Mapping[str, Mapping[str, int]]],
    unused: Sequence[str],
) -> None:
    """Keep what the report of some papers was made of; a full disk costs the next run time, nothing else."""
    units = [unit for paper in papers for exhibit in paper.exhibits.values() for unit in units_of(paper, exhibit)]
    if {unit.paper for unit in units} != {paper.id for paper in papers}:
        return  # of a paper without results, nothing says what its modules import
    with contextlib.suppress(OSError):
        made_of = _made_of(folder, papers, units, texts)
        if made_of is None:
            return
        digests = {path.relative_to(folder).as_posix(): _digest(path.read_bytes()) for path in sorted(written)}
        stamp = versions(distributions_used(paper.package for paper in papers))
        names = [astuple(unit) for unit in units]
        found = Standing(made_of, names, stamp, digests, counts, unused)
        write_whole(folder / "cache" / FILE, json.dumps({"form": _FORM, **asdict(found)}).encode())


def _made_of(folder: Path, papers: Sequence[Paper], units: Iterable[Unit], texts: str) -> str | None:
    """Return the digest of all that a report is made of; ``None`` if one of the results is not kept."""
    cache = Cache(folder / "cache")
    owner = {paper.id: paper for paper in papers}
    parts = [texts]
    for unit in units:
        state = cache.state(owner[unit.paper], unit)
        if not state:
            return None
        parts += [str(unit), state]
    return _digest(json.dumps(parts).encode())


def _contents(place: Path) -> str:
    """Return the digest of every file in a folder, with its name."""
    found = [
        [path.relative_to(place).as_posix(), _digest(path.read_bytes())]
        for path in sorted(place.rglob("*"))
        if path.suffix != ".pyc" and path.is_file()
    ]
    return _digest(json.dumps(found).encode())


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
