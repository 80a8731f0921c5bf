"""Of which artists something can be seen: a line without colour, width or dashes is no curve of the figure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from replicate.figures.recorder import Array, Drawn
from replicate.figures.stacking import extent

if TYPE_CHECKING:
    from matplotlib.artist import Artist

#: Opacities up to this, of 1, cannot be seen.
_LEAST = 1.5 / 255.0


@dataclass(frozen=True)
class Ink:
    """What the artists of a figure have left on it.

    Attributes
    ----------
    seen
        The identities of the artists of which something can be seen, or that consist of such.
    """

    seen: frozenset[int] = frozenset()

    @classmethod
    def of(cls, calls: Sequence[Drawn]) -> Ink:
        """Return what calls of the renderer leave.

        Examples
        --------
        >>> from matplotlib.figure import Figure
        >>> from replicate.figures.drawing import recorded
        >>> figure = Figure()
        >>> lines = [figure.subplots().plot([0, 1], alpha=alpha)[0] for alpha in (0.0, 0.5)]
        >>> with recorded(figure) as drawn:
        ...     [Ink.of(drawn).shows(line) for line in lines]
        [False, True]
        """
        seen = [artist for call in calls if _leaves_ink(call) for artist in call.artists]
        return cls(frozenset(map(id, seen)))

    def shows(self, artist: Artist) -> bool:
        """Whether something can be seen of an artist."""
        return id(artist) in self.seen


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
