"""The starting point of a project: a folder that holds papers, their accepted state and what CI needs."""

from __future__ import annotations

import json
import os
from pathlib import Path

from replicate import resources
from replicate.errors import OutputError
from replicate.new_paper import write_templates

_PLACES = {
    "replicate.toml": "replicate.toml",
    "README.md": "README.md",
    "Makefile": "Makefile",
    "gitignore": ".gitignore",
    "workflow.yml": ".github/workflows/replicate.yml",
    "papers.md": "papers/README.md",
}

#: Folder of a project with the JSON Schemas that its files name, so that editors complete and check them offline.
SCHEMAS = ".schemas"
_WRITTEN = ("ledger", "project")


def new_project(folder: Path, title: str = "") -> None:
    """Write a project into a folder.

    Parameters
    ----------
    folder
        Created if it does not exist; files of other names in it stay as they are.
    title
        Of the report; default: made of the folder's name.

    Raises
    ------
    OutputError
        If one of the files exists already, or the folder cannot be written.
    """
    for place in dict.fromkeys([*(Path(place).parts[0] for place in _PLACES.values()), SCHEMAS]):
        if (folder / place).exists():
            msg = f"{folder / place}: exists already; nothing was written"
            raise OutputError(msg)
    words = Path(os.path.realpath(folder)).name.replace("-", " ").replace("_", " ")
    schemas = {f"{SCHEMAS}/{name}.schema.json": text for name, text in resources.schemas().items() if name in _WRITTEN}
    name = title or words[:1].upper() + words[1:]
    variables = {
        "title": name,
        "quoted": json.dumps(name, ensure_ascii=False),
        "schema": f"{SCHEMAS}/project.schema.json",
    }
    write_templates("new_project", _PLACES, folder, schemas, **variables)
