"""Which definitions and which versions of the rules the tables use: what was tried, and how many cells it meets."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache
from typing import TYPE_CHECKING

from replicate.exhibits.matching import meets
from replicate.loops import PI, Loop, Signal
from replicate.loops.tune import classical_rules
from replicate.papers.khan import paper
from replicate.papers.khan.processes import LOAD_AT, RESTORED, case_gains, gains, plant
from replicate.papers.khan.sweep import stability_limit
from replicate.papers.khan.tables import QUANTITIES, RULES_1, RULES_2

if TYPE_CHECKING:
    import pandas as pd

NEAR = 0.005  # half a per cent: the printed times carry errors of that size
DEAD_TIMES = {"10": 10.0, "1": 1.0, "0.1": 0.1}  # by the label of ph; p = 1 throughout

definitions = paper.table(
    "definitions",
    "Definitions and rule versions tried on Tables I and II",
    printed=False,
    caption="How many printed cells agree to the last digit, and how many within 0.5 %, under each definition of "
    "$t_s$ and $t_d$ (all rules, (7a) restored; the two swapped cells of Table I count as printed), and under each "
    "version of a rule (all four quantities). The definition used here is the first of each kind. A rule that gives no "
    "stable loop reproduces no cell.",
    labels={"equal": "to the last digit", "close": "within 0.5 %", "of": "of"},
)

Measure = Callable[[Loop, float], float]  # of a loop with its dead time
Cell = tuple[str, float, str]  # rule, dead time, printed text


def _last_exit(y: Signal, width: float) -> float:
    return y.settling_time(width / (abs(y.final) or 1.0))


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
    "ts: first entry into 2 %": lambda c, _: c.step().first_reach(0.98),
    "ts: 2 %, counted from the end of the dead time": lambda c, h: _last_exit(c.step(), 0.02) - h,
}
LOAD: dict[str, Measure] = {
    "td: band 0.02, load before the dead time, late": lambda c, _: _last_exit(c.load_step(), 0.02),
    "td: the same, load at t = 100, 25, 5": _at_finite_time,
    "td: load after the dead time": lambda c, h: _last_exit(c.load_step(), 0.02) - h,
    "td: 2 % of the load response's peak": _relative_to_peak,
    "td: band 0.01": lambda c, _: _last_exit(c.load_step(), 0.01),
    "td: band 0.05": lambda c, _: _last_exit(c.load_step(), 0.05),
}

Version = Callable[[float], tuple[float, float]]  # (K_P, K_I) for p = 1 and a dead time


def _classical(id: str, variant: str = "printed") -> Version:
    def evaluate(h: float) -> tuple[float, float]:
        ultimate = stability_limit(h) / h  # of proportional control, with the period of its oscillation
        period = 2.0 * math.pi / math.sqrt(ultimate**2 - 1.0)
        found = classical_rules(variant)[id].evaluate(K=1.0, tau=1.0, L=h, Ku=ultimate, Tu=period)
        return float(found.kp), float(found.ki)

    return evaluate


def _paper(rule: str, variant: str) -> Version:
    return lambda h: gains(rule, 1.0, h, variant)


def _two_digits(h: float) -> tuple[float, float]:
    kp, ki = (float(f"{gain:.2g}") for gain in gains("CC", 1.0, h))
    return kp, ki


VERSIONS: dict[str, dict[str, Version]] = {
    "Proposed": {
        "(7): (7a) restored, (7b) printed": _paper("Proposed", RESTORED),
        "(7): (7a) as printed": _paper("Proposed", "printed"),
        "(7): (7a) restored, (7b) unrounded": lambda h: gains("Proposed", 1.0, h, RESTORED if h < 0.2 else "unrounded"),
    },
    "ZN": {
        "ZN: reaction curve, Ti = 3h": _classical("ziegler-nichols"),
        "ZN: reaction curve, Ti = h/0.3": _classical("ziegler-nichols", "original"),
        "ZN: ultimate gain": _classical("ziegler-nichols", "ultimate-gain"),
    },
    "ISE": {
        "ISE: Appendix": _paper("ISE", "printed"),
        "ISE: Appendix, case II throughout": lambda h: case_gains("ISE-II", 1.0, h),
        "ISE: Zhuang and Atherton": _classical("ise-setpoint"),
    },
    "CC": {
        "CC: original fractions": _classical("cohen-coon"),
        "CC: decimals 3.33, 0.33, 2.2": _classical("cohen-coon", "decimals-033"),
        "CC: decimals 3.33, 0.31, 2.22": _classical("cohen-coon", "decimals-031"),
        "CC: Åström and Hägglund": _classical("cohen-coon", "astrom-hagglund"),
        "CC: original fractions, gains to two digits": _two_digits,
    },
}


@cache
def _printed(quantity: str) -> tuple[Cell, ...]:
    first, second = paper.printed_cells("table-1"), paper.printed_cells("table-2")
    cells = [(rule, 10.0, first[rule, quantity]) for rule in RULES_1]
    cells += [(r, h, second[r, f"ph{key}_{quantity}"]) for r in RULES_2 for key, h in DEAD_TIMES.items() if h < 10.0]
    return tuple(cells)


def _count(pairs: list[tuple[str, float]]) -> dict[str, int]:
    return {
        "equal": sum(meets(text, value) for text, value in pairs),
        "close": sum(meets(text, value) or abs(value - float(text)) <= NEAR * float(text) for text, value in pairs),
        "of": len(pairs),
    }


@definitions.reading("as-written", "Number of cells met")
def count() -> pd.DataFrame:
    """Count the cells that each definition and each version of a rule meets."""
    rows = {}
    loops = {(rule, h): Loop(plant(1.0, h), PI(*gains(rule, 1.0, h, RESTORED))) for rule, h, _ in _printed("ts")}
    for kind, measures in (("ts", SETTLING), ("td", LOAD)):
        for name, measure in measures.items():
            rows[name] = _count([(text, measure(loops[rule, h], h)) for rule, h, text in _printed(kind)])
    for rule, versions in VERSIONS.items():
        for name, version in versions.items():
            rows[name] = _count(_version_cells(rule, version))
    return definitions.frame(rows)


def _version_cells(rule: str, version: Version) -> list[tuple[str, float]]:
    """Return printed text and computed value of every cell of one rule."""
    computed = {h: specifications_of(version(h), h) for row, h, _ in _printed("ts") if row == rule}
    return [
        (text, computed[h][quantity]) for quantity in QUANTITIES for row, h, text in _printed(quantity) if row == rule
    ]


def specifications_of(pair: tuple[float, float], h: float) -> Mapping[str, float]:
    """Return the four quantities of the tables; infinite where the loop is not stable or has no integral action."""
    if pair[1] <= 0.0 or not (closed := Loop(plant(1.0, h), PI(*pair))).is_stable():
        return dict.fromkeys(QUANTITIES, math.inf)
    y = closed.step()
    values = (
        100.0 * y.overshoot(),
        y.settling_time(0.02),
        closed.load_step().settling_time(0.02),
        float(closed.sensitivity_peak()),
    )
    return dict(zip(QUANTITIES, values, strict=True))
