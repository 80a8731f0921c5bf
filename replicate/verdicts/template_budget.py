"""What a template may use up while it is filled in: steps and characters, whatever it does.

The count is put into the template's own tree before it is compiled. A pass of a loop and a call of a macro are a step,
and so is each item, at any depth, of whatever is made, compared, filtered or handed on. Nothing can then grow or go on
for long without being counted, however it is nested. The count needs no help from the interpreter (a trace function
would be lost to debuggers and to what measures coverage), and is the same on every machine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any

from jinja2 import nodes
from jinja2.utils import Namespace
from jinja2.visitor import NodeTransformer

from replicate.errors import ReplicateError

MOST_STEPS = 250_000  # ours take a few hundred
MOST_TEXT = 1_000_000  # characters, of a whole text and of each on the way
MOST_BITS = 4096  # of a whole number
_CHARACTERS_OF_A_STEP = 100


class LimitError(ReplicateError):
    """A template takes more than it may; the message says of what."""


class _Budget:
    """What is left of the steps and the characters of one text."""

    def __init__(self) -> None:
        self._steps = MOST_STEPS
        self._characters = MOST_TEXT

    @property
    def steps(self) -> int:
        return self._steps

    def step(self, steps: int = 1) -> None:
        self._steps -= steps
        if self._steps < 0:
            msg = f"the text takes more than {MOST_STEPS:,} steps; is there a loop that does not end?"
            raise LimitError(msg)

    def write(self, characters: int) -> None:
        self._characters -= characters
        demand_size(self._characters >= 0)


_budget: ContextVar[_Budget] = ContextVar("_budget")


@contextmanager
def fresh_budget() -> Iterator[None]:
    """Give what runs inside a budget of its own; a text may be filled in while another one is."""
    token = _budget.set(_Budget())
    try:
        yield
    finally:
        _budget.reset(token)


def demand_size(holds: bool) -> None:
    """Refuse what is larger than any text or number needs to be.

    Raises
    ------
    LimitError
        Unless the demand holds.
    """
    if not holds:
        msg = f"the text becomes too large; allowed: {MOST_TEXT:,} characters, numbers of {MOST_BITS} bits"
        raise LimitError(msg)


def counted_pass(characters: int) -> None:
    """Count a pass of a loop, or a call of a macro, that writes so many characters of plain text."""
    budget = _budget.get()
    budget.step()
    budget.write(characters)


def counted(value: Any) -> Any:
    """Return a value after its items, at any depth, have been counted as steps."""
    budget = _budget.get()
    waiting = [value]
    while waiting:
        item = waiting.pop()
        budget.step()
        if isinstance(item, str | bytes):
            demand_size(len(item) <= MOST_TEXT)
            budget.step(len(item) // _CHARACTERS_OF_A_STEP)
        elif isinstance(item, int):
            demand_size(item.bit_length() <= MOST_BITS)
        elif isinstance(item, range):
            budget.step(len(item))
        elif isinstance(item, list | tuple | set | frozenset):
            waiting += item
        elif isinstance(item, dict):
            waiting += [*item, *item.values()]
        elif isinstance(item, Namespace):
            waiting += object.__getattribute__(item, "__dict__")["_Namespace__attrs"].values()
        if len(waiting) > budget.steps:
            budget.step(len(waiting))
    return value


def counted_output(value: object) -> str:
    """Return what is written in the place of an expression, after its characters have been counted."""
    text = str(counted(value))
    _budget.get().write(len(text))
    return text


def counting(function: Any) -> Callable[..., Any]:
    """Return a filter or test that counts what it is given and what it makes."""

    @wraps(function)  # keeps the mark by which Jinja knows what to hand in
    def counted_call(*arguments: Any, **named: Any) -> Any:
        counted((arguments, named))
        return counted(function(*arguments, **named))

    return counted_call


_MAKES = (nodes.Concat, nodes.List, nodes.Dict, nodes.Tuple)


class CountedTree(NodeTransformer):
    """Put the count into the tree of a template.

    The environment must offer `counted_pass` and `counted` under these names.
    """

    def generic_visit(self, node: nodes.Node, *_: object, **__: object) -> nodes.Node:
        """Return a node, or what counts it, after everything below has been dealt with."""
        super().generic_visit(node)
        if isinstance(node, nodes.For):
            node.iter = _counted(node.iter)
        if isinstance(node, nodes.For | nodes.Macro | nodes.CallBlock):
            plain_text = sum(len(data.data) for data in node.find_all(nodes.TemplateData))
            call = _call("counted_pass", nodes.Const(plain_text), node.lineno)
            node.body.insert(0, nodes.ExprStmt(call, lineno=node.lineno))
        if isinstance(node, nodes.Compare):
            node.expr = _counted(node.expr)
            for operand in node.ops:
                operand.expr = _counted(operand.expr)
        stored = isinstance(node, nodes.Tuple) and node.ctx != "load"
        return _counted(node) if isinstance(node, _MAKES) and not stored else node


def _counted(node: Any) -> nodes.Call:
    return _call("counted", node, node.lineno)


def _call(method: str, argument: nodes.Expr, line: int) -> nodes.Call:
    function = nodes.EnvironmentAttribute(method, lineno=line)
    return nodes.Call(function, [argument], [], None, None, lineno=line)
