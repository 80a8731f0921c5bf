"""Keep every page light enough for a phone: what is heaviest on it gives way, and says so.

A paper may print thousands of numbers, or draw as many points. A page that would be too heavy is made again with its
heaviest exhibits a step lighter, until it is within the limits or nothing can give way any more. What is wrong stays.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from markupsafe import Markup

from replicate.display.tables import TableView
from replicate.report.views import ExhibitView, FigureView

MOST_BYTES = 2_000_000
MOST_ELEMENTS = 25_000

_EXHIBIT = re.compile(r'<section class="exhibit[^"]*" id="([^"]*)"')
_MOST_ROUNDS = 8
_GAIN = 0.7  # what a step takes off an exhibit, at a guess; the page is weighed again
_ALIKE = 0.3  # an exhibit much lighter than the heaviest waits until the page has been weighed again
_MOST_CELLS = 1500  # of a table whose rows are left out
_FEWEST_ROWS = 10  # of a table that is left out in halves


@dataclass(frozen=True)
class Weight:
    """How heavy HTML is."""

    size: int  # bytes
    elements: int

    @classmethod
    def of(cls, text: str) -> Weight:
        """Weigh a text.

        Examples
        --------
        >>> Weight.of("<p>é <b>x</b></p>")
        Weight(size=18, elements=2)
        """
        return cls(len(text.encode()), text.count("<") - text.count("</"))

    @property
    def share(self) -> float:
        """How much of what a page may weigh this is."""
        return max(self.size / MOST_BYTES, self.elements / MOST_ELEMENTS)


def within_limits(views: Sequence[ExhibitView], page: Callable[[Sequence[ExhibitView]], str]) -> str:
    """Return a page that is light enough, as far as that can be.

    Parameters
    ----------
    views
        The exhibits of the page.
    page
        Makes the page with its exhibits.
    """
    text = page(views)
    for _ in range(_MOST_ROUNDS):
        too_much = Weight.of(text).share - 1.0
        if too_much <= 0.0:
            break
        lighter = _lighter(views, _weights(text), too_much)
        if lighter == views:
            break
        views = lighter
        text = page(views)
    return text


def _weights(page: str) -> dict[str, Weight]:
    """Return the weights of the exhibits of a page."""
    starts = [*_EXHIBIT.finditer(page)]
    ends = [*(match.start() for match in starts[1:]), len(page)]
    return {match[1]: Weight.of(page[match.start() : end]) for match, end in zip(starts, ends, strict=True)}


def _lighter(views: Sequence[ExhibitView], weights: Mapping[str, Weight], too_much: float) -> list[ExhibitView]:
    """Return the exhibits, as many of the heaviest a step lighter as may be enough."""
    steps = {view.id: step for view in views if view.id in weights and (step := _step(view)) is not None}
    heaviest = max((weights[id].share for id in steps), default=0.0)
    found = {view.id: view for view in views}
    for id in sorted(steps, key=lambda id: weights[id].share, reverse=True):
        if too_much <= 0.0 or weights[id].share < _ALIKE * heaviest:
            break
        found[id] = steps[id]
        too_much -= _GAIN * weights[id].share
    return [found[view.id] for view in views]


def _step(view: ExhibitView) -> ExhibitView | None:
    """Return an exhibit one step lighter; ``None`` if it is as light as it gets."""
    if view.table is not None:
        table = _lighter_table(view.table)
        return None if table is None else replace(view, table=table)
    if view.figure is not None:
        figure = _lighter_figure(view.figure)
        return None if figure is None else replace(view, figure=figure)
    return None


def _lighter_table(table: TableView) -> TableView | None:
    """Return a table without the cards of cells that hold; then without rows that hold, and with fewer of all."""
    if table.every_card and table.verdicts:
        return replace(table, every_card=False)
    room = max(1, _MOST_CELLS // max(1, len(table.columns) * len(table.readings)))
    if table.left_out:
        room = max(_FEWEST_ROWS, len(table.rows) // 2)
    if len(table.rows) <= room:
        return None
    kept = set(sorted((row for row, _ in table.rows), key=lambda row: row not in table.differing)[:room])
    rows = [entry for entry in table.rows if entry[0] in kept]
    return replace(table, rows=rows, left_out=table.left_out + len(table.rows) - len(rows))


def _lighter_figure(figure: FigureView) -> FigureView | None:
    """Return a figure whose drawing is the lightest of its files, and not in the page."""
    if not figure.svg:
        return None
    return replace(figure, svg=Markup(""), beside=figure.lightest)
