"""Whether the texts of papers can be shown: what they ask for exists, and their formulas can be converted."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from replicate.display.markdown import MarkdownBatch
from replicate.errors import TemplateError, UnreadableFormulaError, UnreadableTextError
from replicate.exhibits import Paper, Table
from replicate.exhibits.file_names import display_name
from replicate.exhibits.results import Results
from replicate.report.pages import paper_pages
from replicate.run.outcome import Outcome
from replicate.run.project import Project
from replicate.verdicts.rows import Judgement

_BEGINNING = 60  # characters of a text that are shown and looked for
_TEXTS = (".md", ".toml", ".py", ".csv")


def unreadable(outcome: Outcome) -> dict[str, str]:
    """Return by id why the texts of a paper cannot be shown, with file and line; nothing for those that can be."""
    found = {}
    for paper in outcome.papers:
        error = _unreadable(paper, outcome.results, outcome.judgements[paper.id])
        if error is not None:
            found[paper.id] = str(error)
    return found


def _unreadable(paper: Paper, results: Results, judgement: Judgement) -> TemplateError | None:
    try:
        for page in paper_pages(paper, results, judgement):
            batch = MarkdownBatch(page.file)
            texts = [piece.text for piece in page.prose if piece.kind != "exhibit"]
            texts += [verdict.explanation for verdict in page.verdicts]
            for view in page.exhibits:
                exhibit = paper.exhibits[view.id]
                texts.append(exhibit.title)
                texts += exhibit.labels.values() if isinstance(exhibit, Table) else ()
            batch.substitute("".join(batch.block(text) for text in texts))
    except TemplateError as error:
        files = (path for path in Path(str(paper.folder())).rglob("*") if path.suffix in _TEXTS)
        return _located(error, {display_name(file): file for file in sorted(files)})
    return None


@contextmanager
def placed(project: Project | None) -> Iterator[None]:
    """Say of a text that cannot be converted in which of the project's own files it stands: inside a ``with`` block."""
    try:
        yield
    except TemplateError as error:
        files = [] if project is None else [project.file, *([project.methods] if project.methods else [])]
        raise _located(error, {file.name: file for file in files}) from error


def _located(error: TemplateError, files: Mapping[str, Path]) -> TemplateError:
    """Return the error with the place of what is wrong, where it can be found in files, by what messages call them."""
    if isinstance(error, UnreadableFormulaError):
        wrong, shown = error.tex, f"${error.tex}$"
    elif isinstance(error, UnreadableTextError):
        wrong = error.text[:_BEGINNING]
        shown = f"the text '{' '.join(wrong.split())}'"
    else:
        return error
    words = r"\s+".join(re.escape(word) for word in wrong.split())
    as_written = re.compile(f"{words}|{words.replace(re.escape(chr(92)), re.escape(chr(92) * 2))}")
    for name, file in files.items():
        text = file.read_text(encoding="utf-8", errors="replace")
        found = as_written.search(text)
        if found:
            place = f"{name}:{text.count(chr(10), 0, found.start()) + 1}"
            return TemplateError(f"{place}: pandoc cannot convert {shown}: {error.why}")
    return error
