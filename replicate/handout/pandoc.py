"""Calls of pandoc on its own tree: many pieces in one call, since each call costs a tenth of a second."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cache

from replicate.display.pandoc import convert
from replicate.handout.tree import Blocks, raw_block

_MARK = "\ue004"  # between two pieces
_OPTIONS = ("--wrap=none", "--fail-if-warnings")


def written(pieces: Sequence[Blocks], target: str, *options: str, raw: str = "") -> list[str]:
    """Write pieces of a tree, each as if it were alone; equal ones are written once.

    Parameters
    ----------
    target
        A format of pandoc in which raw text stays what it is, as html and typst.
    options
        Of pandoc, besides those that all calls have.
    raw
        What the format calls raw text that it leaves as it is; its own name if empty.
    """
    if not pieces:
        return []
    keys = [json.dumps(piece) for piece in pieces]
    different = dict(zip(keys, pieces, strict=True))
    blocks = [block for piece in different.values() for block in (raw_block(raw or target, _MARK), *piece)]
    text = convert(json.dumps(document(blocks)), target, "json", *_OPTIONS, *options)
    made = {key: piece.strip("\n") + "\n" for key, piece in zip(different, text.split(_MARK)[1:], strict=True)}
    return [made[key] for key in keys]


def document(blocks: Blocks) -> dict[str, object]:
    """Return a document of pandoc's JSON format."""
    return {"pandoc-api-version": _api_version(), "meta": {}, "blocks": blocks}


@cache
def _api_version() -> tuple[int, ...]:
    """Return the version of the tree's format that this pandoc reads and writes."""
    empty = json.loads(convert("", "json", "markdown"))
    return tuple(empty["pandoc-api-version"])
