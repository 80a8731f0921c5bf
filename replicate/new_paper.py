"""The starting point of a new paper: an installable package with one table, one claim and nothing missing."""

from __future__ import annotations

import keyword
import re
from pathlib import Path

import jinja2

from replicate.errors import OutputError, PaperDefinitionError
from replicate.resources import templates_dir
from replicate.staging import staged

_PLACES = {
    "pyproject.toml": "pyproject.toml",
    "__init__.py": "{package}/__init__.py",
    "table_1.py": "{package}/table_1.py",
    "claims.py": "{package}/claims.py",
    "ledger.toml": "{package}/ledger.toml",
    "notes.md": "{package}/notes.md",
    "table-1.csv": "{package}/printed/table-1.csv",
}


def new_paper(id: str, parent: Path) -> Path:
    """Write the package of a new paper and return its folder.

    Parameters
    ----------
    id
        The paper's id: lower-case letters, digits and ``_``, starting with a letter.
    parent
        Where the folder ``replicate-<id>`` is made.

    Raises
    ------
    PaperDefinitionError
        If the id is not of that form.
    OutputError
        If the folder exists or cannot be written.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]*", id) or keyword.iskeyword(id):
        msg = f"'{id}' is not an id of a paper; allowed: lower-case letters, digits and _, starting with a letter"
        raise PaperDefinitionError(msg)
    folder = parent / f"replicate-{id}"
    if folder.exists():
        msg = f"{folder}: exists already; nothing was written"
        raise OutputError(msg)
    package = f"replicate_{id}"
    loader = jinja2.Environment(
        loader=jinja2.FileSystemLoader(templates_dir() / "new_paper"),
        undefined=jinja2.StrictUndefined,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701 -- the templates make Python, TOML and Markdown, not HTML
    )
    with staged(parent) as aside:
        for name, place in _PLACES.items():
            path = aside / folder.name / place.format(package=package)
            path.parent.mkdir(parents=True, exist_ok=True)
            text = loader.get_template(f"{name}.jinja").render(id=id, package=package)
            path.write_text(text, encoding="utf-8", newline="\n")
    return folder
