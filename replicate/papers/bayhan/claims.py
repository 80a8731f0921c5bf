"""The checkable sentences of the paper's text."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from replicate.exhibits import Finding
from replicate.loops import PI, Loop
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.equations import exact
from replicate.papers.bayhan.pole_assignment import (
    assign,
    assigned,
    c1_as_printed,
    characteristic,
    match_coefficients,
)
from replicate.papers.bayhan.processes import (
    EXAMPLE_41,
    EXAMPLE_42,
    PT326,
    RULES,
    Convention,
    Process,
    competing_rules,
    controllers,
    exact_step,
    specifications,
)
from replicate.papers.bayhan.readings import AUTHORS, TEXT
from replicate.papers.bayhan.table_3 import ROWS as TABLE_3_ROWS
from replicate.papers.bayhan.toolchain import sampled_specifications

claims = paper.claims()

UNSTABLE = ("CC", "IMC", "IAESPC", "ITSE", "ITSESPC")
PROCESSES = (EXAMPLE_41, EXAMPLE_42, PT326)

# Points at which the formulas are compared in exact arithmetic: K, L, tau, a.
_FRACTIONS = (Fraction(1, 3), Fraction(3, 4), Fraction(2), Fraction(7, 2))
GRID = tuple(product((Fraction(7, 8), Fraction(5)), _FRACTIONS, _FRACTIONS, _FRACTIONS))


def _number(value: float) -> str:
    return f"{value:.4g}"


def _listed(values: Mapping[str, float]) -> str:
    return ", ".join(f"{_number(value)} ({name})" for name, value in values.items())


def _sorted(values: Mapping[str, float]) -> dict[str, float]:
    return dict(sorted(values.items(), key=lambda item: item[1]))


@cache
def _table(process: Process, which: Literal["text", "authors"]) -> dict[str, dict[str, float]]:
    """Return the specifications of the stable rules: by equation (3) and exact, or as the authors did."""
    assumption, method = (TEXT, specifications) if which == "text" else (AUTHORS, sampled_specifications)
    found = controllers(process, assumption.convention, assumption.variant)
    rows = {rule: method(process, found[rule]) for rule in RULES}
    return {rule: row for rule, row in rows.items() if not math.isnan(row["settling_time"])}


def _column(process: Process, which: Literal["text", "authors"], name: str) -> dict[str, float]:
    return {rule: row[name] for rule, row in _table(process, which).items()}


# ------------------------------------------------------------------------------------------------------------
# formulas


@claims.claim(
    "eq-5-7",
    "(5) and (6) give the first- and second-order Padé approximations (7).",
    where="section II, (5) to (7)",
)
def eq_5_7() -> Finding:
    def h(n: int, k: int) -> Fraction:
        factorial = math.factorial
        return Fraction(
            factorial(2 * n - k) * factorial(n), factorial(2 * n) * factorial(k) * factorial(n - k)
        )  # (6), with (2n)!

    printed = {1: (1, Fraction(1, 2)), 2: (1, Fraction(1, 2), Fraction(1, 12))}  # (7)
    gap = max(abs(h(n, k) - value) for n, values in printed.items() for k, value in enumerate(values))
    return Finding(
        "holds" if gap == 0 else "fails",
        float(gap),
        "With $(2n)!$ in (6) the coefficients are exactly those of (7) (largest difference "
        f"{float(gap):g}). The print has $2n!$; the factor cancels in (5), so the slip is harmless.",
    )


@claims.claim(
    "eq-21-23", "$K_p$, $K_i$ and $c_0$ of (21) to (23) solve (14) = (20).", where="section III, (21) to (23)"
)
def eq_21_23() -> Finding:
    wrong = sum(assign(*point)[:3] != match_coefficients(*point)[:3] for point in GRID)
    return Finding(
        "fails" if wrong else "holds",
        wrong,
        f"In exact rational arithmetic the formulas differ from the direct solution at {wrong} of "
        f"{len(GRID)} points $(K, L, \\tau, a)$. (In the scan the “+” that opens each continuation line "
        "has become a “=”.)",
    )


@claims.claim("eq-24", "$c_1$ of (24) solves (14) = (20).", where="section III, (24)")
def eq_24() -> Finding:
    as_printed = sum(c1_as_printed(L, tau, a) != match_coefficients(K, L, tau, a).c1 for K, L, tau, a in GRID)
    restored = sum(assign(*point).c1 != match_coefficients(*point).c1 for point in GRID)
    return Finding(
        "fails" if as_printed else "holds",
        as_printed,
        f"As it stands, (24) differs from the direct solution at {as_printed} of {len(GRID)} points: its "
        "last line is empty. With the term $864\\,\\tau^3(aL+\\tau)/(L\\Delta)$ restored it differs at "
        f"{restored} of them.",
    )


@claims.claim("eq-20", "(20) is the expanded product $P_d(s)P_e(s)$.", where="section III, (20)")
def eq_20() -> Finding:
    tau, a, low, high = Fraction(2), Fraction(3, 4), Fraction(5), Fraction(7)
    s = Fraction(3)
    product_of_both = (s + a / tau) ** 2 * (s**2 + high * s + low)  # (18), (19)
    mended = sum(c * s**n for n, c in enumerate(assigned(tau, a, (low, high))))
    printed = mended + (2 * a / tau**2 - 2 * a / tau) * s**3
    gap = float(printed - product_of_both)
    return Finding(
        "fails" if gap else "holds",
        gap,
        "At $s = 3$ for $\\tau = 2$, $a = 3/4$, $c_0 = 5$, $c_1 = 7$ the printed right-hand side is off by "
        f"{_number(gap)}: the coefficient of $s^3$ is $2a/\\tau + c_1$, not $2a/\\tau^2 + c_1$. With it "
        f"the difference is {float(mended - product_of_both):g}. The sentence above (20) should refer to "
        "(17), not (16).",
    )


@claims.claim(
    "double-pole",
    "The controller (21), (22) puts two poles of the Padé loop at $-a/\\tau$.",
    where="section III, (14), (17), (18)",
)
def double_pole() -> Finding:
    worst = Fraction(0)
    for K, L, tau, a in (*GRID, *(exact(process) for process in PROCESSES)):
        found = assign(K, L, tau, a)
        polynomial = characteristic(K, L, tau, found[:2])
        s = -a / tau
        value = sum(c * s**n for n, c in enumerate(polynomial))
        slope = sum(n * c * s ** (n - 1) for n, c in enumerate(polynomial) if n)
        worst = max(worst, abs(Fraction(value)), abs(Fraction(slope)))
    return Finding(
        "holds" if worst == 0 else "fails",
        float(worst),
        f"Value and slope of (14) at $-a/\\tau$ are {float(worst):g} in exact arithmetic, at {len(GRID)} "
        "points and for the paper's three processes.",
    )


# ----------------------------------------------------------------------------------------------- choice of a,
# (27)


def _limit_of_dominance(process: Process) -> float:
    """Return the a at which the second margin of (27) changes sign, the one that fails first."""

    def margin(a: float) -> float:
        return float(min(process.dominance(a)))

    grid = np.linspace(0.01, 4.0, 400)
    signs = np.array([margin(a) > 0 for a in grid])
    first = int(np.flatnonzero(~signs)[0])
    return float(optimize.brentq(margin, grid[first - 1], grid[first], xtol=1e-13))


def _dominance(process: Process) -> Finding:
    margins = process.dominance()
    return Finding(
        "holds" if margins.holds else "fails",
        float(min(margins)),
        f"For $a = {process.a}$ the two margins are {_number(float(margins.linear))} and "
        f"{_number(float(margins.constant))}; both must be positive, which they are for $a$ below "
        f"{_number(_limit_of_dominance(process))}.",
    )


@claims.claim("dominance-4-1", "Condition (27) is met for Example 4.1, $a = 0.85$.", where="(27), Example 4.1")
def dominance_41() -> Finding:
    return _dominance(EXAMPLE_41)


@claims.claim("dominance-4-2", "Condition (27) is met for Example 4.2, $a = 0.3$.", where="(27), Example 4.2")
def dominance_42() -> Finding:
    return _dominance(EXAMPLE_42)


@claims.claim("dominance-pt326", "Condition (27) is met for the PT326 set, $a = 1.3$.", where="(27), section V")
def dominance_pt326() -> Finding:
    return _dominance(PT326)


@claims.claim(
    "range-of-a",
    "In many practical cases $a$ can be chosen between 0.5 and 4.",
    where="section III, below (16)",
)
def range_of_a() -> Finding:
    limits = {process.title: _limit_of_dominance(process) for process in PROCESSES}
    lowest = min(limits.values())
    return Finding(
        "fails" if max(limits.values()) < 4.0 else "holds-partly",
        lowest,
        f"For the paper's own processes condition (27) allows $a$ only up to {_listed(limits)}, and "
        f"Example 4.2 uses $a = {EXAMPLE_42.a}$, outside the range.",
    )


def _stable_limit(process: Process) -> float:
    """Return the first a above the paper's at which the loop with exact dead time becomes unstable."""

    def stable(a: float) -> bool:
        return Loop(process.plant, process.pole_assignment(a)).is_stable()

    low = process.a
    while stable(low + 0.05):
        low += 0.05
    high = low + 0.05
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return high


