"""What a report says about its papers as a whole: title, introduction, page on methods, language and colours."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from types import MappingProxyType

from replicate.errors import TemplateError
from replicate.plain_text import read_text
from replicate.run.project import Project

INDEX = "index.html"

_TITLE = "Papers, replicated"
_INTRO = (
    "A paper prints numbers. Here each of them is recomputed and compared at the precision at which it was "
    "printed. Where a number does not hold, the report says why."
)


@dataclass(frozen=True)
class Site:
    """Texts and looks of a report.

    Attributes
    ----------
    intro, methods
        Markdown; without `methods` the report has no such page.
    theme
        Colours by name, as in `replicate.run.project.Project`.
    """

    title: str = _TITLE
    intro: str = _INTRO
    methods: str = ""
    language: str = "en"
    theme: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))


def site_of(project: Project | None, *, bundled: bool) -> Site:
    """Return the texts of a report.

    Parameters
    ----------
    project
        Its title, introduction and methods come first.
    bundled
        Whether all papers of the report are bundled ones: their collection has texts of its own.
    """
    default = _collection() if bundled else Site()
    if project is None or (bundled and not project.bundled):
        return default
    methods = read_text(project.methods, project.methods.name, TemplateError) if project.methods else default.methods
    return Site(
        project.title or default.title, project.intro or default.intro, methods, project.language.code, project.theme
    )


def _collection() -> Site:
    folder = files("replicate.papers")
    texts = tomllib.loads((folder / "collection.toml").read_text(encoding="utf-8"))
    methods = (folder / texts["methods"]).read_text(encoding="utf-8")
    return Site(texts["title"], " ".join(texts["intro"].split()), methods)
