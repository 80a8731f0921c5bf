"""Prose that pulls its numbers from the results: ledger explanations, notes and handouts.

The texts are Jinja2 templates over Markdown. They can call:

``value(exhibit, row, column, reading="as-written", digits=6)``
    a computed number as text, with so many significant digits;
``number(exhibit, row, column, reading="as-written")``
    the same as a number, to compute with (``{{ (number(...) / number(...)) | digits(3) }}``);
``lower(exhibit, row, column, reading="as-written", digits=4)``, ``upper(...)``
    the ends of its range, for a reading that takes inputs from the print;
``printed(exhibit, row, column)``
    the text the paper prints;
``verdict(exhibit, row, column="claim")``
    the verdict on a printed value or claim;
``count(exhibit=None, verdict=None)``
    how many printed values (or claims, for a claims exhibit or a claim's verdict) there are;
``claim(id, exhibit="claims")``
    the `Finding` of a claim: ``.verdict``, ``.value``, ``.evidence``.

Whatever does not exist is an error that names file, line and what was asked for: no text is ever silently
empty. Comments are written ``<!--# ... #-->``, since ``{#`` begins an identifier in pandoc's Markdown.
"""

from __future__ import annotations

import re
import traceback
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING

from replicate.errors import TemplateError, listed
from replicate.exhibits import AS_WRITTEN, Finding, Paper
from replicate.exhibits.frames import CellError
from replicate.exhibits.results import ClaimsResult, Result, TableResult
from replicate.verdicts.rows import CLAIM_COLUMN, CLAIM_VERDICTS, VALUE_VERDICTS, VerdictRow

if TYPE_CHECKING:
    from replicate.verdicts.sandbox import SafeEnvironment

_listed = partial(listed, most=12)
_MOST_DIGITS = 17  # a floating-point number has no more
_LINE_MARK = re.compile("\ue010(\\d+)\ue011")


class _MissingResultError(Exception):
    """Raised inside a template; `Prose.render` adds file and line."""