def _slower_beyond(process: Process) -> float:
    """Return the a up to which the settling time falls, on a grid from half the paper's a on."""
    previous = math.inf
    for step in range(round(50 * process.a), 400):
        time = specifications(process, process.pole_assignment(step / 100))["settling_time"]
        if not time < previous:
            return (step - 1) / 100
        previous = time
    return 4.0


@claims.claim(
    "a-is-speed",
    "The free parameter $a$ fine-tunes the speed of the closed loop (the larger, the faster).",
    where="section III, (16)",
)
def a_is_speed() -> Finding:
    turning = {process.title: _slower_beyond(process) for process in PROCESSES}
    return Finding(
        "holds-partly",
        turning[PT326.title],
        f"Only up to a point: the settling time falls with $a$ up to {_listed(turning)} (on a grid of step "
        f"0.01; the paper takes {EXAMPLE_41.a}, {EXAMPLE_42.a} and {PT326.a}), next to the limits of "
        "condition (27), and rises again beyond. The PT326 loop is unstable from $a$ = "
        f"{_number(_stable_limit(PT326))} on.",
    )


# ------------------------------------------------------------------------------------------------------------
# examples


@claims.claim("no-overshoot", "The pole assignment gives no overshoot.", where="abstract, Tables 2 and 3, section V")
def no_overshoot() -> Finding:
    values = {process.title: _column(process, "text", "overshoot")["PA"] for process in PROCESSES}
    worst = max(values.values())
    return Finding(
        "holds" if worst < 0.0005 else "fails",
        worst,
        f"With the exact dead time the overshoot is, as a fraction, {_listed(values)}: nothing that could be seen.",
    )


