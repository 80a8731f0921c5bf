"""Section III: condition (27) and the choice of the free parameter a."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product

import numpy as np
from scipy import optimize

from replicate.exhibits import ClaimVerdict, Finding
from replicate.exhibits.evidence import listed, number
from replicate.exhibits.extrema import smallest
from replicate.exhibits.printed import PrintedValue
from replicate.loops import Loop, sweep
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.claims import PROCESSES, claims
from replicate.papers.bayhan.pole_assignment import assign, dominance
from replicate.papers.bayhan.processes import EXAMPLE_41, EXAMPLE_42, PT326, Process, specifications

_AT_A_TIME = 16  # loops of a sweep


def _limit_of_dominance(process: Process) -> float:
    """Return the a at which the second margin of (27) changes sign, the one that fails first."""

    def margin(a: float) -> float:
        return float(min(process.dominance(a)))

    grid = np.linspace(0.01, 4.0, 400)
    holds = np.minimum(*dominance(process.K, process.L, process.tau, grid)) > 0.0  # type: ignore[arg-type]
    first = int(np.flatnonzero(~holds)[0])
    return float(optimize.brentq(margin, grid[first - 1], grid[first], xtol=1e-13))


@claims.claim(
    "residue-hurwitz",
    "The residue polynomial is Hurwitz if and only if $c_0$ and $c_1$ are positive.",
    where="section III, below (25)",
)
def residue_hurwitz() -> Finding:
    wrong, total, stable = 0, 0, 0
    for process in PROCESSES:
        for a in np.linspace(0.05, 6.0, 120):
            found = assign(process.K, process.L, process.tau, float(a))
            hurwitz = bool(np.all(np.roots([1.0, float(found.c1), float(found.c0)]).real < 0.0))
            wrong += hurwitz != (found.c0 > 0 and found.c1 > 0)
            total, stable = total + 1, stable + hurwitz
    return Finding(
        "fails" if wrong else "holds",
        wrong,
        f"For the paper's three processes and {total} choices of $a$ up to 6 the roots disagree with the signs of (23) "
        f"and (24) {wrong} times; {stable} of the polynomials are Hurwitz.",
    )


def _dominance(process: Process, printed: tuple[str, str] | None = None) -> Finding:
    """Judge condition (27); where the process was identified, for all L and tau that round to the printed ones."""
    margins = process.dominance()
    limits = [
        _limit_of_dominance(replace(process, L=dead_time, tau=time_constant))
        for dead_time, time_constant in (product(*(PrintedValue(text).ends for text in printed)) if printed else ())
    ]
    reached = printed and max(limits) > process.a
    verdict: ClaimVerdict = "holds" if margins.holds else "undecided" if reached else "fails"
    return Finding(
        verdict,
        float(min(margins)),
        f"For $a = {process.a}$ the two margins are {number(float(margins.linear))} and "
        f"{number(float(margins.constant))}; both must be positive, which they are for $a$ below "
        f"{number(_limit_of_dominance(process))}."
        + (
            f" For dead times and time constants that round to the printed ones this limit is from "
            f"{number(min(limits))} to {number(max(limits))}: the digits of the model leave it open."
            if reached
            else ""
        ),
    )


@claims.claim("dominance-4-1", "Condition (27) is met for Example 4.1, $a = 0.85$.", where="(27), Example 4.1")
def dominance_41() -> Finding:
    return _dominance(EXAMPLE_41)


@claims.claim("dominance-4-2", "Condition (27) is met for Example 4.2, $a = 0.3$.", where="(27), Example 4.2")
def dominance_42() -> Finding:
    return _dominance(EXAMPLE_42)


@claims.claim("dominance-pt326", "Condition (27) is met for the PT326 set, $a = 1.3$.", where="(27), section V")
def dominance_pt326() -> Finding:
    printed = paper.printed_cells("pt326")
    return _dominance(PT326, (printed["L", "value"], printed["tau", "value"]))


@claims.claim(
    "range-of-a",
    "In many practical cases $a$ can be chosen between 0.5 and 4.",
    where="section III, below (16)",
)
def range_of_a() -> Finding:
    limits = {process.title: _limit_of_dominance(process) for process in PROCESSES}
    lowest = min(limits.values())
    return Finding(
        "undecided",
        lowest,
        "“Many cases” cannot be counted. For the paper's own processes condition (27) allows $a$ only up to "
        f"{listed(limits)}, and Example 4.2 uses $a = {EXAMPLE_42.a}$, outside the range.",
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
    """Return the a up to which the settling time falls, from half the paper's a on."""

    def time(a: float) -> float:
        return specifications(process, process.pole_assignment(a))["settling_time"]

    previous = math.inf
    # a few at a time: far beyond the turning point the loops hardly settle at all
    for first in range(round(50 * process.a), 400, _AT_A_TIME):
        steps = range(first, min(first + _AT_A_TIME, 400))
        found = sweep(process.plant, [process.pole_assignment(step / 100) for step in steps], "settling_time")
        for step, here in zip(steps, found["settling_time"][0], strict=True):
            if not here < previous:
                return smallest(time, np.array([step - 2, step - 1, step]) / 100)[0]
            previous = here
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
        f"Only up to a point: the settling time falls with $a$ up to {listed(turning)} (the paper "
        f"takes {EXAMPLE_41.a}, {EXAMPLE_42.a} and {PT326.a}), next to the limits of "
        "condition (27), and rises again beyond. The PT326 loop is unstable from $a$ = "
        f"{number(_stable_limit(PT326))} on.",
    )
