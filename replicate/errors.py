"""All exceptions of the package outside the numerical core, and how their messages list names.

ReplicateError                 shown to the user as one line, exit status 2
├── PaperDefinitionError       a paper's package contradicts itself
├── ProjectError               a project file is malformed (file, line)
├── UnknownPaperError          no such paper or exhibit
├── PrintedFileError           a printed CSV is malformed (file, line, cell)
├── LedgerError                a ledger entry names nothing, or no longer applies
├── AcceptedStateError         a file of the accepted state is damaged (file, line)
├── FigureError                what should be compared is not a figure, or cannot be named
├── FigureRecordError          a record of a figure is damaged, or newer than this version
├── SweepFileError             the file of a sweep is malformed (file, line)
├── TemplateError              prose asks for a result that does not exist
│   ├── UnreadableFormulaError     a formula is not LaTeX that can be converted
│   └── UnreadableTextError        a text that pandoc does not convert in reasonable time
└── OutputError                a result cannot be written

`replicate.loops` has its own tree (`replicate.loops.errors`), because it knows nothing of papers.
"""

from __future__ import annotations

from collections.abc import Iterable

#: Exit status of a run that was told to end (SIGTERM), as shells have it.
TERMINATED = 143


class ReplicateError(Exception):
    """Base of every error that is reported to the user as one line."""


class PaperDefinitionError(ReplicateError):
    """A paper's package contradicts itself (duplicate ids, missing keys)."""


class ProjectError(ReplicateError):
    """A project file is malformed, or there is no project where one is needed."""


class UnknownPaperError(ReplicateError):
    """The paper or exhibit asked for does not exist."""


class PrintedFileError(ReplicateError):
    """A printed CSV is malformed."""


class LedgerError(ReplicateError):
    """A ledger entry names no cell, or a cell that no longer differs."""


class AcceptedStateError(ReplicateError):
    """A file of the accepted state is damaged."""


class FigureError(ReplicateError):
    """What should be compared is not a figure, or cannot be named."""


class FigureRecordError(ReplicateError):
    """A record of a figure is damaged, or a newer version wrote it.

    Attributes
    ----------
    why
        What is wrong, to be put after the name of the file.
    line
        Where, if that is known.
    """

    def __init__(self, why: str, line: int | None = None) -> None:
        super().__init__(f"the record of a figure {f'(line {line}) ' if line else ''}{why}")
        self.why, self.line = why, line


class SweepFileError(ReplicateError):
    """The file of a sweep is malformed."""


class TemplateError(ReplicateError):
    """Prose asks for a result that does not exist."""


class UnreadableFormulaError(TemplateError):
    """A formula is not LaTeX that can be converted.

    Attributes
    ----------
    page, tex, why
        The page on which it stands, the formula without its dollar signs, and what is wrong with it.
    """

    def __init__(self, page: str, tex: str, why: str) -> None:
        super().__init__(f"{page}: pandoc cannot convert ${tex}$: {why}")
        self.page, self.tex, self.why = page, tex, why


class UnreadableTextError(TemplateError):
    """A text that pandoc does not convert in reasonable time.

    Attributes
    ----------
    page, text, why
        The page on which it stands, the text, and what is wrong with it.
    """

    def __init__(self, page: str, text: str, why: str) -> None:
        super().__init__(f"{page}: pandoc cannot convert the text '{' '.join(text.split())[:60]}': {why}")
        self.page, self.text, self.why = page, text, why


class OutputError(ReplicateError):
    """A result cannot be written where it should go."""


def listed(names: Iterable[str], most: int | None = None) -> str:
    """Return names as a message lists them: in quotes, at the most so many.

    Examples
    --------
    >>> listed(["mean", "sd"]), listed([]), listed("abc", most=2)
    ("'mean', 'sd'", 'none', "'a', 'b', ...")
    """
    quoted = [f"'{name}'" for name in names]
    more = ["..."] if most is not None and len(quoted) > most else []
    return ", ".join(quoted[:most] + more) or "none"
