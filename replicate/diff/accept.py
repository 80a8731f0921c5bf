"""Make the present state the accepted one, all of it or nothing, and keep a log of why."""

from __future__ import annotations

import shutil
from collections.abc import Collection
from pathlib import Path

from replicate.diff.accepted import files_of, state_files
from replicate.diff.comparison import Comparison, ExhibitDiff, compare
from replicate.errors import ReplicateError
from replicate.run.outcome import Outcome
from replicate.staging import staged

LOG = "CHANGES.md"

_TITLE = "# What was accepted, and why\n"
_LINES = 40


def accept(outcome: Outcome, folder: Path, reason: str, known: Collection[str] | None = None) -> Comparison:
    """Make the present state the accepted one.

    Exhibits that do not differ keep their files, picture included, byte for byte. The reason and what changed
    are appended to ``CHANGES.md``.

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
        If the folder cannot be written; it is as it was, then.
    """
    reason = require_reason(reason)
    if outcome.failures:
        msg = f"nothing is accepted, because an exhibit could not be computed: {outcome.failures[0]}"
        raise ReplicateError(msg)
    comparison = compare(outcome, folder, known)
    fresh_states = dict.fromkeys((diff.paper, diff.exhibit) for diff in (*comparison.changed, *comparison.outdated))
    if not fresh_states:
        return comparison
    with staged(folder) as fresh:
        for paper in dict.fromkeys(paper for paper, _ in fresh_states):
            if (folder / paper).is_dir():
                shutil.copytree(folder / paper, fresh / paper)
            else:
                (fresh / paper).mkdir()
        for paper, exhibit in fresh_states:
            for old in files_of(fresh / paper, exhibit):
                old.unlink()
            if (paper, exhibit) in outcome.results:
                for name, content in state_files(outcome, outcome.results[paper, exhibit]).items():
                    (fresh / paper / name).write_bytes(content)
        earlier = (folder / LOG).read_text(encoding="utf-8") if (folder / LOG).is_file() else _TITLE
        (fresh / LOG).write_text(earlier + _entry(reason, comparison), encoding="utf-8", newline="\n")
    return comparison


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
    return reason


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
    return f"\n## {reason}\n\n" + "".join(f"- {line}\n" for line in lines)


def _is_first(diff: ExhibitDiff) -> bool:
    return any(change.kind == "new" and not change.where for change in diff.changes)
