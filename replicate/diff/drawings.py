"""All pictures of the figures that changed, as elements of the page; drawn in parallel if there are many."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from replicate.diff.accepted import FigureState
from replicate.diff.comparison import ExhibitDiff
from replicate.diff.redraw import MOST_CURVES, differences, overlay, picture
from replicate.display.inline_svg import description, inline_svg
from replicate.figures.pair import Pair

# Starting processes takes as long as drawing a few figures.
_FEW = 4


@dataclass(frozen=True)
class Drawings:
    """The pictures of one figure; `overlay` and `differences` are empty if no curve changed.

    Attributes
    ----------
    accepted, new
        The figure in each state, empty in one that does not exist.
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
    """Draw one figure in the states that there are."""
    try:
        return _draw(diff, name)
    except Exception as error:  # noqa: BLE001  -- the words are there, whatever the pictures do
        return Drawings(error=" ".join(f"{type(error).__name__}: {error}".split()))


def _draw(diff: ExhibitDiff, name: str) -> Drawings:
    before, after = (state if isinstance(state, FigureState) else None for state in (diff.before, diff.after))
    order = list(dict.fromkeys(curve for state in (before, after) if state for curve in state.curves))
    accepted, new = (
        _alone(state, f"{diff.name.replace('/', '-')}-{when}", f"{name}, {when}", order) if state else ""
        for when, state in (("accepted", before), ("new", after))
    )
    both = _together(diff, before, after, len(order), name) if before and after else Drawings()
    return replace(both, accepted=accepted, new=new)


def _alone(state: FigureState, id: str, name: str, order: Sequence[tuple[str, str]]) -> str:
    return inline_svg(picture(state, id, order), id, name, description("", state.axes))


def _together(diff: ExhibitDiff, before: FigureState, after: FigureState, count: int, name: str) -> Drawings:
    """Return the pictures that hold both states, which have so many different curves."""
    id = diff.name.replace("/", "-")
    same = {(str(pair.axes["panel"]), pair.name) for pair in diff.pairs if not pair.moved}
    moved = sorted((pair for pair in diff.pairs if pair.moved), key=lambda pair: -_size(pair))
    drawn = [pair for pair in moved if pair.values is not None or len(pair.distance[0].points)][:MOST_CURVES]
    both = curves = ""
    words = " ".join(f"{change.text}." for change in diff.changes)
    if len(same) < count:
        svg = overlay(before, after, same, f"{id}-overlay")
        both = inline_svg(svg, f"{id}-overlay", f"{name}: accepted and new curves in one picture", words)
    if drawn:
        svg = differences(drawn, f"{id}-differences")
        curves = inline_svg(svg, f"{id}-differences", f"{name}: how far the curves moved", words)
    return Drawings(overlay=both, differences=curves, not_drawn=len(moved) - len(drawn) if drawn else 0)


def _size(pair: Pair) -> float:
    apart = [part.largest for part in pair.distance]
    return max(apart, default=pair.values.largest if pair.values else 0.0)
