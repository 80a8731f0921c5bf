"""Make the present state the accepted one, all of it or nothing, and keep a log of why."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path

from replicate.accepted import files_of, state_files
from replicate.diff.changes import Change
from replicate.diff.comparison import compare
from replicate.errors import ReplicateError
from replicate.outcome import Outcome
from replicate.staging import staged

LOG = "CHANGES.md"

_TITLE = "# What was accepted, and why\n"
_LINES = 40


def accept(outcome: Outcome, folder: Path, reason: str) -> list[Change]:
    """Make the present state the accepted one.

    Exhibits that do not differ keep their files, picture included, byte for byte. The reason and what changed
    are appended to ``CHANGES.md``.

    Parameters
    ----------
    folder
        The accepted folder; it is created if it does not exist.

    Returns
    -------
    list of Change
        What is accepted; if it is empty, nothing was written.

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
    changes = compare(outcome, folder).changes
    if not changes:
        return []
    with staged(folder) as fresh:
        for paper in dict.fromkeys(change.paper for change in changes):
            if (folder / paper).is_dir():
                shutil.copytree(folder / paper, fresh / paper)
            else:
                (fresh / paper).mkdir()
        for paper, exhibit in dict.fromkeys((change.paper, change.exhibit) for change in changes):
            for old in files_of(fresh / paper, exhibit):
                old.unlink()
            if (paper, exhibit) in outcome.results:
                for name, content in state_files(outcome, outcome.results[paper, exhibit]).items():
                    (fresh / paper / name).write_bytes(content)
        earlier = (folder / LOG).read_text(encoding="utf-8") if (folder / LOG).is_file() else _TITLE
        (fresh / LOG).write_text(earlier + _entry(reason, changes), encoding="utf-8", newline="\n")
    return changes


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


def _entry(reason: str, changes: Sequence[Change]) -> str:
    """Return the entry of the log: no date, the history of the file has it."""
    first: dict[str, list[str]] = {}
    for change in changes:
        if change.kind == "new" and not change.where:
            first.setdefault(change.paper, []).append(change.exhibit)
    lines = [f"- {paper}: first accepted: {', '.join(exhibits)}" for paper, exhibits in first.items()]
    others = [change for change in changes if change.exhibit not in first.get(change.paper, ())]
    lines += [f"- {change}" for change in others[:_LINES]]
    if len(others) > _LINES:
        lines.append(f"- and {len(others) - _LINES} more")
    return f"\n## {reason}\n\n" + "\n".join(lines) + "\n"
