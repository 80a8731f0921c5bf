"""Programs in a handout are run, so that what is printed under them is what they print.

A code block of the classes ``.python .run`` is executed when the handout is built; all programs of one
handout share their names, as the cells of a notebook do. What a program writes is put below it.
"""

from __future__ import annotations

import io
import traceback
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from typing import Any

from replicate.errors import TemplateError
from replicate.handout.endless import TimeIsUp, time_limit
from replicate.handout.formulas import line_of
from replicate.handout.tree import Blocks, Element, classes, transform

LONGEST_LINE = 88  # characters; what fits between the margins
LONGEST_RUN = 60.0  # seconds


def run_programs(
    document: Blocks, lines: Sequence[tuple[str, int]], source: str, known: dict[str, Any] | None = None
) -> Blocks:
    """Return the document with the output of its programs.

    Parameters
    ----------
    lines, source
        For error messages: the text that the document was read from with the line of the source that each
        line stems from, and the name of the source.
    known
        What programs wrote on another sheet, by all that had run until then; the new ones are added.

    Raises
    ------
    TemplateError
        If a program fails, or a line of it or of its output is too long for the page.
    """
    known = {} if known is None else known
    runs = Runs({"__name__": "handout"}, known)

    def changed(element: Element) -> list[Element] | None:
        if element["t"] != "CodeBlock":
            return None
        code = element["c"][1]
        first = line_of(code, lines)
        for number, line in enumerate(code.splitlines(), start=first):
            _check_width(line, f"{source}:{number}")
        if "run" not in classes(element):
            return None
        written = runs.written(code, source, first)
        for line in written.splitlines():
            _check_width(line, f"{source}:{first}: the output")
        program = {"t": "CodeBlock", "c": [["", ["python"], []], code]}
        if not written.strip():
            return [program]
        return [program, {"t": "CodeBlock", "c": [["", ["output"], []], written.rstrip()]}]

    result: Blocks = transform(document, changed)
    return result


@dataclass
class Runs:
    """Programs that share their names; one that an earlier sheet had after the same others does not run again.

    Attributes
    ----------
    names
        What the programs have defined.
    known
        What they wrote, by the text of a program and of all before it.
    """

    names: dict[str, Any]
    known: dict[str, Any]
    _before: list[tuple[str, str, int]] = field(default_factory=list)
    _done: int = 0

    def written(self, code: str, source: str, first: int) -> str:
        """Return what a program writes; the programs before it are run only if it has to be."""
        self._before.append((code, source, first))
        key = "\0".join(["program", *(one for one, _, _ in self._before)])
        if key not in self.known:
            for late in self._before[self._done :]:
                self.known[key] = _run(late[0], self.names, late[1], late[2])
            self._done = len(self._before)
        return str(self.known[key])


def _run(code: str, names: dict[str, Any], source: str, first: int) -> str:
    written = io.StringIO()
    try:
        with redirect_stdout(written), time_limit(LONGEST_RUN):
            exec(compile(code, "<program>", "exec"), names)  # noqa: S102  -- the paper's own text
    except (Exception, SystemExit, TimeIsUp) as error:
        failed = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == "<program>"]
        line = (failed[-1].lineno if failed else getattr(error, "lineno", 1)) or 1
        why = f"the program fails: {type(error).__name__}: {error}"
        if isinstance(error, TimeIsUp):
            why = f"the program did not end within {LONGEST_RUN:g} s; it was stopped in this line"
        msg = f"{source}:{first + line - 1}: {why}"
        raise TemplateError(msg) from error
    return written.getvalue()


def _check_width(line: str, place: str) -> None:
    if len(line) > LONGEST_LINE:
        msg = f"{place}: a line has {len(line)} characters, allowed: {LONGEST_LINE}: '{line.strip()[:40]}...'"
        raise TemplateError(msg)
