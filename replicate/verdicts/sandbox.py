"""Templates that are safe to take from a stranger: they can compute with results and nothing else, and they end.

Jinja's own sandbox keeps a text from reaching what lies behind the objects that it is given. Here it is also kept from
running for ever and from filling the memory: steps, output and every text on the way have a limit, and what builds
large things in one step (powers, padding, multiplied texts) is limited or missing.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import lru_cache
from types import FrameType
from typing import Any

import jinja2
from jinja2 import Template, nodes
from jinja2.runtime import Context
from jinja2.sandbox import ImmutableSandboxedEnvironment
from jinja2.utils import Namespace

from replicate.errors import ReplicateError

MOST_STEPS = 100_000  # lines of a template that are carried out; ours take a few hundred
MOST_TEXT = 1_000_000  # characters
_MOST_BITS = 4096

_FILTERS = (
    "abs attr capitalize count d default dictsort e escape first float int items join last length list lower map max "
    "min reject rejectattr replace reverse round select selectattr sort string sum title trim unique upper wordcount"
)
_GLOBALS = ("range", "dict", "namespace")
_TEXT_METHODS = {"capitalize", "count", "endswith", "find", "isalpha", "isdigit", "lower", "lstrip", "removeprefix"} | {
    "removesuffix", "rstrip", "split", "splitlines", "startswith", "strip", "title", "upper",
}  # fmt: skip
_FORBIDDEN = (nodes.Include, nodes.Import, nodes.FromImport, nodes.Extends)


class LimitError(ReplicateError):
    """A template takes more than it may; the message says of what, `line` where it was (0: see the traceback)."""

    line = 0


class SafeEnvironment(ImmutableSandboxedEnvironment):
    """Jinja's sandbox with limits on everything that grows."""

    intercepted_binops = frozenset({"*", "**", "%", "+"})

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.globals = {name: self.globals[name] for name in _GLOBALS}
        self.filters = {name: self.filters[name] for name in _FILTERS.split()} | {"join": _join, "replace": _replace}

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
            _demand(not isinstance(times, int) or len(sized[0]) * times <= MOST_TEXT)
        elif operator == "+" and len(sized) > 1:
            _demand(len(left) + len(right) <= MOST_TEXT)
        elif operator in {"*", "**"} and isinstance(left, int) and isinstance(right, int):
            bits = left.bit_length() * max(right, 0) if operator == "**" else left.bit_length() + right.bit_length()
            _demand(bits <= _MOST_BITS)
        return super().call_binop(context, operator, left, right)

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
        pieces, size = [], 0
        watched = _Watched()
        try:
            with watched:
                for piece in template.generate(**variables):
                    size += len(piece)
                    _demand(size <= MOST_TEXT)
                    pieces.append(piece)
        except LimitError as error:
            error.line = template.get_corresponding_lineno(watched.line)
            raise
        return "".join(pieces)


@lru_cache(maxsize=16)
def _compiled(environment: SafeEnvironment, text: str) -> Template:
    """Return a template; the sheets of a class fill in the same one again and again."""
    return environment.from_string(environment.parsed(text))


def _demand(holds: bool) -> None:
    if not holds:
        msg = f"the text becomes too large; allowed: {MOST_TEXT:,} characters, numbers of {_MOST_BITS} bits"
        raise LimitError(msg)


def _join(texts: Any, separator: str = "", attribute: Any = None) -> str:
    from operator import attrgetter

    parts = [str(attrgetter(attribute)(text) if attribute else text) for text in texts]
    _demand(sum(map(len, parts)) + len(separator) * len(parts) <= MOST_TEXT)
    return separator.join(parts)


def _replace(text: object, old: str, new: str, count: int = -1) -> str:
    whole = str(text)
    _demand(len(whole) + (len(whole) + 1) * len(new) <= MOST_TEXT or whole.count(old) * len(new) <= MOST_TEXT)
    return whole.replace(old, new, count)


class _Watched:
    """Count the steps that templates take inside a ``with`` block, and look at the texts that they hold."""

    def __enter__(self) -> None:
        self._steps = self.line = 0
        self._before = sys.gettrace()
        sys.settrace(self._called)

    def __exit__(self, *_: object) -> None:
        sys.settrace(self._before)

    def _called(self, frame: FrameType, event: Any, argument: object) -> Any:
        if frame.f_code.co_filename == "<template>":
            # Jinja rewrites the traceback of an error with frames of its own.
            return None if "__jinja_exception__" in frame.f_globals else self._stepped
        return self._before(frame, event, argument) if self._before is not None else None

    def _stepped(self, frame: FrameType, event: str, _argument: object) -> Any:
        if event != "line":
            return self._stepped
        self._steps += 1
        self.line = frame.f_lineno
        if self._steps > MOST_STEPS:
            msg = f"the text takes more than {MOST_STEPS:,} steps; is there a loop that does not end?"
            raise LimitError(msg)
        for value in _texts(frame):
            _demand(len(value) <= MOST_TEXT)
        return self._stepped


def _texts(frame: FrameType) -> Iterator[str]:
    """Yield every text that a template holds in a variable of its own."""
    held = [value for name, value in frame.f_locals.items() if name.startswith("l_")]
    for namespace in [value for value in held if isinstance(value, Namespace)]:
        held += object.__getattribute__(namespace, "__dict__")["_Namespace__attrs"].values()
    return (value for value in held if isinstance(value, str))
