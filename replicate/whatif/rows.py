"""Printed rows of tuning parameters, as loops in text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from replicate.display.addresses import trial_label
from replicate.exhibits import Paper, Table


@dataclass(frozen=True)
class Row:
    """A loop to begin with: what it is called, and plant and controller in the notation of `replicate.loops`."""

    label: str
    plant: str
    controller: str


def rows_of(papers: Iterable[Paper]) -> list[Row]:
    """Return the rows of tuning parameters that papers declare, in their order, each loop once."""
    found: dict[tuple[str, str], Row] = {}
    for paper in papers:
        for exhibit in paper.exhibits.values():
            if isinstance(exhibit, Table) and exhibit.trials is not None:
                for row, (plant, controller) in exhibit.trials().items():
                    label = f"{paper.id} {trial_label(exhibit.id, row)}"
                    found.setdefault((plant, controller), Row(label, plant, controller))
    return list(found.values())
