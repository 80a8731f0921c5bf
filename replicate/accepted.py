"""The accepted state of every exhibit: what it is, how a run is compared with it and takes its place.

In the accepted folder, for each paper: ``<exhibit>.csv`` holds the computed values and verdicts of a table
(``row,column,reading,computed,printed,verdict``), of the claims (``row,verdict,computed``), or the curves of
a figure (``panel,curve,x,y``). A figure has its axes beside it in ``<exhibit>.json`` and a picture for people
in ``<exhibit>.png``, small and never compared. Numbers have nine significant digits.
"""

from __future__ import annotations

import io
import json
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path

from replicate.changes import Change, compare_axes, compare_curves, compare_rows
from replicate.errors import OutputError, ReplicateError
from replicate.outcome import Outcome
from replicate.outputs import csv_text, curves_text, number_text
from replicate.records import ClaimsResult, FigureResult, Result, TableResult
from replicate.staging import staged
from replicate.units import errors_of

DIGITS = 9

_ENDINGS = (".csv", ".json", ".png")

LOG = "CHANGES.md"
_LOG_TITLE = "# What was accepted, and why\n"
_LOG_LINES = 40

TABLE_KEYS = ("row", "column", "reading")
CLAIM_KEYS = ("row",)


def compare(outcome: Outcome, folder: Path) -> list[Change]:
    """Compare what a run computed with the accepted state.

    Parameters
    ----------
    folder
        The accepted folder, one folder per paper in it.

    Returns
    -------
    list of Change
        Empty if nothing differs. In the order of the papers and their exhibits. If the run was complete, an
        accepted exhibit that no longer exists is a change, too.

    Raises
    ------
    OutputError
        If an accepted file cannot be read.
    """
    changes: list[Change] = []
    for paper, exhibit in outcome.results:
        changes += _compare_exhibit(outcome, paper, exhibit, folder)
    if outcome.complete:
        for paper, exhibit in _orphans(outcome, folder):
            changes.append(Change(paper, exhibit, "removed", "was accepted, but is not computed any more"))
    return changes


def write(outcome: Outcome, folder: Path, reason: str) -> list[Change]:
    """Make the present state the accepted one, all of it or nothing.

    Exhibits that do not differ keep their files, picture included, byte for byte. What changed and the reason
    are appended to ``CHANGES.md``.

    Returns
    -------
    list of Change
        What is accepted; if it is empty, nothing was written.

    Raises
    ------
    ReplicateError
        If the reason is empty or an exhibit raised.
    OutputError
        If the folder cannot be written.
    """
    reason = " ".join(reason.split())
    if not reason:
        msg = "accepting needs a reason: --reason 'why the present state is right'"
        raise ReplicateError(msg)
    if outcome.failures:
        msg = f"nothing is accepted, because an exhibit could not be computed: {outcome.failures[0]}"
        raise ReplicateError(msg)
    changes = compare(outcome, folder)
    if not changes:
        return []
    with staged(folder) as fresh:
        for paper in dict.fromkeys(change.paper for change in changes):
            if (folder / paper).is_dir():
                shutil.copytree(folder / paper, fresh / paper)
            else:
                (fresh / paper).mkdir()
        for paper, exhibit in dict.fromkeys((change.paper, change.exhibit) for change in changes):
            for old in _files(fresh / paper, exhibit):
                old.unlink()
            if (paper, exhibit) in outcome.results:
                for name, content in state(outcome, paper, exhibit).items():
                    (fresh / paper / name).write_bytes(content)
        earlier = (folder / LOG).read_text(encoding="utf-8") if (folder / LOG).is_file() else _LOG_TITLE
        (fresh / LOG).write_text(earlier + _log_entry(reason, changes), encoding="utf-8", newline="\n")
    return changes


def state(outcome: Outcome, paper: str, exhibit: str) -> dict[str, bytes]:
    """Return the files, by name, that describe the present state of an exhibit."""
    result = outcome.results[paper, exhibit]
    files = {f"{exhibit}.csv": _csv(outcome, result).encode()}
    if isinstance(result, FigureResult):
        files[f"{exhibit}.json"] = (json.dumps(result.axes, indent=1, ensure_ascii=False) + "\n").encode()
        files[f"{exhibit}.png"] = _small(result.png)
    return files


