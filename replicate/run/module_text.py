"""What the text of a module says of other modules: which it imports, whether it may find more, and what it changes.

Nothing is run. Only statements count, and where a text leaves room for more, more is assumed.
"""

from __future__ import annotations

import ast
import importlib.util
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path

_BLOCKS = (ast.stmt, ast.excepthandler, ast.match_case)
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)

# Words by which code may reach what no import statement of its own names.
_FINDS = re.compile(
    rb"\b(?:__import__|__dict__|__subclasses__|__init_subclass__|exec|eval|globals|vars|setattr|delattr|_getframe|gc"
    rb"|inspect|pkgutil|runpy|sys\.modules|importlib(?!\.(?:resources|metadata)\b))\b"
    rb"|(?<!replicate)\.(?:exhibits|charts|readings|claims(?!\())\b(?!\s+import)"  # whichever module defined them
)


@dataclass(frozen=True)
class Effects:
    """What statements do besides giving names to values; each by the name with which it begins.

    Attributes
    ----------
    called
        Functions that are called, or decorate something.
    bare
        Functions that are called for the effect alone.
    touched
        What a method is called of for the effect alone, or something is stored in: ``TABLE`` of ``TABLE.rows.clear()``.
    decorating
        What has a method that decorates something.
    """

    called: frozenset[str]
    bare: frozenset[str]
    touched: frozenset[str]
    decorating: frozenset[str]


@dataclass(frozen=True)
class ModuleText:
    """What a module's text says.

    Attributes
    ----------
    imports
        Every name that may be a module in its import statements, wherever they stand.
    names
        What it imports by the names that it uses: ``TABLE`` may be ``paper.tables.TABLE``.
    finds
        Whether it may reach modules that it does not import.
    body
        Its statements.
    """

    imports: tuple[str, ...] = ()
    names: Mapping[str, str] = field(default_factory=dict)
    finds: bool = True
    body: Sequence[ast.stmt] = ()

    @cached_property
    def effects(self) -> Effects:
        """Those of importing it."""
        return effects_of(self.body)

    @cached_property
    def functions(self) -> dict[str, Sequence[ast.stmt]]:
        """The statements of its functions by name."""
        return {node.name: node.body for node in self.body if isinstance(node, _FUNCTIONS)}


@cache
def module_text(path: Path, name: str) -> ModuleText:
    """Return what the file of a module says; of one that is no Python, that it may reach anything."""
    try:
        text = path.read_bytes()
        tree = ast.parse(text)
    except (OSError, SyntaxError, ValueError, RecursionError):
        return ModuleText()
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    imports: list[str] = []
    names: dict[str, str] = {}
    for node in _statements(tree):
        if isinstance(node, ast.Import):
            imports += [alias.name for alias in node.names]
            for alias in node.names:
                top = alias.name.partition(".")[0]
                names[alias.asname or top] = alias.name if alias.asname else top
        elif isinstance(node, ast.ImportFrom):
            try:
                base = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
            except ImportError:
                continue
            full = {alias.asname or alias.name: f"{base}.{alias.name}" for alias in node.names}
            imports += [base, *full.values()]
            names |= full
    finds = _FINDS.search(text) is not None or "*" in names
    return ModuleText(tuple(imports), names, finds, tree.body)


def _statements(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield all statements, in whatever block; an import is no part of an expression, and most nodes are."""
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        waiting += [child for child in ast.iter_child_nodes(node) if isinstance(child, _BLOCKS)]


def effects_of(statements: Iterable[ast.AST]) -> Effects:
    """Return the effects of statements; what is in the functions that they define does not happen."""
    called: set[str] = set()
    bare: set[str] = set()
    touched: set[str] = set()
    decorating: set[str] = set()
    waiting = list(statements)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            (bare if isinstance(node.value.func, ast.Name) else touched).add(_root(node.value))
        elif isinstance(node, ast.With | ast.AsyncWith):
            touched.update(_root(item.context_expr) for item in node.items)
        elif isinstance(node, ast.Assign | ast.Delete):
            touched.update(_root(one) for one in node.targets if isinstance(one, ast.Attribute | ast.Subscript))
        elif isinstance(node, ast.AugAssign):
            touched.add(_root(node.target))
        elif isinstance(node, (*_FUNCTIONS, ast.ClassDef)):
            for one in node.decorator_list:
                function = one.func if isinstance(one, ast.Call) else one
                (called if isinstance(function, ast.Name) else decorating).add(_root(function))
        for child in ast.iter_child_nodes(node):
            if not isinstance(child, _BLOCKS):
                inside = (inner.func for inner in ast.walk(child) if isinstance(inner, ast.Call))
                called.update(function.id for function in inside if isinstance(function, ast.Name))
            elif not isinstance(node, _FUNCTIONS):
                waiting.append(child)
    return Effects(frozenset(called), frozenset(bare), frozenset(touched), frozenset(decorating))


def _root(node: ast.AST) -> str:
    """Return the name with which an expression begins; empty if there is none."""
    while isinstance(node, ast.Attribute | ast.Subscript | ast.Call):
        node = node.func if isinstance(node, ast.Call) else node.value
    return node.id if isinstance(node, ast.Name) else ""