class Prose:
    """Renders the texts of one paper.

    Parameters
    ----------
    paper
        The paper whose texts these are.
    results
        Results by (paper, exhibit).
    verdicts
        The verdict rows of the paper.
    functions
        More functions for the templates, for example the one that places an exhibit in the notes. They may
        raise `TemplateError`.
    """

    def __init__(
        self,
        paper: Paper,
        results: Mapping[tuple[str, str], Result],
        verdicts: Sequence[VerdictRow],
        functions: Mapping[str, Callable[..., object]] | None = None,
    ) -> None:
        self._paper = paper
        self._results = results
        self._verdicts = [row for row in verdicts if row.paper == paper.id]
        self._by_cell = {(row.exhibit, row.row, row.column): row for row in self._verdicts}
        self._environment = _environment()
        self._functions: dict[str, object] = {
            "value": self._value,
            "number": self._number,
            "lower": partial(self._end, "lower"),
            "upper": partial(self._end, "upper"),
            "printed": self._printed,
            "verdict": self._verdict,
            "count": self._count,
            "claim": self._claim,
        }
        self._functions |= functions or {}

    def render(self, text: str, source: str, first_line: int = 1, **variables: object) -> str:
        """Fill in a text.

        Parameters
        ----------
        text
            The template.
        source, first_line
            File, and the line of it where the text begins, for error messages.
        variables
            Further names the template may use.

        Raises
        ------
        TemplateError
            If the template is malformed or asks for something that does not exist.
        """
        import jinja2

        from replicate.verdicts.template_budget import LimitError

        try:
            return self._environment.fill(text, **self._functions, **variables)
        except jinja2.TemplateSyntaxError as error:
            msg = f"{source}:{first_line + error.lineno - 1}: {error.message}"
            if "No filter named" in msg:
                msg += f" Known: {', '.join(sorted(self._environment.filters))}"
            raise TemplateError(msg) from error
        except (
            _MissingResultError,
            TemplateError,
            jinja2.TemplateError,
            TypeError,
            ValueError,
            ArithmeticError,
            LookupError,
            LimitError,
            RecursionError,
            MemoryError,
        ) as error:
            line = first_line + _template_line(error) - 1
            msg = f"{source}:{line}: {str(error) or type(error).__name__}"
            if msg.endswith(" is undefined"):
                msg += f"; known: {', '.join(sorted({*self._functions, *variables}))}"
            raise TemplateError(msg) from error

    def render_lines(self, text: str, source: str) -> list[tuple[str, int]]:
        """Fill in a text and keep, for every line that comes out, the line of the template it stems from.

        Later stages can then say where in the source something is wrong.

        Raises
        ------
        TemplateError
            As `render`.
        """
        rendered = self.render(_marked(text), source)
        lines, waiting, number = list[tuple[str, int]](), list[str](), 1
        for line in rendered.split("\n"):
            found = _LINE_MARK.findall(line)
            waiting.append(_LINE_MARK.sub("", line))
            if found:  # a value of several lines is marked on its last one only
                number = int(found[-1])
                lines += [(part, number) for part in waiting]
                waiting.clear()
        return lines + [(part, number) for part in waiting]

    def _number(self, exhibit: str, row: str, column: str, reading: str = AS_WRITTEN) -> float:
        where = f"value('{exhibit}', '{row}', '{column}', '{reading}')"
        result = self._result(exhibit, where)
        if not isinstance(result, TableResult):
            msg = f"{where}: '{exhibit}' is not a table; allowed: {self._listed_exhibits(TableResult)}"
            raise _MissingResultError(msg)
        if reading in result.errors:
            msg = f"{where}: the reading failed: {result.errors[reading]}"
            raise _MissingResultError(msg)
        if reading not in result.frames:
            msg = f"{where}: no such reading; allowed: {_listed(result.frames)}"
            raise _MissingResultError(msg)
        cells = result.cells[reading]
        try:
            number = cells.number(row, column)
        except CellError as error:
            msg = f"{where}: {error}; rows: {_listed(cells.rows)}; columns: {_listed(cells.columns)}"
            raise _MissingResultError(msg) from error
        if number is None:
            msg = f"{where}: nothing is computed there"
            raise _MissingResultError(msg)
        return number

    def _value(self, exhibit: str, row: str, column: str, reading: str = AS_WRITTEN, digits: int = 6) -> str:
        return _digits(self._number(exhibit, row, column, reading), digits)

    def _end(self, end: str, exhibit: str, row: str, column: str, reading: str = AS_WRITTEN, digits: int = 4) -> str:
        where = f"{end}('{exhibit}', '{row}', '{column}', '{reading}')"
        result = self._result(exhibit, where)
        ranges = result.ranges if isinstance(result, TableResult) else {}
        if reading not in ranges:
            msg = f"{where}: no such reading with printed inputs; allowed: {_listed(ranges)}"
            raise _MissingResultError(msg)
        ends: Mapping[tuple[str, str], float] = getattr(ranges[reading], end)
        if (row, column) not in ends:
            msg = f"{where}: nothing is computed there"
            raise _MissingResultError(msg)
        return _digits(ends[row, column], digits)

    def _printed(self, exhibit: str, row: str, column: str) -> str:
        return self._verdict_row("printed", exhibit, row, column).printed

    def _verdict(self, exhibit: str, row: str, column: str = CLAIM_COLUMN) -> str:
        return self._verdict_row("verdict", exhibit, row, column).verdict

    def _verdict_row(self, function: str, exhibit: str, row: str, column: str) -> VerdictRow:
        where = f"{function}('{exhibit}', '{row}', '{column}')"
        found = self._by_cell.get((exhibit, row, column))
        if found is None:
            result = self._result(exhibit, where)
            if isinstance(result, TableResult) and AS_WRITTEN in result.errors:
                msg = f"{where}: the reading '{AS_WRITTEN}' failed: {result.errors[AS_WRITTEN]}"
                raise _MissingResultError(msg)
            printed = [key[1:] for key in self._by_cell if key[0] == exhibit]
            columns = dict.fromkeys(other for one, other in printed if one == row)
            allowed = f"columns in that row: {_listed(columns)}" if columns else ""
            allowed = allowed or f"rows: {_listed(dict.fromkeys(one for one, _ in printed))}"
            msg = f"{where}: the paper prints no value there; {allowed}"
            raise _MissingResultError(msg)
        return found

    def _count(self, exhibit: str | None = None, verdict: str | None = None) -> int:
        allowed = (*VALUE_VERDICTS, *CLAIM_VERDICTS)
        if verdict is not None and verdict not in allowed:
            msg = f"count: '{verdict}' is not a verdict; allowed: {', '.join(allowed)}"
            raise _MissingResultError(msg)
        if exhibit is not None:
            self._result(exhibit, f"count('{exhibit}')")
        # A bare count() is about printed numbers; sentences are counted where they are asked for.
        claims_too = exhibit is not None or verdict in CLAIM_VERDICTS
        return sum(
            (exhibit is None or row.exhibit == exhibit)
            and (verdict is None or row.verdict == verdict)
            and (claims_too or row.column != CLAIM_COLUMN)
            for row in self._verdicts
        )

    def _claim(self, id: str, exhibit: str = "claims") -> Finding:
        where = f"claim('{id}', '{exhibit}')"
        result = self._result(exhibit, where)
        if not isinstance(result, ClaimsResult):
            msg = f"{where}: '{exhibit}' holds no claims; allowed: {self._listed_exhibits(ClaimsResult)}"
            raise _MissingResultError(msg)
        if id in result.errors:
            msg = f"{where}: the check failed: {result.errors[id]}"
            raise _MissingResultError(msg)
        if id not in result.findings:
            msg = f"{where}: no such claim; allowed: {_listed(result.findings)}"
            raise _MissingResultError(msg)
        return result.findings[id]

    def _result(self, exhibit: str, where: str) -> Result:
        result = self._results.get((self._paper.id, exhibit))
        if result is None:
            known = exhibit in self._paper.exhibits
            what = "was not computed" if known else "is not an exhibit"
            msg = f"{where}: '{exhibit}' {what}; computed: {self._listed_exhibits()}"
            raise _MissingResultError(msg)
        return result

    def _listed_exhibits(self, kind: type[Result] | None = None) -> str:
        return _listed(
            id
            for id in self._paper.exhibits
            if (result := self._results.get((self._paper.id, id))) is not None
            and (kind is None or isinstance(result, kind))
        )


