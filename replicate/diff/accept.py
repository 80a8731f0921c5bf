"""Make the present state the accepted one, all of it or nothing, and keep a log of why."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from pathlib import Path

from replicate.diff.accepted import ENDINGS, FigureState, files_of, is_state, restated_figure, state_files
from replicate.diff.checksums import SUMS, checksum, checksums, checksums_text, read_checksums
from replicate.diff.comparison import Comparison, ExhibitDiff, compare
from replicate.errors import AcceptedStateError, OutputError, ReplicateError
from replicate.plain_text import steering
from replicate.run.outcome import Outcome
from replicate.staging import replace_files

LOG = "CHANGES.md"

_TITLE = "# What was accepted, and why\n"
_LINES = 40


def accept(outcome: Outcome, folder: Path, reason: str, known: Collection[str] | None = None) -> Comparison:
    """Make the present state the accepted one.

    Exhibits that do not differ keep their files, picture included, byte for byte; so does a figure of which only the
    words differ, but for these. The reason and what changed are appended to ``CHANGES.md``.

    Parameters
    ----------
    folder
        The accepted folder; it is created if it does not exist.
    known
        As for `replicate.diff.comparison.compare`.

    Returns
    -------
    Comparison
        With what was accepted until now; if it has no changes, nothing was written, but for what was in an older
        format.

    Raises
    ------
    ReplicateError
        If the reason is empty or an exhibit raised.
    OutputError
        If the folder cannot be written, or holds files in the way that are not ours; it is as it was, then.
    """
    reason = require_reason(reason)
    if outcome.failures:
        msg = f"nothing was accepted, because an exhibit could not be computed: {outcome.failures[0]}"
        raise ReplicateError(msg)
    comparison = compare(outcome, folder, known)
    stale = {diff.name: diff for diff in (*comparison.changed, *comparison.outdated)}.values()
    papers = dict.fromkeys(diff.paper for diff in (*stale, *comparison.unsigned))
    if not papers:
        return comparison
    log = _log(folder)
    if not log:
        _refuse_foreign(comparison, folder)
    made: dict[str, dict[str, bytes]] = {paper: {} for paper in papers}
    gone: dict[str, list[str]] = {paper: [] for paper in papers}
    for diff in stale:
        paper, exhibit = diff.paper, diff.exhibit
        result = outcome.results.get((paper, exhibit))
        if diff.restated and result is not None and isinstance(diff.before, FigureState):
            made[paper] |= restated_figure(outcome, result, diff.before)
            continue
        fresh = state_files(outcome, result) if result is not None else {}
        old = [path for path in files_of(folder / paper, exhibit) if path.name not in fresh]
        if old and not fresh and not is_state(folder / paper, exhibit):
            msg = f"{old[0]}: is not of an accepted state, so it is not removed; move it away; nothing was written"
            raise OutputError(msg)
        made[paper] |= fresh
        gone[paper] += [path.name for path in old]
    for paper in papers:
        sums = _checksums(folder / paper, made[paper], gone[paper])
        if sums:
            made[paper][SUMS] = checksums_text(sums).encode()
        else:
            gone[paper].append(SUMS)
    files = {f"{paper}/{name}": content for paper, fresh in made.items() for name, content in fresh.items()}
    files[LOG] = ((log or _TITLE) + _entry(reason, comparison)).encode()
    replace_files(folder, files, [f"{paper}/{name}" for paper, names in gone.items() for name in names])
    return comparison


def _checksums(folder: Path, made: Mapping[str, bytes], gone: Collection[str]) -> dict[str, str]:
    """Return the checksums of a paper's accepted files after files were made, and others removed.

    Those of other exhibits stay as they are: what was altered in them has not been accepted. Where nothing was written
    down, what is there counts as accepted.
    """
    try:
        known = read_checksums(folder)
    except AcceptedStateError:
        known = {}
    if known is None:
        known = checksums(path for path in sorted(folder.glob("*")) if path.suffix in ENDINGS)
    kept = {name: found for name, found in known.items() if name not in gone and (folder / name).is_file()}
    return kept | {name: checksum(name, content) for name, content in made.items()}


def require_reason(reason: str) -> str:
    """Return the reason on one line.

    Raises
    ------
    ReplicateError
        If there is none.
    """
    reason = " ".join(reason.split())
    if not reason:
        msg = "accepting needs a reason: --reason 'why the present state is right'"
        raise ReplicateError(msg)
    if found := steering(reason):
        msg = f"--reason holds the character {found}; expected: one line of plain text"
        raise ReplicateError(msg)
    return reason


def _log(folder: Path) -> str:
    """Return the log of an accepted folder, empty if there is none."""
    path = folder / LOG
    if not path.exists():
        return ""
    try:
        log = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        log = ""
    if not log.startswith(_TITLE):
        msg = f"{path}: is not a log of accepted changes, which begins with '{_TITLE.strip()}'; nothing was written"
        raise OutputError(msg)
    return log


def _refuse_foreign(comparison: Comparison, folder: Path) -> None:
    """Refuse to replace files in a folder without our log, unless they can be read as an accepted state."""
    for diff in comparison.changed:
        if diff.before is None:
            sums = [folder / diff.paper / SUMS] if diff.damaged and (folder / diff.paper / SUMS).exists() else []
            for path in (*files_of(folder / diff.paper, diff.exhibit), *sums):
                msg = f"{path}: is in the way, and not of an accepted state: {folder} has no {LOG}; nothing was written"
                raise OutputError(msg)


def _entry(reason: str, comparison: Comparison) -> str:
    """Return the entry of the log: no date, the history of the file has it."""
    first: dict[str, list[str]] = {}
    lines: list[str] = []
    for diff in comparison.changed:
        if _is_first(diff):
            first.setdefault(diff.paper, []).append(diff.exhibit)
        else:
            lines += [f"{diff.name}: {text}" for text in diff.texts]
    old = [diff.name for diff in comparison.outdated if not diff.changes]
    if old:
        lines.append(f"written in the present format, which says more: {', '.join(old)}")
    if len(lines) > _LINES:
        lines = [*lines[:_LINES], f"and {len(lines) - _LINES} more"]
    lines = [f"{paper}: first accepted: {', '.join(exhibits)}" for paper, exhibits in first.items()] + lines
    unsigned = dict.fromkeys(diff.paper for diff in comparison.unsigned)
    if unsigned:
        lines.append(f"checksums of what was accepted before: {', '.join(unsigned)}")
    return f"\n## {_plain(reason)}\n\n" + "".join(f"- {line}\n" for line in lines)


def _plain(text: str) -> str:
    """Return a text that Markdown shows as it is: no tags, no links, no further headings."""
    return re.sub(r"([\\`\[<]|^#)", r"\\\1", text)


def _is_first(diff: ExhibitDiff) -> bool:
    return any(change.kind == "new" and not change.where for change in diff.changes)
