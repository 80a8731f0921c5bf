"""The swap: a journal decides, and every step after it can be repeated.

    new/ holds what is to be put, old/ a second name of what stands in its place
    journal.json is renamed into place              <- the decision
    every file of new/ is renamed to its place, obsolete ones are removed
    journal.json is removed

Killed before the decision, a run has changed nothing. Killed after it, the next run finds the journal and does the same
steps again: a file that is no longer in new/ is in its place already. If a step fails (no space, no permission), the
journal is turned round, by renaming undo.json over it, and old/ is put back by the same rule.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from replicate.errors import OutputError
from replicate.staging.files import flush, folders_of, keep, move, partial_of, remove_empty, write_safely
from replicate.staging.names import checked_name
from replicate.staging.signals import deferred_signals

ROOM = ".replicate"

_JOURNAL, _UNDO, _NEW, _OLD = "journal.json", "undo.json", "new", "old"


@dataclass(frozen=True)
class Journal:
    """What a swap does.

    Attributes
    ----------
    put, remove
        Files of the target, the last one to be put last.
    kept
        Those of them that were there before.
    undo
        Whether the earlier state is being put back.
    """

    put: tuple[str, ...]
    remove: tuple[str, ...]
    kept: tuple[str, ...]
    undo: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """All files that the swap touches."""
        return (*self.put, *self.remove)


def room_of(target: Path) -> Path:
    """Return the hidden folder of runs.

    Raises
    ------
    OutputError
        If it is a link: what is thrown away would be somebody else's.
    """
    room = target / ROOM
    if room.is_symlink():
        msg = f"{room}: is a symbolic link, which no run made; remove it; nothing was written"
        raise OutputError(msg)
    return room


def new_folder(target: Path) -> Path:
    """Return the folder in which a run collects what it will put in place."""
    return target / ROOM / _NEW


def swap(target: Path, put: Iterable[str], remove: Iterable[str]) -> None:
    """Put files from the new folder in place and remove others, all or nothing.

    Parameters
    ----------
    put
        Files below `new_folder`, relative to it; they get the same name in the target. Those whose content is there
        already are left alone.
    remove
        Files of the target; one that is not there is no error.

    Raises
    ------
    OSError
        If a step fails; everything is as it was, then, or will be after the next run.
    """
    room = target / ROOM
    new, old = room / _NEW, room / _OLD
    changed = [name for name in put if not _same(new / name, target / name)]
    gone = [name for name in remove if (target / name).is_file()]
    kept = [name for name in (*changed, *gone) if (target / name).is_file()]
    if not changed and not gone:
        return
    for name in kept:
        keep(target / name, old / name)
    flush([*(new / name for name in changed), *(old / name for name in kept)])
    flush([*folders_of(new, changed), *(folders_of(old, kept) if kept else ()), room])
    journal = Journal(tuple(changed), tuple(gone), tuple(kept))
    with deferred_signals():
        try:
            write_safely(room / _UNDO, _text(replace(journal, undo=True)))  # now, while there is space
            write_safely(room / _JOURNAL, _text(journal))
            _carry_out(target, journal)
        except BaseException:
            _undo(target, journal)
            raise


def finish(target: Path) -> str:
    """Finish or undo the swap of a run that was killed, and throw away what another had only begun.

    Returns
    -------
    str
        What was done, in words; empty if there was nothing to do.

    Raises
    ------
    OutputError
        If the journal is none of ours.
    OSError
        If a step fails; the next run tries again.
    """
    room = target / ROOM
    journal = _read(room)
    if journal is None:
        begun = (room / _NEW).exists() or (room / _OLD).exists() or (room / _UNDO).exists()
        throw_away(target)
        return "removed what a run that was interrupted had begun" if begun else ""
    with deferred_signals():
        if journal.undo:
            _undo(target, journal)
            return "put back what a run that was interrupted had begun to replace"
        _carry_out(target, journal)
        return "finished what a run that was interrupted had begun to put in place"


def throw_away(target: Path) -> None:
    """Remove what was collected, unless a journal still needs it."""
    room = target / ROOM
    if not (room / _JOURNAL).exists():
        for part in (_NEW, _OLD):
            shutil.rmtree(room / part, ignore_errors=True)
        for path in (room / _UNDO, partial_of(room / _UNDO), partial_of(room / _JOURNAL)):
            path.unlink(missing_ok=True)


def is_interrupted(target: Path) -> bool:
    """Whether a run was killed while it put files in place."""
    return (target / ROOM / _JOURNAL).is_file()


def _carry_out(target: Path, journal: Journal) -> None:
    new = target / ROOM / _NEW
    for name in journal.remove:
        (target / name).unlink(missing_ok=True)
    for name in journal.put:
        if (new / name).exists():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            move(new / name, target / name)
    remove_empty(target, journal.remove)
    _done(target, journal)


def _undo(target: Path, journal: Journal) -> None:
    room = target / ROOM
    if not journal.undo:
        if not (room / _JOURNAL).exists():
            return  # nothing was decided
        (room / _UNDO).replace(room / _JOURNAL)
        flush([room])
    for name in journal.names:
        earlier = room / _OLD / name
        if name not in journal.kept:
            (target / name).unlink(missing_ok=True)
        elif earlier.exists():  # otherwise it is back already
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            move(earlier, target / name)
    remove_empty(target, journal.put)
    _done(target, journal)


def _done(target: Path, journal: Journal) -> None:
    flush([folder for folder in folders_of(target, journal.names) if folder.is_dir()])
    (target / ROOM / _JOURNAL).unlink()
    flush([target / ROOM])
    throw_away(target)


def _same(one: Path, other: Path) -> bool:
    return other.is_file() and one.read_bytes() == other.read_bytes()


def _text(journal: Journal) -> bytes:
    return (json.dumps(asdict(journal), indent=1) + "\n").encode()


def _read(room: Path) -> Journal | None:
    path = room / _JOURNAL
    if not path.is_file():
        return None
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        lists = {key: tuple(map(checked_name, content[key])) for key in ("put", "remove", "kept")}
        return Journal(**lists, undo=bool(content["undo"]))
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        msg = f"{path}: is not a journal that replicate wrote; look at what lies beside it, then delete it"
        raise OutputError(msg) from error
