"""Whether importing a module leaves everything but the module itself as it is.

Nothing is run: the statements are held against what is known to change nothing else, with the values that the loaded
module has for its names. What is not known to be harmless counts as a change.
"""

from __future__ import annotations

import ast
import builtins
import dataclasses
import functools
import itertools
import math
import sys
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import Any

import numpy as np

from replicate.exhibits import Claims, Exercises, Paper, Table
from replicate.run.module_text import ModuleText
from replicate.run.modules import is_framework, is_standard

_LIBRARIES = {"control", "matplotlib", "mpmath", "numpy", "pandas", "replicate", "scipy"}  # quiet themselves
_BUILTINS = "abs bool complex dict enumerate float frozenset int len list range reversed round set str sum tuple zip"
_ARRAYS = "arange array asarray concatenate geomspace linspace logspace meshgrid multiply polyadd polymul round"
# What is called without a change of anything: neither of its arguments, nor by calling one of them.
_HARMLESS = (
    *(getattr(builtins, name) for name in _BUILTINS.split()),
    *(getattr(np, name) for name in _ARRAYS.split()),
    *(value for value in vars(math).values() if callable(value)),
    *(itertools.chain, itertools.product, Fraction, Path, MappingProxyType, dataclasses.field, dataclasses.replace),
)
_DECORATING = (
    *(functools.cache, functools.lru_cache, functools.cached_property, contextmanager),
    *(dataclasses.dataclass, property, staticmethod, classmethod, np.vectorize),
)
_DESCRIBING = (Paper, Table, Claims, Exercises)  # remember the module that defines what they are given
_DESCRIBED = frozenset(["computed_trial", "trials"])  # what a table is given by assignment
_LOOKING = frozenset(["get", "items", "keys", "values", *(name for name in dir(str) if not name.startswith("_"))])
# Names of methods that change what they belong to.
_CHANGING = frozenset(
    ["byteswap", "fill", "itemset", "partition", "put", "resize", "setfield", "setflags", "sort"]  # of arrays
    + [name for kind in (list, dict, set, bytearray, deque) for name in dir(kind)]
) - frozenset(name for kind in (tuple, frozenset, bytes, MappingProxyType) for name in dir(kind))
_PLAIN = (
    *(ast.BinOp, ast.BoolOp, ast.UnaryOp, ast.Compare, ast.IfExp, ast.Subscript, ast.Slice, ast.Starred, ast.Constant),
    *(ast.Tuple, ast.List, ast.Set, ast.Dict, ast.JoinedStr, ast.FormattedValue, ast.keyword, ast.comprehension),
    *(ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp, ast.expr_context),
    *(ast.operator, ast.unaryop, ast.boolop, ast.cmpop),
)
_BINDING = (ast.For, ast.comprehension, ast.ClassDef)
_MISSING = object()