@claims.claim(
    "others-overshoot",
    "In Example 4.1 all rules except PA and ZN overshoot considerably.",
    where="Example 4.1, text above Table 2",
)
def others_overshoot() -> Finding:
    text, authors = (_column(EXAMPLE_41, which, "overshoot") for which in ("text", "authors"))
    others = [rule for rule in RULES if rule not in {"PA", "ZN"}]
    smallest = min(others, key=lambda rule: text[rule])
    small = {rule: text[rule] for rule in others if text[rule] < 0.05}
    return Finding(
        "fails" if small else "holds",
        text[smallest],
        "With the gains of equation (3) these rules overshoot by less than 5 %: "
        f"{_listed(_sorted(small)) or 'none'}. With the gains used for the tables ($K_i = 1/T_i$) the "
        f"smallest is {_number(min(authors[rule] for rule in others))}.",
    )


@claims.claim(
    "settles-third",
    "In Example 4.1 the pole assignment settles third, after IAE and ITAE.",
    where="Example 4.1, text above Table 2",
)
def settles_third() -> Finding:
    text, authors = (_sorted(_column(EXAMPLE_41, which, "settling_time")) for which in ("text", "authors"))
    rank = list(text).index("PA") + 1
    faster = {rule: text[rule] for rule in list(text)[: rank - 1]}
    return Finding(
        "holds" if list(text)[:3] == ["IAE", "ITAE", "PA"] else "fails",
        rank,
        f"With the gains of equation (3) PA ({_number(text['PA'])}) comes in place {rank}, after "
        f"{_listed(faster)}. With the gains used for the tables the order begins "
        f"{', '.join(list(authors)[:4])}.",
    )


