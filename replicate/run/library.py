"""The papers within a command's reach, and which of them it means.

A bare command inside a project means the project's papers. ``--papers DIR`` means those in a folder, ``--bundled``
those that come with this package. A paper that is named is looked for in all of them and among the installed ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from replicate.errors import PaperDefinitionError, ProjectError, ReplicateError, UnknownPaperError
from replicate.exhibits import Paper
from replicate.exhibits.definitions import check_id
from replicate.run.discovery import Found, bundled_papers, find_exhibit, importing, installed_papers
from replicate.run.paper_folders import papers_in
from replicate.run.project import Project, place_of

Selection = list[tuple[str, str]]


@dataclass
class Library:
    """The papers within reach.

    Attributes
    ----------
    project
        The project the command runs in.
    folders
        Folders of papers named on the command line.
    bundled
        Whether the command means the bundled papers.
    broken
        Filled while papers are loaded: one line for each that is meant and cannot be used.
    """

    project: Project | None = None
    folders: Sequence[Path] = ()
    bundled: bool = False
    broken: list[str] = field(default_factory=list)
    _packages: dict[Path, Found | None] = field(default_factory=dict)

    @cached_property
    def meant(self) -> list[Found]:
        """The papers that a bare command means; empty if nothing says which."""
        found = [one for folder in self.folders for one in self._in(folder)]
        if self.bundled:
            found += self._bundled
        if self.folders or self.bundled or self.project is None:
            return _once(found)
        found += [one for folder in self.project.papers for one in self._in(folder)]
        if self.project.bundled:
            found += self._bundled
        for name in self.project.installed:
            known = [one for one in self._installed if one.name == name]
            if not known:
                listed = ", ".join(one.name for one in self._installed) or "none"
                place = place_of(self.project.file, "papers")
                msg = f"{place}: papers: there is neither a folder nor an installed paper '{name}'; installed: {listed}"
                raise ProjectError(msg)
            found += known
        return _once(found)

    def _in(self, folder: Path) -> list[Found]:
        return papers_in(folder, self._packages)

    @cached_property
    def _bundled(self) -> list[Found]:
        return bundled_papers()

    @cached_property
    def _installed(self) -> list[Found]:
        return installed_papers()

    @cached_property
    def known(self) -> list[Found]:
        """Every paper within reach, those that a bare command means first, each package once."""
        found = list(self.meant)
        if self.project is not None and (self.folders or self.bundled):
            named = {package.name for package in self._packages}  # of two packages of one name, one can be imported
            found += [one for folder in self.project.papers for one in papers_in(folder, self._packages, named)]
        found += [*self._bundled, *self._installed]
        return _once(found)

    def ids(self) -> list[str]:
        """Return the ids of the usable papers within reach, in alphabetical order."""
        return sorted({one.name for one in self.known if one.paper is not None})

    def is_bundled(self, id: str) -> bool:
        """Whether the paper of that id is one of the bundled ones."""
        return self._found(id) in self._bundled

    def papers(self, ids: Iterable[str] = ()) -> list[Paper]:
        """Return the papers named, or those meant, with their exhibits; those that cannot be used go to `broken`.

        Raises
        ------
        UnknownPaperError
            If one of the names is unknown.
        ProjectError
            If nothing is named and nothing says which papers are meant.
        PaperDefinitionError
            If none of the papers can be used, or two have one id.
        """
        named = [self._found(id) for id in dict.fromkeys(ids)]
        wanted = named or [self._found(one.name) for one in self._all_meant()]
        papers: dict[str, Paper] = {}
        for one in wanted:
            paper = self._loaded(one)
            if paper is not None:
                check_id("paper", paper.id, [id for id in papers if id != paper.id])
                papers[paper.id] = paper
        if not papers:
            raise PaperDefinitionError(self.broken[0])
        return list(papers.values())

    def found(self) -> list[Paper]:
        """Return the papers meant as they were found, without their exhibits; none if one of them cannot be used."""
        found = [self._found(one.name).paper for one in self._all_meant()]
        usable = [paper for paper in found if paper is not None]
        return usable if len(usable) == len(found) else []

    def paper(self, id: str) -> Paper:
        """Return one paper with its exhibits.

        Raises
        ------
        UnknownPaperError, PaperDefinitionError
            If there is none of this name, or it cannot be used.
        """
        (found,) = self.papers([id])
        return found

    def select(self, names: Iterable[str]) -> tuple[list[Paper], Selection | None]:
        """Turn names as on the command line, ``PAPER`` or ``PAPER/EXHIBIT``, into papers and exhibits.

        Returns
        -------
        papers
            Loaded, each once; those meant if nothing is named.
        exhibits
            ``(paper, exhibit)`` pairs, or ``None`` if only whole papers are named.

        Raises
        ------
        UnknownPaperError, ProjectError, PaperDefinitionError
            As `papers`, and if an exhibit does not exist.
        """
        pairs = [(paper, exhibit) for paper, _, exhibit in (name.partition("/") for name in names)]
        papers = self.papers(paper for paper, _ in pairs)
        if not any(exhibit for _, exhibit in pairs):
            return papers, None
        wanted = []
        for paper in papers:
            named = [exhibit for owner, exhibit in pairs if owner == paper.id]
            whole = "" in named
            wanted += [(paper.id, find_exhibit(paper, id).id) for id in (paper.exhibits if whole else named)]
        return papers, wanted

    def _all_meant(self) -> list[Found]:
        if self.meant:
            return self.meant
        if self.project is not None:
            msg = f"{self.project.file.name}: the project has no papers yet; 'replicate new PAPER' adds one"
        elif self.folders:
            msg = f"there is no paper in {', '.join(map(str, self.folders))}"
        else:
            msg = "there is no project here; 'replicate init FOLDER' makes one, --bundled means the bundled papers"
        raise ProjectError(msg)

    def _found(self, id: str) -> Found:
        found = [one for one in self.known if one.name == id]
        same = [one for one in self.meant if one.name == id and one.paper is not None]
        packages = {one.paper.package for one in same if one.paper is not None}
        same += [one for one in self._installed if one.paper and one.name == id and one.paper.package not in packages]
        if len(same) > 1 and found[0] in same:
            first, second = same[:2]
            msg = f"{second.where}: the paper '{id}' is already defined in {first.where}; one of them needs another id"
            raise PaperDefinitionError(msg)
        if found:
            return found[0]
        msg = f"there is no paper '{id}'; known: {', '.join(self.ids()) or 'none'}"
        if Path(id, "__init__.py").is_file() or list(Path(id).glob("*/__init__.py")):
            msg += f". There is a folder {id} here: --papers . includes it"
        raise UnknownPaperError(msg)

    def _loaded(self, one: Found) -> Paper | None:
        if one.paper is None:
            self.broken.append(one.error)
            return None
        try:
            with importing(one.where):
                return one.paper.load()
        except ReplicateError as error:
            self.broken.append(str(error))
            return None


def _once(found: Iterable[Found]) -> list[Found]:
    """Return each of what was found once, at its first place: folders overlap."""
    return list({id(one): one for one in found}.values())
