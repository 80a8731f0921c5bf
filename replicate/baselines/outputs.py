"""What a run leaves behind: one page, a summary for the job, and the text of one comment on the pull request."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from replicate.baselines.outcomes import Outcome
from replicate.errors import OutputError
from replicate.staging import staged

SUMMARY_VARIABLE = "GITHUB_STEP_SUMMARY"

#: By this line a later run finds the comment that it shall replace.
MARKER = "<!-- replicate-figures -->"

#: GitHub takes a summary of up to one MiB, and a comment of fewer characters than this.
MOST_BYTES = 1024 * 1024 - 4096
MOST_CHARACTERS = 65_536 - 512

_LINES = 15


def counted(outcomes: Sequence[Outcome]) -> str:
    """Return one line that counts what was compared and what became of it.

    Examples
    --------
    >>> counted([])
    'nothing was compared'
    >>> counted([Outcome("a", "same"), Outcome("b", "changed", changes=["x"])])
    '1 of 2 figures differs from its accepted state'
    """
    names = {"accepted": "accepted", "failed": "failed", "not drawn": "accepted, but not drawn"}
    count = {status: sum(outcome.status == status for outcome in outcomes) for status in names}
    differ, total = sum(outcome.differs for outcome in outcomes), len(outcomes) - count["not drawn"]
    if not total:
        return "nothing was compared"
    parts = []
    if differ:
        whose = "differs from its" if differ == 1 else "differ from their"
        parts.append(f"{differ} of {total} figure{'s' if total != 1 else ''} {whose} accepted state")
    elif not count["accepted"] + count["failed"]:
        parts.append(f"nothing differs from the accepted state; figures compared: {total}")
    parts += [f"{names[status]}: {number}" for status, number in count.items() if number]
    return "; ".join(parts)


def worst_first(outcomes: Sequence[Outcome]) -> list[Outcome]:
    """Return what has to be looked at: what failed, then what is gone or new, then what moved most."""
    rank = {"failed": 0, "gone": 1, "new": 2, "changed": 3, "not drawn": 4, "accepted": 5}
    told = [outcome for outcome in outcomes if outcome.status != "same"]
    return sorted(told, key=lambda one: (rank[one.status], -one.size, -len(one.changes), one.name))


def write_outputs(
    outcomes: Sequence[Outcome], folder: Path, command: Callable[[Outcome], str], comment: Path | None = None
) -> Path:
    """Write ``index.html`` and ``figures.json`` and ``comment.md``; append the summary of the job, if there is one.

    Parameters
    ----------
    command
        Returns the command that accepts one figure.
    comment
        Where the comment is written as well.

    Returns
    -------
    Path
        Of the page.

    Raises
    ------
    OutputError
        If something cannot be written.
    """
    from replicate.baselines.page import page

    with staged(folder, "figures") as fresh:
        (fresh / "index.html").write_text(page(outcomes, command), encoding="utf-8", newline="\n")
        (fresh / "figures.json").write_text(as_json(outcomes), encoding="utf-8", newline="\n")
        (fresh / "comment.md").write_text(comment_text(outcomes), encoding="utf-8", newline="\n")
    summary = os.environ.get(SUMMARY_VARIABLE)
    _append(Path(summary), summary_text(outcomes)) if summary else None
    if comment is not None:
        _append(comment, comment_text(outcomes), anew=True)
    return folder / "index.html"


def _append(path: Path, text: str, *, anew: bool = False) -> None:
    try:
        with path.open("w" if anew else "a", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except OSError as error:
        msg = f"{path}: cannot be written: {error.strerror or error}"
        raise OutputError(msg) from error


def as_json(outcomes: Sequence[Outcome]) -> str:
    """Return names, statuses and changes as JSON."""
    entries = [
        {
            "name": one.name,
            "status": one.status,
            "where": one.where,
            "accepted": one.digest,
            "changes": [{"text": text, "layer": layer} for text, layer in zip(one.changes, one.layers, strict=True)],
        }
        for one in outcomes
    ]
    content = {
        "summary": counted(outcomes),
        "compared": sum(one.status != "not drawn" for one in outcomes),
        "figures": entries,
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def summary_text(outcomes: Sequence[Outcome]) -> str:
    """Return the summary of a job as Markdown, cut where GitHub would refuse it."""
    return _cut(list(_sections(outcomes)), lambda text: len(text.encode()), MOST_BYTES)


def comment_text(outcomes: Sequence[Outcome]) -> str:
    """Return the text of the comment as Markdown; its first line says which comment it is."""
    return _cut([MARKER, *_sections(outcomes)], len, MOST_CHARACTERS)


def _sections(outcomes: Sequence[Outcome]) -> Iterator[str]:
    bad = any(one.differs or one.status == "failed" for one in outcomes) or not outcomes
    yield f"## {'🔴' if bad else '🟢'} Figures"
    yield f"\n**{_escaped(counted(outcomes))}**"
    for one in worst_first(outcomes):
        lines = [f"- {_escaped(text)}" for text in one.changes[:_LINES]]
        if len(one.changes) > _LINES:
            lines.append(f"- and {len(one.changes) - _LINES} more")
        where = f" ({_escaped(one.where)})" if one.where else ""
        yield "\n".join(["", f"### {_escaped(one.name)}: {one.status}{where}", "", *lines])


def _cut(sections: Sequence[str], size: Callable[[str], int], most: int) -> str:
    """Join sections as long as they fit, and say how many do not."""
    kept: list[str] = []
    room = most - size("\n\nAnd 1000000 more figures, on the page.\n")
    for place, section in enumerate(sections):
        room -= size(section) + 1
        if room < 0:
            kept.append(f"\nAnd {len(sections) - place} more figures, on the page.")
            break
        kept.append(section)
    return "\n".join(kept) + "\n"


def _escaped(text: str) -> str:
    return re.sub(r"([\\`*_<>\[\]|$~#@])", r"\\\1", " ".join(text.split()))
