"""Arithmetic expressions as text: exact for exact arguments, and nothing but arithmetic."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from replicate.loops.errors import TuningRuleError

Number = float | Fraction
Formula = Callable[[Mapping[str, Number]], Number]

_OPERATIONS: dict[type[ast.operator], Callable[[Any, Any], Number]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


def formula(text: str) -> Formula:
    """Parse an arithmetic expression into a function of its symbols.

    Allowed are numbers, names, parentheses, a leading minus and ``+ - * / **``. Integers stay integers, so
    that an expression without decimals is exact for exact (`fractions.Fraction`) arguments.

    Parameters
    ----------
    text
        The expression in Python notation, for example ``"tau/(K*(tau_cl + L))"``.

    Returns
    -------
    Callable
        Takes a mapping from symbol to number and returns the value; a missing symbol raises `KeyError`.

    Raises
    ------
    TuningRuleError
        If the text is not such an expression.

    Examples
    --------
    >>> formula("tau/(K*(tau_cl + L))")({"tau": 1.0, "K": 1.0, "tau_cl": 0.25, "L": 1.0})
    0.8
    """
    return _function(_parsed(text))


def formula_tree(text: str) -> float | str | list[Any]:
    """Return an arithmetic expression as data: a number, the name of a symbol, or ``[operation, left, right]``.

    Parameters
    ----------
    text
        As for `formula`, with the same errors.

    Examples
    --------
    >>> formula_tree("2*L**0.5 - 1")
    ['-', ['*', 2, ['**', 'L', 0.5]], 1]
    """
    return _tree(_parsed(text))


def _parsed(text: str) -> ast.expr:
    try:
        tree = ast.parse(text, mode="eval").body
    except SyntaxError as error:
        msg = f"'{text}' is not an arithmetic expression"
        raise TuningRuleError(msg) from error
    for node in ast.walk(tree):
        allowed = (ast.BinOp, ast.UnaryOp, ast.Name, ast.Constant, ast.operator, ast.USub, ast.Load)
        number = not isinstance(node, ast.Constant) or type(node.value) in {int, float}
        known = not isinstance(node, ast.BinOp) or type(node.op) in _OPERATIONS
        if not (isinstance(node, allowed) and number and known):
            msg = f"'{text}' may hold numbers, names and + - * / ** only"
            raise TuningRuleError(msg)
    return tree


_SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}


def _tree(node: ast.expr) -> float | str | list[Any]:
    match node:
        case ast.Constant(value=int() | float() as value):
            return value
        case ast.Name(id=name):
            return name
        case ast.UnaryOp(operand=operand):
            return ["*", -1, _tree(operand)]
        case ast.BinOp(left=left, op=op, right=right):
            return [_SIGNS[type(op)], _tree(left), _tree(right)]
        case _:  # pragma: no cover - `_parsed` has refused everything else
            raise AssertionError


def _function(node: ast.expr) -> Formula:
    """Return the function of an expression, put together once of those of its parts."""
    match node:
        case ast.Constant(value=int() | float() as value):
            return lambda _: value
        case ast.Name(id=name):
            return operator.itemgetter(name)
        case ast.UnaryOp(operand=operand):
            positive = _function(operand)
            return lambda symbols: -positive(symbols)
        case ast.BinOp(left=left, op=op, right=right):
            operation, first, second = _OPERATIONS[type(op)], _function(left), _function(right)
            return lambda symbols: operation(first(symbols), second(symbols))
        case _:  # pragma: no cover - `_parsed` has refused everything else
            raise AssertionError
