"""Compare a whole run with the accepted state."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Literal

from replicate.diff.accepted import (
    ENDINGS,
    FigureState,
    State,
    TableState,
    files_of,
    is_picture,
    present_state,
    read_state,
)
from replicate.diff.cells import CellChange, compare_cells
from replicate.diff.changes import Change
from replicate.diff.checksums import altered, read_checksums
from replicate.diff.words import Words, compare_words
from replicate.errors import AcceptedStateError
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, errors_of
from replicate.figures.comparing import compare_records
from replicate.figures.pair import Pair
from replicate.run.outcome import Outcome

Kind = Literal["table", "claims", "figure", ""]

REMOVED = "was accepted, but is no longer computed"


@dataclass(frozen=True)
class ExhibitDiff:
    """One exhibit: what changed in it, and both states.

    Attributes
    ----------
    kind
        Empty for an exhibit that no longer exists.
    unchanged
        Number of values, claims or curves that did not change.
    before
        ``None`` if there is no accepted state.
    after
        ``None`` if it was not, or could not be, computed.
    pairs
        Of a figure: every curve that both states have.
    cells
        Of a table or of claims: what is not as accepted.
    outdated
        Whether its accepted state is that of an older version, which knew less of a figure or of claims.
    unsigned
        Whether an older version accepted it, without checksums.
    restated
        Of a figure: whether all of it is as accepted, but for what is said of it.
    """

    paper: str
    exhibit: str
    kind: Kind
    changes: Sequence[Change] = ()
    unchanged: int = 0
    before: State | None = None
    after: State | None = None
    pairs: Sequence[Pair] = ()
    cells: Sequence[CellChange] = ()
    outdated: bool = False
    unsigned: bool = False
    restated: bool = False

    @property
    def name(self) -> str:
        """As on the command line."""
        return f"{self.paper}/{self.exhibit}"

    @property
    def compared(self) -> bool:
        """Whether there was something to compare, on both sides."""
        return self.before is not None and self.after is not None

    @property
    def failed(self) -> bool:
        """Whether it could not be computed."""
        return any(change.kind == "failed" for change in self.changes)

    @property
    def damaged(self) -> bool:
        """Whether its accepted state cannot be read."""
        return any(change.kind == "damaged" for change in self.changes)

    @property
    def same(self) -> str:
        """How many of its values, claims or curves did not change, in words; empty if that says nothing."""
        if not self.changes or not self.unchanged:
            return ""
        what = {"table": "value", "claims": "claim", "figure": "curve"}[self.kind or "table"]
        return f"{self.unchanged} {what}{'s' if self.unchanged > 1 else ''} unchanged"

    @property
    def texts(self) -> list[str]:
        """What changed, in words; the last sentence also says how much did not."""
        texts = [change.text for change in self.changes]
        return [*texts[:-1], f"{texts[-1]}; {self.same}"] if self.same else texts


@dataclass(frozen=True)
class Comparison:
    """All exhibits of a run, in the order of the papers."""

    exhibits: list[ExhibitDiff] = field(default_factory=list)

    @property
    def changes(self) -> list[Change]:
        """The changes of all exhibits."""
        return [change for exhibit in self.exhibits for change in exhibit.changes]

    @property
    def changed(self) -> list[ExhibitDiff]:
        """The exhibits in which something changed, or which failed."""
        return [exhibit for exhibit in self.exhibits if exhibit.changes]

    @property
    def outdated(self) -> list[ExhibitDiff]:
        """The exhibits whose accepted state says less than a new one would; accepting writes them anew."""
        return [exhibit for exhibit in self.exhibits if exhibit.outdated]

    @property
    def unsigned(self) -> list[ExhibitDiff]:
        """The exhibits that were accepted without checksums; accepting anything of their paper writes them down."""
        return [exhibit for exhibit in self.exhibits if exhibit.unsigned]

    @property
    def unchanged(self) -> list[ExhibitDiff]:
        """The exhibits that are as accepted."""
        return [exhibit for exhibit in self.exhibits if not exhibit.changes]

    @property
    def compared(self) -> int:
        """Number of exhibits with something to compare."""
        return sum(exhibit.compared for exhibit in self.exhibits)

    @property
    def lines(self) -> list[str]:
        """The changes of all exhibits in words, one line each."""
        return [f"{exhibit.name}: {text}" for exhibit in self.exhibits for text in exhibit.texts]

    @property
    def broken(self) -> bool:
        """Whether an exhibit could not be computed, or its accepted state not be read."""
        return any(exhibit.failed or exhibit.damaged for exhibit in self.exhibits)


def compare(outcome: Outcome, folder: Path, known: Collection[str] | None = None) -> Comparison:
    """Compare what a run computed with the accepted state.

    Parameters
    ----------
    folder
        The accepted folder, one folder per paper in it. If the run was complete, an accepted exhibit that no
        longer exists is a change, too. So is an accepted file that is damaged: it keeps no other exhibit from
        being compared.
    known
        Ids of all papers that there are: accepted exhibits of any other are reported as no longer computed. Not given:
        nothing is said of other papers.
    """
    sums_of = cache(read_checksums)
    exhibits = [_compare(outcome, result, folder, sums_of) for result in outcome.results.values()]
    if outcome.complete:
        exhibits += _no_longer_computed(outcome, folder, known)
    return Comparison(exhibits)


def _compare(
    outcome: Outcome, result: Result, folder: Path, sums_of: Callable[[Path], Mapping[str, str] | None]
) -> ExhibitDiff:
    paper, exhibit = result.paper, result.exhibit
    kind: Kind = "table"
    if isinstance(result, FigureResult | ClaimsResult):
        kind = "figure" if isinstance(result, FigureResult) else "claims"
    errors = errors_of(result)
    if errors:
        failed = [
            Change(paper, exhibit, "failed", f"{f'{part}: ' if part else ''}could not be computed: {why}", part)
            for part, why in errors.items()
        ]
        return ExhibitDiff(paper, exhibit, kind, failed)
    after = present_state(outcome, result)
    try:
        before = read_state(folder, paper, exhibit, type(result))
        sums = sums_of(folder / paper)
    except AcceptedStateError as error:
        damaged = Change(paper, exhibit, "damaged", f"its accepted state is damaged: {error}")
        return ExhibitDiff(paper, exhibit, kind, [damaged], after=after)
    if isinstance(before, str):
        missing = Change(paper, exhibit, "new", f"has no accepted state: {paper}/{before} is missing")
        return ExhibitDiff(paper, exhibit, kind, [missing], after=after)
    if isinstance(before, FigureState) and isinstance(after, FigureState):
        diff = _compare_figures(paper, exhibit, before, after, folder / paper / f"{exhibit}.png")
    else:
        assert isinstance(before, TableState)  # noqa: S101  -- `read_state` was told the kind
        assert isinstance(after, TableState)  # noqa: S101
        diff = _compare_tables(paper, exhibit, kind, before, after)
    edited = [] if sums is None else _altered(paper, exhibit, folder / paper, sums)
    restated = diff.restated and not edited
    return replace(diff, changes=diff.changes or edited, unsigned=sums is None, restated=restated)


def _compare_figures(paper: str, exhibit: str, before: FigureState, after: FigureState, picture: Path) -> ExhibitDiff:
    found = compare_records(before.record, after.record)
    changes = [Change.of_figure(paper, exhibit, difference) for difference in found.differences]
    changes += _changes_of_words(paper, exhibit, before.words, after.words)
    shown = f"{paper}/{picture.name}"
    if not picture.is_file():
        changes.append(Change(paper, exhibit, "new", f"its picture, {shown}, is missing", "picture"))
    elif not is_picture(picture):
        changes.append(Change(paper, exhibit, "new", f"its picture, {shown}, is damaged", "picture"))
    older = before.record.outdated and not after.record.outdated
    old = older or before.words is None
    only_words = before.version == after.version and all(change.kind == "words" for change in changes)
    said = only_words and (bool(changes) or not older)
    return ExhibitDiff(
        paper, exhibit, "figure", changes, found.unchanged, before, after, found.pairs, outdated=old, restated=said
    )


def _compare_tables(paper: str, exhibit: str, kind: Kind, before: TableState, after: TableState) -> ExhibitDiff:
    cells, unchanged = compare_cells(before.cells, after.cells)
    changes = [cell.change(paper, exhibit) for cell in cells]
    if before.words is None:
        text = f"what is said of it has no accepted state: {paper}/{exhibit}.json is missing"
        changes.append(Change(paper, exhibit, "new", text, "words"))
    changes += _changes_of_words(paper, exhibit, before.words, after.words, {cell.key[0] for cell in cells})
    said, found = (None if state.words is None else state.words.evidence for state in (before, after))
    old = before.words is not None and said is None and found is not None
    return ExhibitDiff(paper, exhibit, kind, changes, unchanged, before, after, cells=cells, outdated=old)


def _changes_of_words(
    paper: str, exhibit: str, accepted: Words | None, present: Words | None, told: Collection[str] = ()
) -> Iterator[Change]:
    """Yield what is said otherwise of an exhibit; nothing where no words were accepted."""
    if accepted is None:
        return
    for about, text, old, new in compare_words(accepted, present or Words({}), told):
        yield Change(paper, exhibit, "words", text, about, old, new)


def _altered(paper: str, exhibit: str, folder: Path, sums: Mapping[str, str]) -> list[Change]:
    """Return a change for each accepted file that an edit or a merge altered, which nothing else told."""
    return [
        Change(
            paper, exhibit, "altered", f"{paper}/{name} is not as it was accepted: an edit or a merge altered it", name
        )
        for name in altered(files_of(folder, exhibit), sums)
    ]


def _no_longer_computed(outcome: Outcome, folder: Path, known: Collection[str] | None) -> list[ExhibitDiff]:
    """Return the accepted exhibits that the papers do not have any more, and those of papers that are gone."""
    papers = [paper.id for paper in outcome.papers]
    gone = []
    if known is not None:
        there = {*papers, *known}
        gone = [path.name for path in sorted(folder.glob("*/")) if path.name not in there and path.name[0] != "."]
    found = {
        (paper, path.stem): None
        for paper in (*papers, *gone)
        for path in sorted((folder / paper).glob("*"))
        if path.suffix in ENDINGS
    }
    return [
        ExhibitDiff(
            paper,
            exhibit,
            "",
            [Change(paper, exhibit, "removed", REMOVED)],
            before=_former_figure(folder, paper, exhibit),
        )
        for paper, exhibit in found
        if (paper, exhibit) not in outcome.results
    ]


def _former_figure(folder: Path, paper: str, exhibit: str) -> State | None:
    """Return the accepted state of an exhibit that was a figure, to be shown; of figures alone there is a picture."""
    if not (folder / paper / f"{exhibit}.png").is_file():
        return None
    with contextlib.suppress(AcceptedStateError):
        state = read_state(folder, paper, exhibit, FigureResult)
        return None if isinstance(state, str) else state
    return None