@claims.claim(
    "slow-rise",
    "In Example 4.1 delay and rise time of the pole assignment are long.",
    where="Example 4.1, text above Table 2; section VI",
)
def slow_rise() -> Finding:
    delay, rise = (_column(EXAMPLE_41, "text", name) for name in ("delay_time", "rise_time"))
    ranks = [sorted(column.values(), reverse=True).index(column["PA"]) + 1 for column in (delay, rise)]
    return Finding(
        "holds" if max(ranks) <= 2 else "fails",
        delay["PA"],
        f"Delay time {_number(delay['PA'])} and rise time {_number(rise['PA'])} are number {ranks[0]} and "
        f"{ranks[1]} from the top among {len(delay)} rules (equation (3), exact dead time).",
    )


@claims.claim(
    "near-optimal-tau-cl",
    "In Example 4.1 $\\tau_{cl} = 0.06$ gives the IMC rule near optimal results.",
    where="Example 4.1",
)
def near_optimal_tau_cl() -> Finding:
    def best(which: Literal["text", "authors"]) -> tuple[float, float]:
        times = {}
        for step in range(1, 101):
            tau_cl = step / 100
            kp = competing_rules()["IMC"].evaluate(**{**EXAMPLE_41.symbols, "tau_cl": tau_cl}).kp
            ki = kp / EXAMPLE_41.tau if which == "text" else 1.0 / EXAMPLE_41.tau
            method = specifications if which == "text" else sampled_specifications
            time = method(EXAMPLE_41, PI(k=float(kp), ki=float(ki)))["settling_time"]
            if not math.isnan(time):
                times[tau_cl] = time
        optimum = min(times, key=lambda tau_cl: times[tau_cl])
        return optimum, times[optimum]

    (text, fastest), (authors, _) = best("text"), best("authors")
    paper_time = _column(EXAMPLE_41, "text", "settling_time")["IMC"]
    return Finding(
        "fails" if paper_time > 1.1 * fastest else "holds",
        text,
        f"Among $\\tau_{{cl}}$ = 0.01, 0.02, ..., 1 the settling time is shortest at {text:g} by equation "
        f"(3) ({_number(fastest)}, against {_number(paper_time)} at 0.06), but at {authors:g} in the "
        "authors' computation, where $K_i = 1/T_i$ does not change with $\\tau_{cl}$. Their optimum, like "
        "their table, belongs to that gain.",
    )


@claims.claim(
    "imc-cancels",
    "The zero of the IMC controller cancels the pole of the process.",
    where="section I",
)
def imc_cancels() -> Finding:
    zeros: dict[Convention, float] = {}
    for convention in ("Kp/Ti", "1/Ti"):
        imc = controllers(EXAMPLE_41, convention)["IMC"]
        zeros[convention] = -imc.ki / imc.k
    pole = -1.0 / EXAMPLE_41.tau
    return Finding(
        "holds" if math.isclose(zeros["Kp/Ti"], pole) else "fails",
        zeros["Kp/Ti"],
        f"By equation (3) the zero is at {_number(zeros['Kp/Ti'])}, on the pole at {_number(pole)}. With "
        f"$K_i = 1/T_i$, as in the tables, it is at {_number(zeros['1/Ti'])} and cancels nothing.",
    )


def _unstable(convention: Convention, variant: str) -> list[str]:
    found = controllers(EXAMPLE_42, convention, variant)
    return [rule for rule in RULES if not Loop(EXAMPLE_42.plant, found[rule]).is_stable()]