def _small(png: bytes) -> bytes:
    """Return a picture of half the size in few colours, for people to glance at."""
    from PIL import Image

    with Image.open(io.BytesIO(png)) as picture:
        half = (picture.width // 2, picture.height // 2)
        small = picture.convert("RGB").resize(half, Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    small.quantize(64, dither=Image.Dither.NONE).save(buffer, format="png", optimize=True)
    return buffer.getvalue()


def _csv(outcome: Outcome, result: Result) -> str:
    verdicts = {
        (verdict.row, verdict.column): verdict
        for verdict in outcome.judgements[result.paper].verdicts
        if verdict.exhibit == result.exhibit
    }
    if isinstance(result, FigureResult):
        return curves_text(result.curves)
    if isinstance(result, ClaimsResult):
        rows = [
            (id, finding.verdict, number_text(finding.value, DIGITS))
            for id, finding in result.findings.items()
        ]
        return csv_text(("row", "verdict", "computed"), rows)
    cells = []
    for reading, row, column, value in _cells(result):
        verdict = verdicts.get((row, column))
        said = (verdict.printed, verdict.verdict) if verdict else ("", "")
        cells.append((row, column, reading, number_text(value, DIGITS), *said))
    return csv_text((*TABLE_KEYS, "computed", "printed", "verdict"), cells)


def _cells(result: TableResult) -> Iterator[tuple[str, str, str, object]]:
    for reading, frame in result.frames.items():
        for row, values in zip(frame.index, frame.itertuples(index=False, name=None), strict=True):
            for column, value in zip(frame.columns, values, strict=True):
                yield reading, str(row), str(column), value


def _compare_exhibit(outcome: Outcome, paper: str, exhibit: str, folder: Path) -> list[Change]:
    result = outcome.results[paper, exhibit]
    errors = errors_of(result)
    if errors:
        return [
            Change(paper, exhibit, "failed", f"{f'{part}: ' if part else ''}could not be computed: {why}")
            for part, why in errors.items()
        ]
    before = _read(folder / paper, exhibit)
    new = {
        name: content.decode() for name, content in state(outcome, paper, exhibit).items() if _is_text(name)
    }
    missing = sorted(new.keys() - before.keys())
    if missing:
        what = "has no accepted state yet" if not before else f"the accepted {missing[0]} is missing"
        return [Change(paper, exhibit, "new", what)]
    data = f"{exhibit}.csv"
    if isinstance(result, FigureResult):
        axes = _json(folder / paper / f"{exhibit}.json", before[f"{exhibit}.json"])
        return [
            *compare_axes(paper, exhibit, axes, result.axes),
            *compare_curves(paper, exhibit, before[data], new[data], axes),
        ]
    keys = CLAIM_KEYS if isinstance(result, ClaimsResult) else TABLE_KEYS
    return compare_rows(paper, exhibit, before[data], new[data], keys)


def _is_text(name: str) -> bool:
    return not name.endswith(".png")


def _files(folder: Path, exhibit: str) -> list[Path]:
    return [
        folder / f"{exhibit}{end}"
        for end in (".csv", ".json", ".png")
        if (folder / f"{exhibit}{end}").is_file()
    ]


def _read(folder: Path, exhibit: str) -> dict[str, str]:
    texts = {}
    for path in _files(folder, exhibit):
        if _is_text(path.name):
            try:
                texts[path.name] = path.read_text(encoding="utf-8")
            except (OSError, UnicodeDecodeError) as error:
                msg = f"{folder.name}/{path.name}: the accepted state cannot be read: {error}"
                raise OutputError(msg) from error
    return texts


def _json(path: Path, text: str) -> list[Mapping[str, object]]:
    try:
        axes = json.loads(text)
    except json.JSONDecodeError as error:
        msg = f"{path.parent.name}/{path.name}:{error.lineno}: is no JSON: {error.msg}"
        raise OutputError(msg) from error
    if not isinstance(axes, list) or not all(isinstance(entry, dict) and "panel" in entry for entry in axes):
        msg = f"{path.parent.name}/{path.name}: needed: a list of objects, each with its 'panel'"
        raise OutputError(msg)
    return axes


def _orphans(outcome: Outcome, folder: Path) -> list[tuple[str, str]]:
    """Return accepted exhibits that the papers of this run do not have (any more)."""
    found = {
        (paper.id, path.stem): None
        for paper in outcome.papers
        for path in sorted((folder / paper.id).glob("*"))
        if path.suffix in _ENDINGS
    }
    return [key for key in found if key not in outcome.results]


def _log_entry(reason: str, changes: list[Change]) -> str:
    lines = [f"- {change}" for change in changes[:_LOG_LINES]]
    if len(changes) > _LOG_LINES:
        lines.append(f"- and {len(changes) - _LOG_LINES} more")
    return f"\n## {reason}\n\n" + "\n".join(lines) + "\n"
