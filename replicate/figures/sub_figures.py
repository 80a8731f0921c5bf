"""Sub-figures by their place: row by row from the top left, whatever order matplotlib makes and draws them in."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from replicate.figures.recorder import Drawn


def names_of_sub_figures(figure: Any) -> dict[int, str]:
    """Return what the backgrounds and titles of all sub-figures are called, by the artist's identity.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> figure = Figure()
    >>> left, right = figure.subfigures(1, 2)
    >>> title = right.suptitle("loads")
    >>> names_of_sub_figures(figure)[id(title)]
    'title of sub-figure 2'
    """
    found = {}
    for number, sub in _walk(figure, ""):
        found[id(sub.patch)] = f"background of sub-figure {number}"
        title = getattr(sub, "_suptitle", None)
        if title is not None:
            found[id(title)] = f"title of sub-figure {number}"
    return found


def in_order_of_place(figure: Any, drawn: Sequence[Drawn]) -> list[Drawn]:
    """Return what was drawn with the sub-figures one after the other; all else stays where it was."""
    ranks = {id(sub): rank for rank, (_, sub) in enumerate(_walk(figure, ""))}
    if not ranks:
        return list(drawn)
    owners = [
        max((ranks[id(artist)] for artist in call.artists if id(artist) in ranks), default=None) for call in drawn
    ]
    inside = sorted((i for i, owner in enumerate(owners) if owner is not None), key=lambda i: owners[i] or 0)
    following = iter(inside)
    return [call if owner is None else drawn[next(following)] for call, owner in zip(drawn, owners, strict=True)]


def _walk(figure: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    placed = sorted(getattr(figure, "subfigs", ()), key=lambda sub: (-round(sub.bbox.y1), round(sub.bbox.x0)))
    for count, sub in enumerate(placed, start=1):
        number = f"{prefix}{count}"
        yield number, sub
        yield from _walk(sub, f"{number}.")