@claims.claim(
    "unstable-4-2",
    "In Example 4.2 CC, IMC, IAESPC, ITSE and ITSESPC are unstable, and only they.",
    where="Example 4.2",
)
def unstable_42() -> Finding:
    text, corrected, authors = (
        _unstable("Kp/Ti", "printed"),
        _unstable("Kp/Ti", "corrected"),
        _unstable("1/Ti", "authors"),
    )
    agree = len(set(text) & set(UNSTABLE))
    return Finding(
        "holds" if set(text) == set(UNSTABLE) else "holds-partly" if agree else "fails",
        agree,
        f"By equation (3) unstable are {', '.join(text)}; with the printing errors of Table 1 mended, "
        f"{', '.join(corrected)}. With the gains used for the tables unstable are {', '.join(authors)}. "
        "(The paper gives no $\\tau_{cl}$; that of Example 4.1 is used. By equation (3) the IMC loop is "
        "stable for every positive one.)",
    )


@claims.claim(
    "most-acceptable-4-2",
    "In Example 4.2 the pole assignment is the most acceptable of the stable rules if no overshoot is wanted.",
    where="Example 4.2, text below Table 3",
)
def most_acceptable() -> Finding:
    rows = {rule: _table(EXAMPLE_42, "text")[rule] for rule in TABLE_3_ROWS}
    without = {rule: row["settling_time"] for rule, row in rows.items() if row["overshoot"] < 0.005}
    order = list(_sorted(without))
    return Finding(
        "holds" if order[0] == "PA" else "fails",
        without["PA"],
        "Of the rules of Table 3 that overshoot by less than 0.5 % (equation (3), exact dead time) it "
        f"settles first: {_listed(_sorted(without))}.",
    )


@claims.claim(
    "pade-is-enough",
    "A second-order Padé approximation is accurate enough for most practical applications.",
    where="section II, below (7)",
)
def pade_is_enough() -> Finding:
    gaps: dict[str, float] = {}
    for label, process, rows in (("4.1", EXAMPLE_41, RULES), ("4.2", EXAMPLE_42, TABLE_3_ROWS)):
        found = controllers(process, AUTHORS.convention, AUTHORS.variant)
        for rule in rows:
            exactly, sampled = (
                specifications(process, found[rule]),
                sampled_specifications(process, found[rule]),
            )
            for name, value in exactly.items():
                if name != "overshoot":
                    gaps[f"{rule} {name.replace('_', ' ')} ({label})"] = abs(sampled[name] / value - 1.0)
    worst = max(gaps, key=lambda key: gaps[key])
    own = max(gap for key, gap in gaps.items() if key.startswith("PA "))
    return Finding(
        "holds-partly",
        gaps[worst],
        f"For the pole assignment the times from the Padé model and the grid are within {own:.2%} of the "
        "exact ones. Over both tables, with the same gains, half of the times are within "
        f"{float(np.median(list(gaps.values()))):.2%}, but the largest difference is {gaps[worst]:.1%} "
        f"({worst}): a ripple that just reaches the 2 % band decides when the loop has settled.",
    )


# ------------------------------------------------------------------------------------------------------------
# Table 1


@cache
def _best_load(criterion: Literal["ise", "itse"]) -> tuple[float, float, float]:
    """Return k and Ti that minimise a load criterion for K = tau = 1, L = 0.5, and the minimum."""

    def cost(logarithms: NDArray[np.float64]) -> float:
        k, ti = np.exp(logarithms)
        return _load_cost(criterion, float(k), float(ti))

    start = np.array([math.log(2.4), 0.0])
    result = optimize.minimize(cost, start, method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-12})
    k, ti = np.exp(result.x)
    return float(k), float(ti), float(result.fun)


def _load_cost(criterion: Literal["ise", "itse"], k: float, ti: float) -> float:
    """Return an integral criterion of the unit load response, K = tau = 1, L = 0.5; infinite if unstable."""
    loop = Loop(Process("", 1.0, 1.0, 0.5, 1.0, 1.0).plant, PI(k=k, ki=k / ti))
    if not loop.is_stable():
        return math.inf
    response = loop.load_step()
    return response.ise() if criterion == "ise" else response.itse()


