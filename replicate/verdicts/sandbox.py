"""Templates that are safe to take from a stranger: they can compute with results and nothing else, and they end.

Jinja's own sandbox keeps a text from reaching what lies behind the objects that it is given. Here it is also kept from
running for ever and from filling the memory: steps, output and every text on the way are counted and limited, and what
builds large things in one step (powers, padding, multiplied texts) is looked at before or missing.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import jinja2
from jinja2 import Template, nodes
from jinja2.filters import do_round
from jinja2.runtime import Context
from jinja2.sandbox import ImmutableSandboxedEnvironment

from replicate.verdicts.template_budget import (
    MOST_BITS,
    MOST_TEXT,
    CountedTree,
    LimitError,
    counted,
    counted_output,
    counted_pass,
    counting,
    demand_size,
    fresh_budget,
)

_MOST_DECIMALS = 17  # a floating-point number has no more digits

_FILTERS = (
    "abs attr capitalize count d default dictsort e escape first float int items join last length list lower map max "
    "min reject rejectattr replace reverse round select selectattr sort string sum title trim unique upper wordcount"
)
_GLOBALS = ("range", "dict", "namespace")
_TEXT_METHODS = {"capitalize", "count", "endswith", "find", "isalpha", "isdigit", "lower", "lstrip", "removeprefix"} | {
    "removesuffix", "rstrip", "split", "splitlines", "startswith", "strip", "title", "upper",
}  # fmt: skip
_FORBIDDEN = (nodes.Include, nodes.Import, nodes.FromImport, nodes.Extends)


class SafeEnvironment(ImmutableSandboxedEnvironment):
    """Jinja's sandbox with limits on everything that grows."""

    intercepted_binops = frozenset({"*", "**", "%", "+"})
    counted = staticmethod(counted)
    counted_pass = staticmethod(counted_pass)

    def __init__(self, **options: Any) -> None:
        super().__init__(finalize=_written, **options)
        self.globals = {name: self.globals[name] for name in _GLOBALS}
        filters = {name: self.filters[name] for name in _FILTERS.split()}
        filters |= {"join": _join, "replace": _replace, "round": _round}
        self.filters = {name: counting(function) for name, function in filters.items()}
        self.tests = {name: counting(function) for name, function in self.tests.items()}

    def is_safe_attribute(self, obj: Any, attr: str, value: Any) -> bool:
        """Allow what the sandbox does, of texts only methods that make none that is larger."""
        if isinstance(obj, str | bytes):
            return attr in _TEXT_METHODS
        return super().is_safe_attribute(obj, attr, value)

    def wrap_str_format(self, value: Any) -> None:
        """Treat ``format`` like any other method of a text: it can pad without limit."""

    def call_binop(self, context: Context, operator: str, left: Any, right: Any) -> Any:
        """Compute, unless the result is larger than any text or number needs to be."""
        sized = [operand for operand in (left, right) if hasattr(operand, "__len__")]
        if operator == "%" and isinstance(left, str | bytes):
            msg = "a text cannot be formatted with %; use the filter digits"
            raise LimitError(msg)
        if operator == "*" and sized:
            times = right if sized[0] is left else left
            demand_size(not isinstance(times, int) or len(sized[0]) * times <= MOST_TEXT)
        elif operator == "+" and len(sized) > 1:
            demand_size(len(left) + len(right) <= MOST_TEXT)
        elif operator in {"*", "**"} and isinstance(left, int) and isinstance(right, int):
            bits = left.bit_length() * max(right, 0) if operator == "**" else left.bit_length() + right.bit_length()
            demand_size(bits <= MOST_BITS)
        return counted(super().call_binop(context, operator, left, right))

    def call(self, context: Context, function: Any, /, *arguments: Any, **named: Any) -> Any:
        """Call a function or macro, and count what it is given and what it makes."""
        if function in {counted, counted_pass}:
            return function(*arguments)
        counted((arguments, named))
        return counted(super().call(context, function, *arguments, **named))

    def parsed(self, text: str) -> nodes.Template:
        """Return the tree of a template.

        Raises
        ------
        jinja2.TemplateSyntaxError
            If it is malformed, nests too deeply, or takes in another file.
        """
        try:
            tree = self.parse(text)
        except RecursionError as error:
            msg = "the expression nests too deeply"
            raise jinja2.TemplateSyntaxError(msg, self._deepest_line(text)) from error
        for node in tree.find_all(_FORBIDDEN):
            kind = type(node).__name__.lower().replace("fromimport", "import")
            msg = f"'{kind}' is not available: a text stands alone"
            raise jinja2.TemplateSyntaxError(msg, node.lineno)
        return tree

    def _deepest_line(self, text: str) -> int:
        """Return the line with most operators, in which what nests too deeply must lie."""
        lines = [number for number, kind, _ in self.lex(text) if kind in {"operator", "name"}]
        return max(set(lines), key=lines.count, default=1)

    def fill(self, text: str, **variables: object) -> str:
        """Return a text filled in.

        Raises
        ------
        LimitError
            If it takes too many steps, or becomes too long.
        """
        template = _compiled(self, text)
        with fresh_budget():
            return "".join(template.generate(**variables))


@lru_cache(maxsize=16)
def _compiled(environment: SafeEnvironment, text: str) -> Template:
    """Return a template; the sheets of a class fill in the same one again and again."""
    return environment.from_string(CountedTree().visit(environment.parsed(text)))


@jinja2.pass_context  # or Jinja would write constants, uncounted, when it compiles
def _written(_context: Context, value: object) -> str:
    return counted_output(value)


def _join(texts: Any, separator: str = "", attribute: Any = None) -> str:
    from operator import attrgetter

    parts = [str(attrgetter(attribute)(text) if attribute else text) for text in texts]
    demand_size(sum(map(len, parts)) + len(separator) * len(parts) <= MOST_TEXT)
    return separator.join(parts)


def _replace(text: object, old: str, new: str, count: int = -1) -> str:
    whole = str(text)
    demand_size(len(whole) + (len(whole) + 1) * len(new) <= MOST_TEXT or whole.count(old) * len(new) <= MOST_TEXT)
    return whole.replace(old, new, count)


def _round(number: float, decimals: int = 0, method: Any = "common") -> float:
    if abs(decimals) > _MOST_DECIMALS:
        msg = f"the number of decimals must be at most {_MOST_DECIMALS}, not {decimals}"
        raise ValueError(msg)
    return do_round(number, decimals, method)
