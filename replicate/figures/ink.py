"""Whether anything can be seen of what an artist draws: a line without colour or width is no curve of the figure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from replicate.figures.recorder import Array, Drawn
from replicate.figures.stacking import extent

#: Opacities up to this, of 1, cannot be seen.
_LEAST = 1.5 / 255.0


def unseen(drawn: Sequence[Drawn]) -> set[int]:
    """Return the identities of the artists that draw, but nothing that could be seen.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from replicate.figures.drawing import recorded
    >>> figure = Figure()
    >>> one, other = (figure.subplots().plot([0, 1], alpha=alpha)[0] for alpha in (0.0, 0.5))
    >>> with recorded(figure) as drawn:
    ...     [id(line) in unseen(drawn) for line in (one, other)]
    [True, False]
    """
    seen: dict[int, bool] = {}
    for call in drawn:
        artist = id(call.artists[-1])
        seen[artist] = seen.get(artist, False) or _leaves_ink(call)
    return {artist for artist, visible in seen.items() if not visible}


def _leaves_ink(call: Drawn) -> bool:
    if call.kind == "image":
        return bool((call.extra["image"][..., 3] > 255.0 * _LEAST).any())
    if call.kind == "text":
        return _opaque(call.edges) and not _is_clipped_away(call)
    return bool(call.hatch) or _opaque(call.faces) or (_opaque(call.edges) and any(call.widths))


def _is_clipped_away(call: Drawn) -> bool:
    box, clip = extent(call), call.clip_box
    if box is None or clip is None:
        return False
    return any(box[side] > clip[side + 2] or box[side + 2] < clip[side] for side in (0, 1))


def _opaque(colours: Array) -> bool:
    return bool(len(colours)) and bool(np.max(colours[:, 3]) > _LEAST)
