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
    from replicate.run.limits import MOST_KEPT

    folder = output_folder(library(), out) / "cache"
    if clear:
        count, size = Cache(folder).clear()
        echo(f"removed: {count} results, {size / 2**20:.1f} MB, from {folder}")
        return
    entries = list(stored(folder))
    size = sum(entry.size for entry in entries)
    echo(f"{folder}: {len(entries)} results, {size / 2**20:.1f} MB of at most {MOST_KEPT / 2**20:g} MB")
