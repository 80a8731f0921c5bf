"""Printed rows of tuning parameters, as loops in text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

from replicate.display.addresses import trial_label, trial_table
from replicate.exhibits import Paper
from replicate.exhibits.results import Results, TableResult
from replicate.exhibits.trials import TableTrials
from replicate.loops import PID, Plant
from replicate.loops.errors import LoopError
from replicate.loops.notation import parse_controller, parse_plant


@dataclass(frozen=True)
class Row:
    """A loop to begin with.

    Attributes
    ----------
    label
        What it is called, beginning with the name of its table if it has one.
    plant, controller
        In the notation of `replicate.loops`.
    table
        What its table is called.
    """

    label: str
    plant: str
    controller: str
    table: str = ""

    @property
    def name(self) -> str:
        """What it is called inside its table."""
        return self.label.removeprefix(f"{self.table}: ")


MOST_POLES = 15
MOST_GAIN = 1e9  # the largest number of a controller
FAR_APART = 1e12  # the fastest over the slowest of a loop


def why_not_drawn(row: Row) -> str:
    """Return why the page cannot draw a loop, which `replicate.loops` may well be able to compute; empty if it can.

    Raises
    ------
    LoopError
        If plant or controller is not understood.
    """
    plant, controller = _parsed(row.plant, row.controller)
    if not plant.is_rational or plant.den.size > MOST_POLES + 1:
        return f"the page draws rational plants with one dead time, of order {MOST_POLES} at most, not {row.plant}"
    gains = (controller.k, controller.ki, controller.kd, controller.b, controller.c, controller.derivative_filter)
    prefilter = controller.setpoint_filter
    refused = [
        (
            plant.num.size == plant.den.size and not plant.dead_time,
            f"the page does not draw a plant that answers at once, as {row.plant} does",
        ),
        (
            controller.ki and not plant.num[-1],
            f"the page does not draw integral action on a plant that lets nothing through at rest, as {row.plant}",
        ),
        (
            controller.measurement_filter or not isinstance(prefilter, (int, float)),
            f"the page draws no measurement filter, and a number as setpoint_filter, not {row.controller}",
        ),
        (
            max(abs(number) for number in (*gains, prefilter) if isinstance(number, (int, float))) > MOST_GAIN,
            f"the page draws no controller with a number beyond {MOST_GAIN:g}, not {row.controller}",
        ),
        (
            not _spread(plant, controller.k) < FAR_APART,
            f"the page draws no loop whose numbers lie so far apart as those of {row.plant} with {row.controller}",
        ),
    ]
    return next((reason for wrong, reason in refused if wrong), "")


@cache
def _parsed(plant: str, controller: str) -> tuple[Plant, PID]:
    """Return a loop; papers have the same ones in many tables."""
    return parse_plant(plant), parse_controller(controller)


def _spread(plant: Plant, gain: float) -> float:
    """Return the fastest over the slowest in a loop: poles, zeros, dead time, and where the gain falls below one."""
    with np.errstate(all="ignore"):
        high = np.abs(gain * plant.num[0] / plant.den[0])
        crossover = high ** (1.0 / (plant.den.size - plant.num.size)) if plant.den.size > plant.num.size else 0.0
        roots = [root for p in (plant.num, plant.den) for root in np.roots(p / p[0])]
        sizes = np.array([*np.abs(roots), crossover, 1.0 / plant.dead_time if plant.dead_time else 0.0])
        sizes = sizes[sizes > 0.0]
        return float(np.max(sizes) / np.min(sizes)) if sizes.size else 1.0


def rows_of(papers: Iterable[Paper], results: Results) -> list[Row]:
    """Return the rows of tuning parameters that papers declare, in their order, each loop once."""
    found: dict[tuple[str, str], Row] = {}
    for paper in papers:
        for exhibit, trials in _trials(paper, results):
            table = trial_table(paper, exhibit)
            for row, case, plant, controller in trials.declared:
                label = trial_label(paper, exhibit, row, case)
                found.setdefault((plant, controller), Row(label, plant, controller, table))
    return list(found.values())


def unreadable_loops(papers: Iterable[Paper], results: Results) -> dict[str, str]:
    """Return by id the first loop of a paper that is not understood, and why; nothing where all are."""
    found: dict[str, str] = {}
    for paper in papers:
        for exhibit, trials in _trials(paper, results):
            for row, case, plant, controller in trials.all:
                try:
                    _parsed(plant, controller)
                except LoopError as error:
                    found.setdefault(paper.id, f"{paper.id}/{exhibit}: {', '.join(filter(None, (row, case)))}: {error}")
    return found


def _trials(paper: Paper, results: Results) -> Iterator[tuple[str, TableTrials]]:
    for id in paper.exhibits:
        result = results.get((paper.id, id))
        if isinstance(result, TableResult):
            yield id, result.trials
