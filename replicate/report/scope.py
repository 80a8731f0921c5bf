"""Which files of a report belong to which paper: a report on some papers leaves the pages of the others as they are."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Scope:
    """The papers that a run is about, and the others that the report has already.

    Attributes
    ----------
    chosen, others
        Ids.
    """

    chosen: Collection[str]
    others: Collection[str] = ()

    @classmethod
    def among(cls, chosen: Collection[str], pages: Iterable[str], known: Collection[str]) -> Scope:
        """Return the scope of a run on some papers, beside the pages that the report has of the known ones.

        Examples
        --------
        >>> Scope.among({"khan"}, ["index.html", "khan.html", "ali.html"], ["ali", "khan"])
        Scope(chosen={'khan'}, others={'ali'})
        """
        return cls(chosen, {owner_of(page, known) for page in pages} - {"", *chosen})

    def renews(self, name: str) -> bool:
        """Whether the run writes a file of the report anew, by its name inside the output folder.

        Examples
        --------
        >>> scope = Scope({"khan"}, {"ali"})
        >>> [scope.renews(name) for name in ("results.csv", "report/index.html", "report/khan.html", "report/ali.html")]
        [True, True, True, False]
        >>> scope.renews("figures/ali/fig-1.svg"), scope.renews("report/ali-part-2.html")
        (False, False)
        >>> scope.renews("khan.html"), scope.renews("ali.html")
        (True, False)
        """
        room, _, rest = name.partition("/")
        if not rest and room.endswith(".html"):
            return room.removesuffix(".html") not in self.others
        if room in ("tables", "figures"):
            return rest.partition("/")[0] not in self.others
        if room == "report":
            return owner_of(rest, (*self.chosen, *self.others)) not in self.others
        return True

    def prune(self, folder: Path) -> list[Path]:
        """Remove the files of an output folder that the run does not renew; return the others, relative to it."""
        files = [path for path in folder.rglob("*") if path.is_file()]
        for path in files:
            if not self.renews(path.relative_to(folder).as_posix()):
                path.unlink()
        return [path.relative_to(folder) for path in files if path.exists()]


def owner_of(page: str, papers: Iterable[str]) -> str:
    """Return the paper whose page it is, empty if it is of the whole report; of two that fit, the longer id."""
    fits = [id for id in papers if page == f"{id}.html" or page.startswith(f"{id}-")]
    return max(fits, key=len, default="")
