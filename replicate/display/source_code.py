"""The source of an exhibit as HTML: the functions that compute or draw it, with light highlighting."""

from __future__ import annotations

import functools
import html
import inspect
import io
import keyword
import textwrap
import tokenize
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup


@dataclass(frozen=True)
class Source:
    """One function's source: where it is (module and first line) and its text as HTML."""

    where: str
    code: Markup


def sources(functions: list[Callable[..., Any]]) -> list[Source]:
    """Return the sources of the functions, each once, in the order given; built-in functions have none."""
    found: dict[str, Source] = {}
    for function in functions:
        while isinstance(function, functools.partial):
            function = function.func  # noqa: PLW2901 -- what is shown is the function inside
        function = inspect.unwrap(function)  # noqa: PLW2901
        # A function made inside another says little alone: the module shows what it is made of.
        module = inspect.getmodule(function) if "<locals>" in getattr(function, "__qualname__", "") else None
        try:
            lines, first = inspect.getsourcelines(module or function)
        except (OSError, TypeError):
            continue
        where = f"{function.__module__}" + (f", line {first}" if first else "")
        found.setdefault(where, Source(where, highlight(textwrap.dedent("".join(lines)))))
    return list(found.values())


@functools.cache  # several exhibits show one module
def highlight(code: str) -> Markup:
    """Return Python code as HTML: keywords, strings and comments in elements of their own.

    Examples
    --------
    >>> print(highlight("return 1 < x  # why"))
    <b>return</b> 1 &lt; x  <i># why</i>
    """
    out, row, column = [], 1, 0
    lines = code.splitlines(keepends=True)

    def upto(end_row: int, end_column: int) -> str:
        nonlocal row, column
        text = ""
        while row < end_row:
            text += lines[row - 1][column:] if row <= len(lines) else ""
            row, column = row + 1, 0
        text += lines[row - 1][column:end_column] if row <= len(lines) else ""
        column = max(column, end_column)
        return html.escape(text, quote=False)

    try:
        for token in tokenize.generate_tokens(io.StringIO(code).readline):
            element = _element(token)
            if element:
                out.append(upto(*token.start))
                out.append(f"<{element}>{upto(*token.end)}</{element}>")
    except (tokenize.TokenError, SyntaxError):  # a lambda cut out of its expression: shown as it is
        return Markup(html.escape(code.rstrip(), quote=False))  # noqa: S704 -- escaped here
    out.append(upto(len(lines) + 1, 0))
    return Markup("".join(out).rstrip())  # noqa: S704 -- `upto` escapes


def _element(token: tokenize.TokenInfo) -> str:
    if token.type == tokenize.NAME:
        return "b" if keyword.iskeyword(token.string) else ""
    # f-strings are one token before Python 3.12 and several after; only the plain ones look the same in both.
    if token.type == tokenize.STRING and not token.string.lstrip("rRbBuU").startswith(("f", "F")):
        return "s"
    return "i" if token.type == tokenize.COMMENT else ""
