"""Answers and figures of the handout's exercises."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

import numpy as np
from scipy import optimize

from replicate.exhibits.exercises import Answer, Exercises
from replicate.loops import Loop
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.evidence import in_steps, six_digits
from replicate.papers.bayhan.processes import EXAMPLE_41, RULES, competing_rules, controllers
from replicate.papers.bayhan.readings import AUTHORS
from replicate.papers.bayhan.toolchain import sampled_response, sampled_specifications

if TYPE_CHECKING:
    from matplotlib.figure import Figure

exercises = Exercises()


@exercises.answer("example")
def example() -> Answer:
    """Return the pole assignment of Example 4.1."""
    found = EXAMPLE_41.pole_assignment()
    return {"a": EXAMPLE_41.a, "Kp": found.k, "Ki": found.ki}


def _gains(rule: str) -> Answer:
    found = competing_rules()[rule].evaluate(**EXAMPLE_41.symbols)
    kp, ti = float(found.kp), float(found.ti)
    return {"Kp": kp, "Ti": ti, "right": kp / ti, "wrong": 1.0 / ti}


@exercises.answer("gains-ZN")
def gains_zn() -> Answer:
    """Return the gains of Ziegler and Nichols for Example 4.1, integral gain by (3) and without Kp."""
    return _gains("ZN")


@exercises.answer("gains-ITAESPC")
def gains_itaespc() -> Answer:
    """Return the gains of the rule ITAESPC for Example 4.1."""
    return _gains("ITAESPC")


@exercises.answer("who-suffers")
def who_suffers() -> Answer:
    """Sort the competing rules by whether leaving out Kp raises or lowers the integral gain."""
    found = controllers(EXAMPLE_41)
    others = [rule for rule in RULES if rule != "PA"]
    return {
        "gains": ", ".join(f"{found[rule].k:.3f}" for rule in others),
        "smallest": min(others, key=lambda rule: found[rule].k),
        "more": ", ".join(rule for rule in others if found[rule].k < 1.0),
        "less": ", ".join(rule for rule in others if found[rule].k > 1.0),
    }


@exercises.answer("exact-double-pole")
def exact_double_pole() -> Answer:
    """Return the gains that give the loop with the exact dead time, K = tau = L = 1, a double pole at -a."""
    a = EXAMPLE_41.a
    return {"Kp": (3 * a - 1 - a**2) * math.exp(-a), "Ki": a**2 * (2 - a) * math.exp(-a)}


@exercises.answer("pade-phase")
def pade_phase() -> Answer:
    """Return how far the phase of the second-order Padé model (7) is off, in degrees, by omega L."""

    def error(x: float) -> float:
        s = 1j * x
        return math.degrees(cmath.phase((1 - s / 2 + s**2 / 12) / (1 + s / 2 + s**2 / 12) * cmath.exp(s)))

    margins = Loop(EXAMPLE_41.plant, EXAMPLE_41.pole_assignment()).margins()
    crossover = margins.gain_crossover * EXAMPLE_41.L
    return {"1": error(1), "2": error(2), "4": error(4), "crossover": crossover, "there": error(crossover)}


@exercises.answer("sample-counts")
def sample_counts() -> Answer:
    """Count the rows of Tables 2 and 3 whose printed settling time is sample 909 or 910 of their own grid."""
    counts = in_steps()["settling_time"]
    return {"rows": float(counts.round().isin([909.0, 910.0]).sum()), "of": float(len(counts))}


@exercises.answer("misprint")
def misprint() -> Answer:
    """Return the authors' delay time of the rule IAESPC, in steps of its sample grid, and where it leaves the print."""
    found = controllers(EXAMPLE_41, AUTHORS.convention, AUTHORS.variant)["IAESPC"]
    response = sampled_response(EXAMPLE_41, found.k, found.ki)
    assert response is not None  # noqa: S101  -- for the type checker; the row is printed, so it is stable
    delay = sampled_specifications(EXAMPLE_41, found)["delay_time"]
    text, print_ = six_digits(delay), paper.printed_cells("table-2")["IAESPC", "delay_time"]
    wrong, right = next((old, new) for old, new in zip(print_, text, strict=True) if old != new)
    return {"steps": delay / response.spacing, "text": text, "wrong": wrong, "right": right}


@exercises.figure(
    "settling-over-a",
    "Settling time over the free parameter",
    alt="Settling time of the pole assignment over a. It falls to a flat minimum above the paper's choice, "
    "next to the value from which on the second inequality fails, and rises again.",
    size=(5.6, 1.5),
)
def settling_over_a(fig: Figure) -> None:
    """Draw the settling time of the pole assignment over a for Example 4.1."""
    grid = np.linspace(0.4, 1.4, 201)
    times = [Loop(EXAMPLE_41.plant, EXAMPLE_41.pole_assignment(a)).step().settling_time() for a in grid]
    limit = float(optimize.brentq(lambda a: float(min(EXAMPLE_41.dominance(a))), 0.5, 1.4))
    axes = fig.subplots()
    axes.plot(grid, times)
    axes.axvline(EXAMPLE_41.a, color="C1", linestyle="--", linewidth=1.2)
    axes.axvline(limit, color="C3", linestyle=":", linewidth=1.2)
    top = max(times)
    axes.set_ylim(0.0, 1.1 * top)
    axes.annotate("the paper's choice", (EXAMPLE_41.a, 0.95 * top), (-4, 0), textcoords="offset points", ha="right")
    axes.annotate("second inequality fails", (limit, 0.95 * top), (4, 0), textcoords="offset points")
    axes.set_xlabel("$a$")
    axes.set_ylabel("settling time")
