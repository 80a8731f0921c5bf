"""Write what a comparison leaves behind: the page, and the changes as JSON, JUnit and Markdown.

Same comparison, same bytes. In a GitHub workflow the Markdown is appended to the summary of the job.
"""

from __future__ import annotations

import json
import math
import os
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from replicate.diff.changes import Change
from replicate.diff.commits import commits_compared
from replicate.diff.comparison import Comparison
from replicate.diff.counts import summary
from replicate.diff.page import page
from replicate.display.junit import add_case, count_cases, xml_text
from replicate.errors import OutputError
from replicate.run.outcome import Outcome

SUMMARY_VARIABLE = "GITHUB_STEP_SUMMARY"

# GitHub takes a megabyte at most.
_LINES_PER_EXHIBIT = 20
_EXHIBITS = 200


def write_diff(comparison: Comparison, outcome: Outcome, folder: Path, accepted: Path, jobs: int | None = None) -> None:
    """Write ``diff/index.html``, ``diff.json``, ``diff.junit.xml`` and ``diff.md`` into an existing folder.

    Parameters
    ----------
    accepted
        The folder of the accepted state, whose commit is named.
    jobs
        Number of processes that draw.

    Raises
    ------
    OutputError
        If the summary of the GitHub job cannot be written.
    """
    text = markdown(comparison)
    (folder / "diff").mkdir()
    for name, content in (
        ("diff/index.html", page(comparison, outcome, commits_compared(accepted), jobs)),
        ("diff.json", json_text(comparison)),
        ("diff.junit.xml", junit(comparison)),
        ("diff.md", text),
    ):
        (folder / name).write_text(content, encoding="utf-8", newline="\n")
    job_summary = os.environ.get(SUMMARY_VARIABLE)
    if job_summary:
        try:
            with Path(job_summary).open("a", encoding="utf-8") as file:
                file.write(text)
        except OSError as error:
            msg = f"{SUMMARY_VARIABLE}: {job_summary}: cannot be written: {error.strerror or error}"
            raise OutputError(msg) from error


def json_text(comparison: Comparison) -> str:
    """Return counts and all changes as JSON."""
    content = {
        "summary": summary(comparison),
        "compared": comparison.compared,
        "unchanged": [exhibit.name for exhibit in comparison.unchanged],
        "changed": [exhibit.name for exhibit in comparison.changed],
        "changes": [_entry(change) for change in comparison.changes],
    }
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _entry(change: Change) -> dict[str, Any]:
    size = change.size if change.size is not None and math.isfinite(change.size) else None
    return {**vars(change), "size": None if size is None else float(f"{size:.3g}")}


def junit(comparison: Comparison) -> str:
    """Return JUnit XML: one suite per paper, one test per exhibit, which fails if anything changed."""
    root = ET.Element("testsuites", name="replicate diff")
    for paper in dict.fromkeys(exhibit.paper for exhibit in comparison.exhibits):
        suite = ET.SubElement(root, "testsuite", name=paper)
        for exhibit in comparison.exhibits:
            if exhibit.paper == paper:
                outcome = "failure" if exhibit.changes else ""
                broken = exhibit.failed or exhibit.damaged
                text = "\n".join(exhibit.texts)
                add_case(suite, f"diff.{paper}", exhibit.exhibit, "error" if broken else outcome, text)
        count_cases(suite)
    return xml_text(root)


def markdown(comparison: Comparison) -> str:
    """Return the changes as Markdown."""
    return "\n".join(_lines(comparison)) + "\n"


def _lines(comparison: Comparison) -> Iterator[str]:
    yield "## Compared with the accepted state"
    yield ""
    yield f"**{_escaped(summary(comparison))}**"
    changed = comparison.changed
    for exhibit in changed[:_EXHIBITS]:
        yield ""
        yield f"### {exhibit.name}"
        yield ""
        yield from (f"- {_escaped(text)}" for text in exhibit.texts[:_LINES_PER_EXHIBIT])
        if len(exhibit.changes) > _LINES_PER_EXHIBIT:
            same = f"; {exhibit.same}" if exhibit.same else ""
            yield f"- and {len(exhibit.changes) - _LINES_PER_EXHIBIT} more{same}"
    if len(changed) > _EXHIBITS:
        yield ""
        yield f"And {len(changed) - _EXHIBITS} more exhibits."
    yield ""


def _escaped(text: str) -> str:
    return re.sub(r"([\\`*_<>\[\]|$~#])", r"\\\1", text)