class QuietImport:
    """A module's import, or the call of a function of it.

    Parameters
    ----------
    name
        Of the module, which is loaded.
    texts
        Of the modules whose own imports are looked at, this one among them.
    function
        One of the module, to be called.
    above
        The functions that call it.
    """

    def __init__(
        self,
        name: str,
        texts: Mapping[str, ModuleText],
        function: str = "",
        above: frozenset[tuple[str, str]] = frozenset(),
    ) -> None:
        self._values = vars(sys.modules[name])
        self._texts = texts
        self._above = above | {(name, function)}
        self._body = texts[name].functions[function].body if function else texts[name].body
        self._passing = set(_passing_names(self._body))
        if function:
            inner = list(ast.walk(texts[name].functions[function]))
            self._passing |= {one.arg for one in inner if isinstance(one, ast.arg)}
            self._passing |= {one.id for one in inner if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)}

    def changes_nothing(self) -> bool:
        """Say whether it leaves everything else as it is."""
        return all(map(self._statement, self._body))

    def _statement(self, node: ast.stmt) -> bool:
        match node:
            case ast.Import(names=names):
                quiet = all(self._may_import(alias.name) for alias in names)
            case ast.ImportFrom(names=names, module=module, level=level):
                quiet = all(alias.name != "*" for alias in names) and (level > 0 or self._may_import(module or ""))
            case ast.FunctionDef(args=arguments, decorator_list=decorators):
                given = (one for one in ast.iter_child_nodes(arguments) if not isinstance(one, ast.arg))
                quiet = all(map(self._expression, given)) and all(map(self._decorator, decorators))
            case ast.ClassDef(bases=bases, keywords=[], body=body, decorator_list=decorators):
                parts = (map(self._base, bases), map(self._decorator, decorators), map(self._statement, body))
                quiet = all(map(all, parts))
            case ast.Assign(targets=targets, value=value):
                quiet = all(map(self._target, targets)) and self._expression(value)
            case ast.AnnAssign(target=ast.Name(), value=value):
                quiet = value is None or self._expression(value)
            case ast.For(target=target, iter=looked_at, body=body, orelse=[]):
                quiet = self._target(target) and self._expression(looked_at) and all(map(self._statement, body))
            case ast.If(test=test, body=body, orelse=rest):
                quiet = self._expression(test) and all(map(self._statement, [*body, *rest]))
            case ast.Expr(value=value):
                quiet = self._expression(value)
            case ast.Return(value=value):
                quiet = value is None or self._expression(value)
            case _:
                quiet = isinstance(node, ast.Pass)
        return quiet

    def _may_import(self, name: str) -> bool:
        return name in self._texts or is_standard(name) or name.partition(".")[0] in _LIBRARIES

    def _base(self, node: ast.expr) -> bool:
        """Say whether deriving from a class runs no code of a paper."""
        return is_standard(getattr(self._value(node), "__module__", None) or "?")

    def _target(self, node: ast.expr) -> bool:
        match node:
            case ast.Tuple(elts=parts):
                return all(map(self._target, parts))
            case ast.Attribute(value=owner, attr=name):
                return name in _DESCRIBED and isinstance(self._value(owner), Table)
            case _:
                return isinstance(node, ast.Name)

    def _decorator(self, node: ast.expr) -> bool:
        arguments, function = (_arguments(node), node.func) if isinstance(node, ast.Call) else ([], node)
        if not all(map(self._expression, arguments)):
            return False
        known = _is_in(self._value(function), _DECORATING) and not any(map(self._has_function, arguments))
        return known or self._describes(function)

    def _describes(self, function: ast.expr) -> bool:
        """Say whether a function is a word in which a paper describes itself, as ``paper.figure``."""
        return isinstance(function, ast.Attribute) and isinstance(self._value(function.value), _DESCRIBING)

    def _expression(self, node: ast.AST) -> bool:
        match node:
            case ast.Call():
                return self._call(node)
            case ast.Lambda(args=arguments):
                return not arguments.defaults and not arguments.kw_defaults
            case ast.Attribute(value=value, attr=name):
                return name not in _CHANGING and self._expression(value)
            case ast.Name():
                return not isinstance(self._value(node), Iterator)  # which is shorter when it has been looked at
            case _:
                return isinstance(node, _PLAIN) and all(map(self._expression, ast.iter_child_nodes(node)))

    def _call(self, node: ast.Call) -> bool:
        arguments, function = _arguments(node), self._value(node.func)
        if not all(map(self._expression, arguments)):
            return False
        if isinstance(node.func, ast.Call):  # table.reading(...)(compute)
            return self._describes(node.func.func) and all(map(self._expression, _arguments(node.func)))
        if self._describes(node.func) or function is functools.partial or self._is_record(function):
            return True
        return not any(map(self._has_function, arguments)) and self._only_returns(node, function)

    def _only_returns(self, node: ast.Call, function: Any) -> bool:
        """Say whether what is called, without functions among its arguments, changes nothing."""
        if any(one.arg == "out" for one in node.keywords):
            return False
        if isinstance(node.func, ast.Attribute) and node.func.attr in _LOOKING:
            return _home(function) not in self._texts and self._expression(node.func.value)
        known = isinstance(function, np.ufunc) or _is_in(function, _HARMLESS) or is_framework(_home(function))
        return known or self._is_quiet(function)

    def _has_function(self, node: ast.AST) -> bool:
        """Say whether an argument has a function of a paper, which may be called."""
        if isinstance(node, ast.Lambda) or self._is_ours(self._value(node)):
            return True
        parts = [one for one in ast.iter_child_nodes(node) if not (isinstance(node, ast.Call) and one is node.func)]
        return any(map(self._has_function, parts))

    def _is_ours(self, value: Any) -> bool:
        return callable(value) and not isinstance(value, type) and _home(value) in self._texts

    def _is_quiet(self, value: Any) -> bool:
        """Say whether a function of a paper changes nothing when it is called."""
        home, name = _home(value), getattr(value, "__qualname__", "")
        if home not in self._texts or name not in self._texts[home].functions or (home, name) in self._above:
            return False
        return QuietImport(home, self._texts, name, self._above).changes_nothing()

    def _is_record(self, value: Any) -> bool:
        """Say whether a value is a class of a paper whose objects are made by what Python has written itself."""
        if type(value) is not type or _home(value) not in self._texts:
            return False
        if hasattr(value, "__post_init__") or hasattr(value, "__set_name__"):
            return False
        makers = (getattr(kind, name, None) for kind in value.__mro__ for name in ("__init__", "__new__"))
        return all(getattr(getattr(one, "__code__", None), "co_filename", "<string>") == "<string>" for one in makers)

    def _value(self, node: ast.AST) -> Any:
        """Return the value of a name, or of an attribute of a module, class or object of the framework."""
        if isinstance(node, ast.Name) and node.id not in self._passing:
            return self._values.get(node.id, getattr(builtins, node.id, _MISSING))
        if isinstance(node, ast.Attribute):
            owner = self._value(node.value)
            if isinstance(owner, ModuleType | type):
                return getattr(owner, node.attr, _MISSING)
            return getattr(type(owner), node.attr, _MISSING)
        return _MISSING


def _passing_names(body: Iterable[ast.stmt]) -> Iterator[str]:
    """Yield the names that have other values than the module has for them: in loops, comprehensions and classes."""
    for node in _nodes(body):
        if isinstance(node, _BINDING):
            places = node.body if isinstance(node, ast.ClassDef) else [node.target]
            names = (one for place in places for one in ast.walk(place) if isinstance(one, ast.Name))
            yield from (one.id for one in names if isinstance(one.ctx, ast.Store))


def _nodes(body: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """Yield all nodes of some statements, in no order: as `ast.walk`, in half of its time."""
    waiting = list(body)
    while waiting:
        node = waiting.pop()
        yield node
        for name in node._fields:
            part = getattr(node, name, None)
            if isinstance(part, ast.AST):
                waiting.append(part)
            elif isinstance(part, list):
                waiting += [one for one in part if isinstance(one, ast.AST)]


def _arguments(node: ast.Call) -> list[ast.expr]:
    return [*node.args, *(one.value for one in node.keywords)]


def _home(value: Any) -> str:
    return getattr(value, "__module__", None) or ""


def _is_in(value: Any, known: Collection[Any]) -> bool:
    return any(value is one for one in known)
