"""The public names: what `__all__` lists can be imported, and every parameter is described where it is used."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Callable, Iterator
from types import ModuleType

import pytest

import replicate

PACKAGES = ("replicate.exhibits", "replicate.figures", "replicate.loops", "replicate.loops.tune")

#: Names that a docstring may give several of, as in "rows, columns" or "*args".
_ENTRY = re.compile(r"^(\*{0,2}\w+(?:, \*{0,2}\w+)*)(?: :.*)?$", re.MULTILINE)


def packages() -> list[str]:
    found = pkgutil.walk_packages(replicate.__path__, "replicate.")
    return [info.name for info in found if info.ispkg and not info.name.startswith("replicate.papers.")]


@pytest.mark.parametrize("name", packages())
def test_all_is_what_can_be_imported(name: str) -> None:
    package = importlib.import_module(name)
    listed = getattr(package, "__all__", [])
    assert len(set(listed)) == len(listed)
    assert set(exported(package)) <= set(listed)
    assert all(hasattr(package, name) for name in listed)  # some are imported when they are asked for


def exported(package: ModuleType) -> Iterator[str]:
    """Yield what the face of a package offers: names without an underscore that are not its own modules."""
    own = {info.name for info in pkgutil.iter_modules(package.__path__)}
    for name, value in vars(package).items():
        # "@": pytest rewrites the assertions of a distribution that has a plugin, and leaves two names.
        if not name.startswith(("_", "@")) and not (inspect.ismodule(value) and name in own) and name not in MACHINERY:
            yield name


MACHINERY = {"annotations", "TYPE_CHECKING"}


@pytest.mark.parametrize("name", PACKAGES)
def test_every_parameter_is_documented(name: str) -> None:
    wrong = [line for public, thing in public_things(name) for line in undocumented(public, thing)]
    assert not wrong


def public_things(name: str) -> Iterator[tuple[str, Callable[..., object]]]:
    """Yield the public functions and classes of a package, and the public methods of the classes."""
    package = importlib.import_module(name)
    for public in package.__all__:
        thing = getattr(package, public)
        if not callable(thing) or not getattr(thing, "__module__", "").startswith("replicate"):
            continue
        yield public, thing
        if inspect.isclass(thing):
            for method, value in vars(thing).items():
                function = value.__func__ if isinstance(value, classmethod | staticmethod) else value
                if not method.startswith("_") and inspect.isfunction(function):
                    yield f"{public}.{method}", function


def undocumented(name: str, thing: Callable[..., object]) -> list[str]:
    if inspect.isclass(thing) and issubclass(thing, Exception):
        return []
    text = inspect.getdoc(thing) or ""
    named = [
        key for key in inspect.signature(thing).parameters if key not in ("self", "cls") and not key.startswith("_")
    ]
    described = documented(text, "Parameters", "Attributes")
    missing = [f"{name}: {key} is not described" for key in named if key not in described and f"``{key}``" not in text]
    stale = sorted(documented(text, "Parameters") - set(named))
    return missing + [f"{name}: {key} is described, but is not a parameter" for key in stale]


def documented(text: str, *titles: str) -> set[str]:
    """Return the names that a NumPy docstring describes under these titles."""
    names: set[str] = set()
    for title in titles:
        section = re.search(rf"^{title}\n-+\n(.*?)(?=^\w[\w ]*\n-+\n|\Z)", text, re.MULTILINE | re.DOTALL)
        for entry in _ENTRY.findall(section[1]) if section else ():
            names.update(part.lstrip("*") for part in entry.split(", "))
    return names
