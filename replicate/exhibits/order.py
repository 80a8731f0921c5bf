"""The order in which a paper's exhibits appear: that of its own list of modules, whatever imports what.

Python runs a module when something first imports it, so the order of definitions depends on every import in the
package. Each described thing therefore remembers the module that defines it, and `in_listed_order` sorts by the place
of that module in the paper's list; within a module the order of definition stays.
"""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Protocol, TypeVar

from replicate.errors import PaperDefinitionError


class Described(Protocol):
    """Anything that a paper's modules define and that remembers where."""

    @property
    def id(self) -> str:
        """Its name within the paper."""

    @property
    def module(self) -> str:
        """Import name of the defining module."""


D = TypeVar("D", bound=Described)


def module_being_imported() -> str:
    """Return the name of the module whose top level is running, the innermost if imports are nested; else ''."""
    frame = inspect.currentframe()
    while frame is not None and frame.f_code.co_name != "<module>":
        frame = frame.f_back
    return "" if frame is None else str(frame.f_globals.get("__name__", ""))


def in_listed_order(described: dict[str, D], package: str, modules: Sequence[str]) -> dict[str, D]:
    """Return the same entries, sorted by the place of their modules in the paper's list.

    What the package's ``__init__`` defines comes first, and what no module of the package defines comes last.

    Parameters
    ----------
    described
        Exhibits, claims, readings or charts, by id.
    package
        Import name of the paper's package.
    modules
        The paper's list, names relative to the package.

    Raises
    ------
    PaperDefinitionError
        If a module defines something but is not in the list: its place would depend on who imports it first.
    """
    places = {package: -1, **{f"{package}.{name}": place for place, name in enumerate(modules)}}
    for entry in described.values():
        if entry.module.startswith(f"{package}.") and entry.module not in places:
            name = entry.module.removeprefix(f"{package}.")
            msg = f"{package}: module '{name}' defines '{entry.id}' but is not listed in the paper's 'modules'"
            raise PaperDefinitionError(msg)
    return dict(sorted(described.items(), key=lambda item: places.get(item[1].module, len(modules))))
