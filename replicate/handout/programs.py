"""Programs in a handout are run, so that what is printed under them is what they print.

A code block of the classes ``.python .run`` is executed when the handout is built; all programs of one
handout share their names, as the cells of a notebook do. What a program writes is put below it; characters that
steer what shows them are written out.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from typing import Any

from replicate.errors import ReplicateError, TemplateError
from replicate.handout.formulas import line_of
from replicate.handout.own_code import LONGEST_RUN, OwnCode
from replicate.handout.tree import Blocks, Element, classes, transform
from replicate.plain_text import visible
from replicate.run.guarded import GuardedProcess

LONGEST_LINE = 88  # characters; what fits between the margins

_names: dict[str, Any] = {"__name__": "handout"}  # that the programs share, in the process where they run


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

    def changed(element: Element) -> list[Element] | None:
        if element["t"] != "CodeBlock":
            return None
        code = element["c"][1]
        first = line_of(code, lines)
        for number, line in enumerate(code.splitlines(), start=first):
            _check_width(line, f"{source}:{number}")
        if "run" not in classes(element):
            return None
        written = visible(runs.written(code, source, first))
        for line in written.splitlines():
            _check_width(line, f"{source}:{first}: the output")
        program = {"t": "CodeBlock", "c": [["", ["python"], []], code]}
        if not written.strip():
            return [program]
        return [program, {"t": "CodeBlock", "c": [["", ["output"], []], written.rstrip()]}]

    with GuardedProcess(LONGEST_RUN) as process:
        runs = Runs(process, known)
        result: Blocks = transform(document, changed, texts=False)
    return result


@dataclass
class Runs:
    """Programs that share their names; one that an earlier sheet had after the same others does not run again.

    Attributes
    ----------
    process
        In which they run, and which has their names.
    known
        What they wrote, by the text of a program and of all before it.
    """

    process: GuardedProcess
    known: dict[str, Any]
    _before: list[tuple[str, str, int]] = field(default_factory=list)
    _done: int = 0

    def written(self, code: str, source: str, first: int) -> str:
        """Return what a program writes; the programs before it are run only if it has to be."""
        self._before.append((code, source, first))
        key = "\0".join(["program", *(one for one, _, _ in self._before)])
        if key not in self.known:
            for late in self._before[self._done :]:
                self.known[key] = self._run(*late)
            self._done = len(self._before)
        return str(self.known[key])

    def _run(self, code: str, source: str, first: int) -> str:
        try:
            return "".join(self.process.stream(_run, code, source, first))
        except ReplicateError as error:
            raise TemplateError(str(error)) from error


def _run(code: str, source: str, first: int) -> Iterator[str]:
    """Run a program, in whose frames the lines are those of the text, and yield what it writes."""
    written = io.StringIO()
    with OwnCode(source, source).running("the program", first), redirect_stdout(written):
        exec(compile("\n" * (first - 1) + code, source, "exec"), _names)  # noqa: S102  -- the paper's own text
    yield written.getvalue()


def _check_width(line: str, place: str) -> None:
    if len(line) > LONGEST_LINE:
        msg = f"{place}: a line has {len(line)} characters, allowed: {LONGEST_LINE}: '{line.strip()[:40]}...'"
        raise TemplateError(msg)
