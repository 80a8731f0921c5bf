"""Tables I and II: overshoot, settling times and sensitivity of the PI rules."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

from replicate.exhibits import Table, bound, rank
from replicate.loops import PI, Loop
from replicate.papers.khan import paper
from replicate.papers.khan.processes import (
    LOAD_AT,
    NAMES,
    RESTORED,
    UNROUNDED,
    gains,
    loop,
    plant,
    specifications,
    specifications_of_many,
)

if TYPE_CHECKING:
    import pandas as pd

QUANTITIES = ("Mp", "ts", "td", "Ms")
RULES_1 = ("Proposed", "Haalman", "Bryant", "ZN", "ISE")
RULES_2 = (*RULES_1, "CC", "ITAE")

Specifications = Callable[[str, float], tuple[float, float, float, float]]

table_1 = paper.table(
    "table-1",
    "Table I: overshoot, settling times and $M_s$ for $ph = 10$",
    rows=RULES_1,
    columns=QUANTITIES,
    caption="Process $e^{-hs}/(s+p)$ with $p = 1$, $h = 10$. $M_P$ in per cent of the set-point; $t_s$ and $t_d$ are "
    "the last times outside $\\pm 0.02$ after the unit set-point step and after a unit load step at the plant input, "
    "each counted from its own step.",
    shared_labels=NAMES,
    labels={"Mp": "$M_P$", "ts": "$t_s$", "td": "$t_d$", "Ms": "$M_s$"},
    units={"Mp": "%", "ts": "s", "td": "s"},
)
table_2 = paper.table(
    "table-2",
    "Table II: overshoot, settling times and $M_s$ for $ph = 1$ and $ph = 0.1$",
    rows=RULES_2,
    columns=tuple(f"ph{ph}_{quantity}" for ph in ("1", "0.1") for quantity in QUANTITIES),
    caption="As Table I, with $p = 1$ and $h = 1$ (left) and $h = 0.1$ (right).",
    shared_labels=NAMES,
    labels={
        f"ph{ph}_{key}": f"{text}, $ph = {ph}$"
        for ph in ("1", "0.1")
        for key, text in (("Mp", "$M_P$"), ("ts", "$t_s$"), ("td", "$t_d$"), ("Ms", "$M_s$"))
    },
    units={f"ph{ph}_{key}": unit for ph in ("1", "0.1") for key, unit in (("Mp", "%"), ("ts", "s"), ("td", "s"))},
)

# The paper compares the rules by these columns.
for _table in (table_1, table_2):
    for _column in _table.columns:
        _symbol = _table.labels[_column]
        rank(_table, _column, _table.rows, f"the ranking of the rules by {_symbol}")
        # and promises this of its own rule
        if _column.endswith("Ms"):
            bound(_table, _column, ("Proposed",), "the sensitivity of (7) is between 1.3 and 2", above=1.3, below=2.0)
        if _column.endswith("Mp"):
            _says = "the overshoot of (7) is below 1 %"
            bound(_table, _column, ("Proposed",), _says, below=1.0, consequence="comparison")


def as_written(rule: str, h: float) -> tuple[float, float, float, float]:
    """Rules as printed; the load enters long after the set-point response has settled."""
    return specifications(loop(rule, 1.0, h), None)


def restored(rule: str, h: float) -> tuple[float, float, float, float]:
    """Rule (7a) with its lost zeros; the load enters at the finite time of the simulation."""
    return specifications(loop(rule, 1.0, h, RESTORED), LOAD_AT[h])


def unrounded(rule: str, h: float) -> tuple[float, float, float, float]:
    """As `restored`, with the unrounded coefficients of (7b)."""
    return specifications(loop(rule, 1.0, h, RESTORED if h < 0.2 else UNROUNDED), LOAD_AT[h])


READINGS: dict[str, tuple[str, str, Specifications]] = {
    "as-written": (
        "as printed, load after settling",
        (
            "Rules (7a), (7b) and those of the literature as printed, dead time exact. $t_s$ is the last exit from "
            "$\\pm 2\\,\\%$ of the set-point. The load is a unit step at the plant input of Fig. 6, before the dead "
            "time; $t_d$ counts from that step, with the same absolute band, and the load enters “sufficiently” late. "
            "Ziegler–Nichols is the reaction-curve rule with $T_i = 3h$."
        ),
        as_written,
    ),
    "restored": (
        "lost zeros of (7a) restored, load at finite time",
        (
            "(7a) with three restored zeros. The load enters the running set-point response, of which slow loops still "
            "feel the rest: at $t = 100$ for $ph = 10$, as the text says for Fig. 8(a), and at 25 and 5 for $ph = 1$ "
            "and 0.1, where the text is silent and these are round times that give the two cells that depend on it. "
            "(Ziegler–Nichols at $ph = 10$ is far from settled at 100: its printed $t_d$ is that of a late load.)"
        ),
        restored,
    ),
    "unrounded": (
        "the same, (7b) unrounded",
        (
            "(7b) is half of $K_{Popt}$ and 0.85 of $K_{Iopt}$ of the Appendix, with rounded coefficients; here they "
            "are not rounded."
        ),
        unrounded,
    ),
}


def _table_1(compute: Specifications) -> pd.DataFrame:
    return table_1.frame({rule: compute(rule, 10.0) for rule in RULES_1})


def _table_2(compute: Specifications) -> pd.DataFrame:
    return table_2.frame({rule: (*compute(rule, 1.0), *compute(rule, 0.1)) for rule in RULES_2})


# What was tried: the definitions of the first reading, which the others share, are listed in a table of their own. (The
# zeros of (7a) were found from (7b), not from these tables.)
_CHOICES = {"zeros of (7a)": 2, "when the load enters": 2}
TRIED = {
    "as-written": {"definition of $t_s$": 5, "definition of $t_d$": 6},
    "restored": _CHOICES,
    "unrounded": _CHOICES | {"digits of (7b)": 2},
}


def _register(table: Table, build: Callable[[Specifications], pd.DataFrame]) -> None:
    for id, (title, note, compute) in READINGS.items():
        table.reading(id, title, note, tried=TRIED.get(id))(partial(build, compute))


_register(table_1, _table_1)
_register(table_2, _table_2)

# The rules whose coefficients the paper prints, by the cells that hold those for ph >= 0.2. (Those of (7a) are damaged,
# and the Haalman rule has a fraction.)
COEFFICIENTS: dict[str, tuple[str, ...]] = {
    "Proposed": tuple(f"rule-coefficients:7b_{gain}_{letter}:value" for gain in ("KP", "KI") for letter in "abc"),
    "ISE": tuple(f"appendix-coefficients:{gain}_II_{letter}:value" for gain in ("KP", "KI") for letter in "abc"),
    "Bryant": ("bryant:zeta1.0:Kh",),
}


def _gains(rule: str, h: float, given: Mapping[str, float]) -> tuple[float, float]:
    """Return (K_P, K_I) of a rule with other coefficients, for p = 1."""
    numbers = [given[place] for place in COEFFICIENTS[rule]]
    if rule == "Bryant":
        return numbers[0] / h, numbers[0] / h
    kp, ki = (a / h + b + c / h**0.5 for a, b, c in (numbers[:3], numbers[3:]))
    return kp, ki / h


Given = Mapping[str, float]


def _applying(dead_times: Mapping[str, float], rule: str) -> dict[str, float]:
    """Return the dead times for which the coefficients of a rule apply."""
    return {prefix: h for prefix, h in dead_times.items() if h >= 0.2 or rule == "Bryant"}


def _of_coefficients(dead_times: Mapping[str, float], rule: str, given: Given) -> dict[str, float]:
    """Return the row of a rule with other coefficients, where these apply."""
    found: dict[str, float] = {}
    for prefix, h in _applying(dead_times, rule).items():
        found |= _named(prefix, specifications(Loop(plant(1.0, h), PI(*_gains(rule, h, given))), LOAD_AT[h]))
    return found


def _of_many_coefficients(
    dead_times: Mapping[str, float], points: Sequence[tuple[str, Given]]
) -> list[dict[str, float] | None]:
    """Return the rows of rules with other coefficients."""
    found: list[dict[str, float] | None] = [{} for _ in points]
    for prefix, h in dead_times.items():
        places = [place for place, (rule, _) in enumerate(points) if prefix in _applying(dead_times, rule)]
        controllers = [PI(*_gains(points[place][0], h, points[place][1])) for place in places]
        for place, numbers in zip(places, specifications_of_many(1.0, h, controllers, LOAD_AT[h]), strict=True):
            row = found[place]
            found[place] = row | _named(prefix, numbers) if row is not None and numbers else None
    return found


def _named(prefix: str, numbers: Iterable[float]) -> dict[str, float]:
    return {prefix + quantity: number for quantity, number in zip(QUANTITIES, numbers, strict=True)}


for _table, _dead_times in ((table_1, {"": 10.0}), (table_2, {"ph1_": 1.0, "ph0.1_": 0.1})):
    _table.reading(
        "printed-coefficients",
        "any coefficients that round to the printed ones",
        "The tables may have been made with more digits of the fits (7b) and of the Appendix than the paper prints, "
        "and with $1/e$ or any other number that rounds to Bryant's 0.368. The load enters as in the reading before.",
        inputs_of=COEFFICIENTS,
        many=partial(_of_many_coefficients, _dead_times),
    )(partial(_of_coefficients, _dead_times))


def _loop(rule: str, h: float) -> tuple[str, str]:
    """Return plant and controller of a rule as printed, for p = 1."""
    return plant(1.0, h).notation(), PI(*gains(rule, 1.0, h)).notation()


table_1.trials = lambda: {rule: _loop(rule, 10.0) for rule in RULES_1}
table_2.trials = lambda: {(rule, f"ph = {h:g}"): _loop(rule, h) for rule in RULES_2 for h in (1.0, 0.1)}
