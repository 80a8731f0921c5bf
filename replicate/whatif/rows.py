"""Printed rows of tuning parameters, as loops in text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from replicate.display.addresses import trial_label
from replicate.exhibits import Paper, Table
from replicate.exhibits.trials import listed
from replicate.loops.notation import parse_controller, parse_plant


@dataclass(frozen=True)
class Row:
    """A loop to begin with: what it is called, and plant and controller in the notation of `replicate.loops`."""

    label: str
    plant: str
    controller: str


MOST_POLES = 15


def why_not_drawn(row: Row) -> str:
    """Return why the page cannot draw a loop, which `replicate.loops` may well be able to compute; empty if it can.

    Raises
    ------
    LoopError
        If plant or controller is not understood.
    """
    plant, controller = parse_plant(row.plant), parse_controller(row.controller)
    if not plant.is_rational or plant.den.size > MOST_POLES + 1:
        return f"the page draws rational plants with one dead time, of order {MOST_POLES} at most, not {row.plant}"
    if plant.num.size == plant.den.size and not plant.dead_time:
        return f"the page does not draw a plant that answers at once, as {row.plant} does"
    if controller.measurement_filter or not isinstance(controller.setpoint_filter, (int, float)):
        return f"the page draws no measurement filter, and a number as setpoint_filter, not {row.controller}"
    return ""


def rows_of(papers: Iterable[Paper]) -> list[Row]:
    """Return the rows of tuning parameters that papers declare, in their order, each loop once."""
    found: dict[tuple[str, str], Row] = {}
    for paper in papers:
        for exhibit in paper.exhibits.values():
            for row, case, plant, controller in listed(exhibit.trials) if isinstance(exhibit, Table) else ():
                label = f"{paper.id} {trial_label(exhibit.id, row, case)}"
                found.setdefault((plant, controller), Row(label, plant, controller))
    return list(found.values())