@claims.claim(
    "itse-exponent",
    "The exponent in $T_i$ of the rule “ITSE for load disturbance” is $-0.586$.",
    where="Table 1",
)
def itse_exponent() -> Finding:
    symbols = {"K": 1.0, "tau": 1.0, "L": 0.5}
    printed, mended = (float(competing_rules(v)["ITSE"].evaluate(**symbols).ti) for v in ("printed", "corrected"))
    _, ise, _ = _best_load("ise")
    _, itse, _ = _best_load("itse")
    return Finding(
        "fails" if abs(mended - ise) < abs(printed - ise) and abs(mended - itse) < abs(printed - itse) else "holds",
        printed,
        f"For $L/\\tau = 0.5$ the printed rule gives $T_i/\\tau$ = {_number(printed)}, with the sign "
        f"changed {_number(mended)}. The controllers that minimise ISE and ITSE of the load response have "
        f"{_number(ise)} and {_number(itse)}. Example 4.1 has $L/\\tau = 1$ and does not feel the sign; "
        "that ITSE is unstable in Example 4.2 depends on it.",
    )


@claims.claim(
    "itse-label",
    "The rule “ITSE for load disturbance” minimises the time-weighted squared error.",
    where="section I, Table 1",
)
def itse_label() -> Finding:
    gains = competing_rules("corrected")["ITSE"].evaluate(K=1.0, tau=1.0, L=0.5)
    k, ti = float(gains.kp), float(gains.ti)
    excess: dict[Literal["ise", "itse"], float] = {
        name: _load_cost(name, k, ti) / _best_load(name)[2] - 1.0 for name in ("ise", "itse")
    }
    return Finding(
        "fails" if excess["ise"] < 0.2 * excess["itse"] else "holds",
        excess["itse"],
        "For $L/\\tau = 0.5$, with the sign of its exponent mended, the rule exceeds the smallest possible "
        f"ITSE by {excess['itse']:.2%} but the smallest possible ISE by only {excess['ise']:.3%}: its "
        "coefficients minimise ISE.",
    )


# ------------------------------------------------------------------------------------------------------------
# PT326


@claims.claim(
    "pt326-a", "Among the values of $a$, 1.3 is a good choice for the PT326 set.", where="section V, Figure 4"
)
def pt326_a() -> Finding:
    times: dict[float, float] = {}
    for step in range(20, 101):
        found = specifications(PT326, PT326.pole_assignment(step / 50))
        if found["overshoot"] < 0.0005:
            times[step / 50] = found["settling_time"]
    best = min(times, key=lambda a: times[a])
    own = specifications(PT326, PT326.pole_assignment())["settling_time"]
    return Finding(
        "holds" if own <= 1.1 * times[best] else "fails",
        own,
        f"On the identified model the shortest settling time without overshoot is {_number(times[best])}, "
        f"at $a$ = {best:.2f} (grid of step 0.02); $a = {PT326.a}$ settles in {_number(own)}.",
    )


@claims.claim(
    "pt326-ranking",
    "On the PT326 set the pole assignment settles best, together with ITAESPC and IMC.",
    where="section V, Figure 5",
)
def pt326_ranking() -> Finding:
    orders = {}
    for convention in ("Kp/Ti", "1/Ti"):
        found = controllers(PT326, convention)
        times = {
            rule: specifications(PT326, found[rule])["settling_time"]
            for rule in RULES
            if exact_step(PT326, found[rule].k, found[rule].ki) is not None
        }
        orders[convention] = _sorted(times)
    first = [list(order)[:3] for order in orders.values()]
    good = [set(names) == {"PA", "ITAESPC", "IMC"} for names in first]
    text, other = orders.values()
    return Finding(
        "holds" if all(good) else "holds-partly" if any(good) else "fails",
        text["PA"],
        f"On the identified model, by equation (3), the order is {_first(text, 4)}; with $K_i = 1/T_i$ it "
        f"is {_first(other, 4)}.",
    )


def _first(values: Mapping[str, float], count: int) -> str:
    return _listed(dict(_take(values.items(), count)))


def _take(items: Iterable[tuple[str, float]], count: int) -> list[tuple[str, float]]:
    return list(items)[:count]
