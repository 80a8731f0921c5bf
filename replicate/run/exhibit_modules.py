"""Which modules of a paper an exhibit does not depend on, so that a changed figure leaves the paper's tables alone.

An exhibit depends on the modules that define it, on all that these import, directly or not, and on every module that
may change something else when it is imported: register with it, store in it. Where a module that is reached may find
others by other ways than import statements, the exhibit depends on all.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Iterator
from functools import cached_property, partial
from typing import Any

from replicate.exhibits import Claims, Exhibit, Figure, Table
from replicate.run.module_text import ModuleText, module_text
from replicate.run.modules import file_of, is_framework
from replicate.run.quiet_imports import QuietImport


class PaperModules:
    """The modules of a paper, and of what lies beside it.

    Parameters
    ----------
    package
        Of the paper.
    names
        Of the loaded modules that count by their content.
    """

    def __init__(self, package: str, names: Collection[str]) -> None:
        self._package = package
        self._texts = {name: _text(name) for name in sorted(names)}

    def unused(self, exhibit: Exhibit) -> set[str]:
        """Return the modules of the package that an exhibit does not depend on."""
        waiting = [self._package, *self._changing, *(name for name in _defining(exhibit) if name)]
        if not self._texts.keys() >= {*waiting}:
            return set()
        reached: set[str] = set()
        while waiting:
            name = waiting.pop()
            if name in reached or name not in self._texts:
                continue
            reached.add(name)
            if name in self._finding:
                return set()
            waiting += [name.rpartition(".")[0], *self._texts[name].imports]
        return {name for name in self._texts if name.startswith(f"{self._package}.")} - reached

    @cached_property
    def _finding(self) -> set[str]:
        """The modules that may reach others by other ways than import statements."""
        return {name for name in self._texts if self._finds(name)}

    def _finds(self, name: str) -> bool:
        """Say whether a module may reach others by other ways than import statements."""
        text = self._texts[name]
        if name == self._package:  # whose face is whole before any module that defines an exhibit
            return text.finds
        return text.finds or any(self._is_package(full) for full in text.names.values())

    def _is_package(self, name: str) -> bool:
        """Say whether a name is that of a package of ours, which has every module below it as an attribute."""
        return hasattr(sys.modules.get(name), "__path__") and any(one.startswith(f"{name}.") for one in self._texts)

    @cached_property
    def _changing(self) -> list[str]:
        """The modules that may change something else when they are imported."""
        texts = self._texts
        return [name for name in texts if not QuietImport(name, texts).changes_nothing()]


def _text(name: str) -> ModuleText:
    path = file_of(name)
    return ModuleText() if path is None else module_text(path, name)


def _defining(exhibit: Exhibit) -> Iterator[str]:
    """Yield the modules that define an exhibit and what belongs to it."""
    yield exhibit.module
    if isinstance(exhibit, Table):
        for reading in exhibit.readings.values():
            functions = (reading.compute, reading.many, *reading.rules_out.values())
            yield from (reading.module, *map(_module, functions))
        yield from (_module(exhibit.trials), _module(exhibit.computed_trial))
    elif isinstance(exhibit, Figure):
        yield _module(exhibit.draw)
    elif isinstance(exhibit, Claims):
        for claim in exhibit.claims.values():
            yield from (claim.module, _module(claim.check))


def _module(function: Callable[..., Any] | None) -> str:
    """Return the module of a function; empty for one of the framework's, whose arguments are those of the paper's."""
    while isinstance(function, partial):
        function = function.func
    name = getattr(function, "__module__", None) or ""
    return "" if is_framework(name) else name
