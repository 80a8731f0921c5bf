"""The results that are kept between runs."""

from __future__ import annotations

from typing import Annotated

import typer

from replicate.commands.options import Out, library, output_folder
from replicate.terminal.streams import echo


def cache(
    clear: Annotated[bool, typer.Option("--clear", help="Remove them all.")] = False,
    out: Out = None,
) -> None:
    """Show how much the kept results take, or remove them."""
    from replicate.run.cache import Cache, stored
    from replicate.run.kept_texts import FOLDER
    from replicate.run.limits import MOST_KEPT

    folder = output_folder(library(), out) / "cache"
    entries = Cache(folder).clear() if clear else list(stored(folder))
    texts = sum(entry.path.parent == folder / FOLDER for entry in entries)
    size = sum(entry.size for entry in entries) / 2**20
    held = f"{len(entries) - texts} results, {texts} texts, {size:.1f} MB"
    echo(f"removed: {held}, from {folder}" if clear else f"{folder}: {held} of at most {MOST_KEPT / 2**20:g} MB")
