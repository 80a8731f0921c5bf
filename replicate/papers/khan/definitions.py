"""Which definitions the tables use: every alternative that was tried, and how many printed cells it meets."""

from __future__ import annotations

from collections.abc import Callable

import pandas as pd

from replicate.loops import PI, Loop, Signal
from replicate.papers.khan import paper
from replicate.papers.khan.processes import RESTORED, gains, plant
from replicate.papers.khan.tables import LOAD_AT, RULES_1, RULES_2
from replicate.papers.khan.transcription import printed_cells

NEAR = 0.005  # a cell is met if it agrees within half a per cent: the printed times carry errors of that size

definitions = paper.table(
    "definitions",
    "Settling-time definitions tried on Tables I and II",
    printed=False,
    caption="Number of printed cells that agree within 0.5 % under each definition, rules as restored. The definitions "
    "of the tables are those of the first row of each kind. The two swapped cells of Table I count as they stand.",
    labels={"cells": "cells met", "of": "of"},
)

# of a loop with its dead time
Measure = Callable[[Loop, float], float]


def _last_exit(y: Signal, width: float) -> float:
    return y.settling_time(width / (abs(y.final) or 1.0))


def _load(closed: Loop, width: float) -> float:
    return _last_exit(closed.load_step(), width)


def _relative_to_peak(closed: Loop, _: float) -> float:
    d = closed.load_step()
    return _last_exit(d, 0.02 * max(float(d.peak()), -float(d.trough())))


def _at_finite_time(closed: Loop, h: float) -> float:
    load_at = LOAD_AT[h]
    y = closed.respond(load=1.0, load_at=load_at, until=load_at + closed.horizon()).output
    return _last_exit(y, 0.02) - load_at


SETTLING: dict[str, Measure] = {
    "ts: last exit from 2 % of the set-point": lambda c, _: _last_exit(c.step(), 0.02),
    "ts: last exit from 1 %": lambda c, _: _last_exit(c.step(), 0.01),
    "ts: last exit from 5 %": lambda c, _: _last_exit(c.step(), 0.05),
    "ts: 2 %, counted from the end of the dead time": lambda c, h: _last_exit(c.step(), 0.02) - h,
}
LOAD: dict[str, Measure] = {
    "td: load before the dead time at finite t1, band 0.02": _at_finite_time,
    "td: the same, t1 infinite": lambda c, _: _load(c, 0.02),
    "td: load after the dead time": lambda c, h: _load(c, 0.02) - h,
    "td: 2 % of the load response's peak": _relative_to_peak,
    "td: band 0.01": lambda c, _: _load(c, 0.01),
    "td: band 0.05": lambda c, _: _load(c, 0.05),
}


@definitions.reading("as-written", "Number of cells met")
def count() -> pd.DataFrame:
    """Count the cells of t_s and t_d that each definition meets."""
    rows = {}
    for kind, measures in (("ts", SETTLING), ("td", LOAD)):
        cells = _cells(kind)
        for name, measure in measures.items():
            met = 0
            for rule, h, printed in cells:
                kp, ki = gains(rule, 1.0, h, RESTORED)
                value = measure(Loop(plant(1.0, h), PI(kp, ki)), h)
                met += abs(value - printed) <= NEAR * printed
            rows[name] = {"cells": met, "of": len(cells)}
    return pd.DataFrame.from_dict(rows, orient="index")


def _cells(kind: str) -> list[tuple[str, float, float]]:
    first = [(rule, 10.0, printed_cells("table-1")[rule, kind]) for rule in RULES_1]
    second = printed_cells("table-2")
    return first + [
        (rule, h, second[rule, f"ph{key}_{kind}"]) for rule in RULES_2 for key, h in (("1", 1.0), ("0.1", 0.1))
    ]
