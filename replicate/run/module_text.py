"""What the text of a module says of other modules: which it imports, and whether it may find more.

Nothing is run. Only statements count, and where a text leaves room for more, more is assumed.
"""

from __future__ import annotations

import ast
import importlib.util
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path

_BLOCKS = (ast.stmt, ast.excepthandler, ast.match_case)

# Words by which code may reach what no import statement of its own names.
_FINDS = re.compile(
    rb"\b(?:__import__|__dict__|__file__|__subclasses__|__init_subclass__|exec|eval|globals|vars|setattr|delattr"
    rb"|_getframe|getattr\(\s*sys|from\s+sys\s+import|gc|inspect|pkgutil|runpy|pydoc|pickle|marshal|joblib|mock|subprocess"
    rb"|multiprocessing|importlib(?!\.(?:resources|metadata)\b))\b"
    rb"|\.modules\b"
    rb"|(?<!replicate)\.(?:exhibits|charts|readings|claims(?!\())\b(?!\s+import)"  # whichever module defined them
)


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
    def functions(self) -> dict[str, ast.FunctionDef]:
        """Its functions by name; of one that is defined twice, neither."""
        found = [node for node in self.body if isinstance(node, ast.FunctionDef)]
        times = Counter(node.name for node in found)
        return {node.name: node for node in found if times[node.name] == 1}


def module_text(path: Path, name: str) -> ModuleText:
    """Return what the file of a module says; of one that is no Python, that it may reach anything."""
    try:
        return _module_text(path.read_bytes(), name if path.name == "__init__.py" else name.rpartition(".")[0])
    except (OSError, SyntaxError, ValueError, RecursionError):
        return ModuleText()


@cache
def _module_text(text: bytes, package: str) -> ModuleText:
    tree = ast.parse(text)
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