def check_syntax(text: str, source: str, first_line: int = 1) -> None:
    """Check that a text is a well-formed template; what it asks for is known only after computing.

    Raises
    ------
    TemplateError
        If it is not; the message names file and line.
    """
    import jinja2

    try:
        _environment().parsed(text)
    except jinja2.TemplateSyntaxError as error:
        msg = f"{source}:{first_line + error.lineno - 1}: {error.message}"
        raise TemplateError(msg) from error


@cache
def _marked(text: str) -> str:
    """Return a template with its line number at the end of every line of plain text."""
    import jinja2

    try:
        tokens = list(_environment().lex(text))
    except jinja2.TemplateSyntaxError:
        return text  # rendering it says what is wrong
    out = []
    for first, kind, value in tokens:
        if kind == "data":
            parts = value.split("\n")
            marks = [f"\ue010{first + i}\ue011\n" for i in range(len(parts) - 1)]
            out += [part for pair in zip(parts, [*marks, ""], strict=True) for part in pair]
        else:
            out.append(value)
    return "".join(out)


@cache
def _environment() -> SafeEnvironment:
    import jinja2

    from replicate.verdicts.sandbox import SafeEnvironment

    environment = SafeEnvironment(
        undefined=jinja2.StrictUndefined,
        comment_start_string="<!--#",
        comment_end_string="#-->",
        keep_trailing_newline=True,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=False,
    )
    environment.filters["digits"] = _digits
    return environment


def _digits(number: float, digits: int = 6) -> str:
    """Write a number with so many significant digits."""
    if not 1 <= digits <= _MOST_DIGITS:
        msg = f"the number of digits must be 1 to {_MOST_DIGITS}, not {digits}"
        raise ValueError(msg)
    return f"{float(number) + 0.0:.{digits}g}"  # + 0.0 turns -0 into 0


def _template_line(error: BaseException) -> int:
    """Return the line of the template in which an error arose; 1 if it left no trace there."""
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == "<template>"]
    return next((line for line in reversed(lines) if line is not None), 1)
