"""The starting point of a new paper: a package with one of each kind of exhibit, and nothing missing."""

from __future__ import annotations

import importlib.util
import keyword
import os
import re
import sys
import sysconfig
from pathlib import Path

import jinja2

import replicate
from replicate.errors import OutputError, PaperDefinitionError
from replicate.exhibits.definitions import check_paper_id
from replicate.resources import templates_dir
from replicate.staging import replace_files

_PLACES = {
    "__init__.py": "__init__.py",
    "table_1.py": "table_1.py",
    "fig_1.py": "fig_1.py",
    "claims.py": "claims.py",
    "ledger.toml": "ledger.toml",
    "notes.md": "notes.md",
    "handout.md": "handout.md",
    "table-1.csv": "printed/table-1.csv",
    "test_paper.py": "test_{id}.py",
}


def new_paper(id: str, parent: Path, schemas: Path | None = None) -> Path:
    """Write the package of a new paper and return its folder.

    Parameters
    ----------
    id
        The paper's id: lower-case letters, digits and ``_``, starting with a letter.
    parent
        The folder of papers in which the paper's folder is made.
    schemas
        Folder of the JSON Schemas, which the ledger names for editors if it is given and exists.

    Raises
    ------
    PaperDefinitionError
        If the id is not of that form, or is the name of a page of the report, or of a Python module on this machine.
    OutputError
        If the folder exists or cannot be written.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]*", id):
        msg = f"'{id}' is not an id of a paper; allowed: lower-case letters, digits and _, starting with a letter"
        raise PaperDefinitionError(msg)
    check_paper_id(id)
    kind = "word" if keyword.iskeyword(id) else "module" if _is_module(id) else ""
    if kind:
        msg = f"'{id}' is the name of a Python {kind}; choose another id"
        raise PaperDefinitionError(msg)
    folder = parent / id
    if folder.exists():
        msg = f"{folder}: exists already; nothing was written"
        raise OutputError(msg)
    places = {name: f"{id}/{place.format(id=id)}" for name, place in _PLACES.items()}
    there = schemas is not None and (schemas / "ledger.schema.json").is_file()
    schema = Path(os.path.relpath(schemas / "ledger.schema.json", folder)).as_posix() if schemas and there else ""
    write_templates("new_paper", places, parent, id=id, schema=schema)
    return folder


def _is_module(name: str) -> bool:
    """Say whether Python, or an installed distribution, has a module of this name, which a paper does not hide."""
    if name in sys.stdlib_module_names or name == replicate.__name__:
        return True
    spec = importlib.util.find_spec(name)
    installed = (sysconfig.get_path(kind) for kind in ("purelib", "platlib"))
    return spec is not None and any(Path(spec.origin or "").is_relative_to(place) for place in installed)


def write_templates(
    source: str, places: dict[str, str], folder: Path, others: dict[str, str] | None = None, **variables: str
) -> None:
    """Fill the templates of a folder and write all of them, or none.

    Parameters
    ----------
    source
        Name of the folder among the templates.
    places
        By name of a template, without ``.jinja``: where its text goes in `folder`.
    others
        Further files as they are, by place.
    variables
        What the templates may use.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(templates_dir() / source),
        undefined=jinja2.StrictUndefined,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701 -- the templates make Python, TOML and Markdown, not HTML
    )
    filled = {place: environment.get_template(f"{name}.jinja").render(variables) for name, place in places.items()}
    texts = filled | (others or {})
    replace_files(folder, {place: text.encode() for place, text in texts.items()})
