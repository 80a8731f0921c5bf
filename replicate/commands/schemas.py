"""The JSON Schemas of the files that people write."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from replicate.errors import ReplicateError
from replicate.terminal.streams import echo


def schema(
    name: Annotated[str | None, typer.Argument(metavar="NAME", help="Default: list the schemas.")] = None,
) -> None:
    """Print the JSON Schema of a file format, for editors and checkers."""
    from replicate.resources import schemas

    found = schemas()
    if name is None:
        for id, text in found.items():
            echo(f"{id:14} {json.loads(text)['title']}")
        return
    if name not in found:
        msg = f"there is no schema '{name}'; known: {', '.join(found)}"
        raise ReplicateError(msg)
    echo(found[name].rstrip("\n"))
