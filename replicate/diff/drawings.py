"""All pictures of the figures that changed, as elements of the page; drawn in parallel if there are many."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from replicate.diff.accepted import FigureState
from replicate.diff.comparison import ExhibitDiff
from replicate.diff.redraw import MOST_CURVES, differences, overlay, picture
from replicate.display.inline_svg import description, inline_svg
from replicate.figures.pair import Pair

#: Pictures of more figures than this would make the page too heavy; it says how to see the others.
MOST_FIGURES = 24

# Starting processes takes as long as drawing a few figures.
_FEW = 4


@dataclass(frozen=True)
class Drawings:
    """The pictures of one figure; `overlay` and `differences` are empty if no curve changed.

    Attributes
    ----------
    not_drawn
        Number of curves that moved, but less than those in `differences`.
    error
        Why there are no pictures: what was stored cannot be drawn by this matplotlib.
    """

    accepted: str = ""
    new: str = ""
    overlay: str = ""
    differences: str = ""
    not_drawn: int = 0
    error: str = ""


def draw_all(figures: Sequence[tuple[ExhibitDiff, str]], jobs: int | None = None) -> list[Drawings]:
    """Draw figures.

    Parameters
    ----------
    figures
        What changed, and what to call the figure in alternative texts.
    jobs
        Number of processes; that of the processor's cores if not given.
    """
    if jobs == 1 or len(figures) <= _FEW:
        return [draw(diff, name) for diff, name in figures]
    from joblib import Parallel, delayed

    drawn: list[Drawings] = Parallel(n_jobs=jobs or -1)(delayed(draw)(diff, name) for diff, name in figures)
    return drawn


def draw(diff: ExhibitDiff, name: str) -> Drawings:
    """Draw one figure in both states."""
    if not isinstance(diff.before, FigureState) or not isinstance(diff.after, FigureState):
        return Drawings()
    try:
        return _draw(diff, diff.before, diff.after, name)
    except Exception as error:  # noqa: BLE001  -- the words are there, whatever the pictures do
        return Drawings(error=" ".join(f"{type(error).__name__}: {error}".split()))


def _draw(diff: ExhibitDiff, before: FigureState, after: FigureState, name: str) -> Drawings:
    id = diff.name.replace("/", "-")
    same = {(str(pair.axes["panel"]), pair.name) for pair in diff.pairs if not pair.moved}
    moved = sorted((pair for pair in diff.pairs if pair.moved), key=lambda pair: -_size(pair))
    order = list(dict.fromkeys((*before.curves, *after.curves)))
    one, other = (
        inline_svg(
            picture(state, f"{id}-{when}", order), f"{id}-{when}", f"{name}, {when}", description("", state.axes)
        )
        for when, state in (("accepted", before), ("new", after))
    )
    drawn = [pair for pair in moved if pair.values is not None or len(pair.distance[0].points)][:MOST_CURVES]
    both = curves = ""
    words = " ".join(f"{change.text}." for change in diff.changes)
    if len(same) < len(order):
        svg = overlay(before, after, same, f"{id}-overlay")
        both = inline_svg(svg, f"{id}-overlay", f"{name}: accepted and new curves in one picture", words)
    if drawn:
        svg = differences(drawn, f"{id}-differences")
        curves = inline_svg(svg, f"{id}-differences", f"{name}: how far the curves moved", words)
    return Drawings(one, other, both, curves, len(moved) - len(drawn) if drawn else 0)


def _size(pair: Pair) -> float:
    apart = [part.largest for part in pair.distance]
    return max(apart, default=pair.values.largest if pair.values else 0.0)
