"""Answers and figures of the handout's exercises."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from random import Random
from typing import TYPE_CHECKING

import numpy as np
from scipy import optimize

from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.variants import Answer, Answers, Inputs, rounded
from replicate.loops import Loop
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.evidence import in_steps, six_digits
from replicate.papers.bayhan.processes import EXAMPLE_41, competing_rules, controllers
from replicate.papers.bayhan.readings import AUTHORS
from replicate.papers.bayhan.toolchain import sampled_response, sampled_specifications
from replicate.teaching import control_effort, sketch

if TYPE_CHECKING:
    from matplotlib.figure import Figure

exercises = Exercises()

ASKED = ("ZN", "ITAESPC")  # the rules whose integral gains the first exercise asks for
NAMES = {"ZN": "Ziegler and Nichols", "ITAESPC": "ITAESPC"}
CLEAR = 0.05  # so far from one, as a logarithm, that an answer rounded early differs from a wrong one


@exercises.answer("example")
def example() -> Values:
    """Return the pole assignment of Example 4.1."""
    found = EXAMPLE_41.pole_assignment()
    return {"a": EXAMPLE_41.a, "Kp": found.k, "Ki": found.ki}


def _plant(rng: Random) -> Inputs:
    """Draw a process with numbers of two digits."""
    return {"K": rng.randint(3, 30) / 10, "tau": rng.randint(5, 60) / 10, "L": rng.randint(3, 60) / 10}


def _competitors(inputs: Inputs) -> dict[str, tuple[float, float]]:
    """Return Kp and Ti of the ten rules of Table 1."""
    tau = float(inputs["tau"])
    process = replace(EXAMPLE_41, K=float(inputs["K"]), tau=tau, L=float(inputs["L"]), tau_cl=EXAMPLE_41.tau_cl * tau)
    found = {name: rule.evaluate(**process.symbols) for name, rule in competing_rules().items()}
    return {name: (float(gains.kp), float(gains.ti)) for name, gains in found.items()}


def _proportional_gains(inputs: Inputs) -> dict[str, float]:
    return {name: kp for name, (kp, _) in _competitors(inputs).items()}


def _gains_clear_of_one(inputs: Inputs) -> bool:
    gains = _proportional_gains(inputs).values()
    return all(abs(math.log(kp)) > CLEAR for kp in gains) and min(gains) < 1.0 < max(gains)


def _smallest_suffers(inputs: Inputs) -> bool:
    gains = _proportional_gains(inputs).values()
    return min(gains) * max(gains) < 1.0


def _times_clear_of_one(inputs: Inputs) -> bool:
    """Whether dividing by Ti differs from multiplying by it."""
    found = _competitors(inputs)
    return all(abs(math.log(found[rule][1])) > CLEAR for rule in ASKED)


def _shown(inputs: Inputs) -> Values:
    """Return the process and all rules as the text names them: which got too much integral action, which too little."""
    gains = _proportional_gains(inputs)
    found = _competitors(inputs)
    K, tau, L = (f"{float(inputs[name]):g}" for name in ("K", "tau", "L"))
    return {
        "process": rf"K = \tau = L = {K}" if K == tau == L else rf"K = {K},\ \tau = {tau},\ L = {L}",
        **{f"{rule} Kp": found[rule][0] for rule in ASKED},
        **{f"{rule} Ti": found[rule][1] for rule in ASKED},
        "gains": ", ".join(f"{kp:.3f}" for kp in gains.values()),
        "smallest": min(gains, key=lambda rule: gains[rule]),
        "more": ", ".join(rule for rule, kp in gains.items() if kp < 1.0),
        "less": ", ".join(rule for rule, kp in gains.items() if kp > 1.0),
    }


@exercises.vary(
    "missing-factor",
    original={"K": EXAMPLE_41.K, "tau": EXAMPLE_41.tau, "L": EXAMPLE_41.L},
    variant=_plant,
    requires={
        "K, tau and L differ": lambda inputs: len(set(inputs.values())) == len(inputs),
        "L/tau from 0.3 to 2": lambda inputs: 0.3 <= float(inputs["L"]) / float(inputs["tau"]) <= 2.0,
        "Kp of some rules below one, of others above, of none near one": _gains_clear_of_one,
        "the smallest Kp farthest from one": _smallest_suffers,
        "Ti not near one": _times_clear_of_one,
    },
    shown=_shown,
    stated="Carry on with at least three significant digits, and state $K_i$ with three.",
)
def missing_factor(inputs: Inputs) -> Answers:
    """Return for two rules the integral gain by (3) and without Kp, carried on with gains of three digits."""
    found: dict[str, Answer] = {}
    competitors = _competitors(inputs)
    for rule in ASKED:
        kp, ti = competitors[rule]
        p, t = rounded(kp, 3), rounded(ti, 3)
        found[f"{rule} Kp/Ti"] = Answer(
            kp / ti,
            digits=3,
            carried=(p / t, p / ti, kp / t),
            mistakes={"Kp forgotten": 1 / ti, "multiplied by Ti": kp * ti},
            asked=f"{NAMES[rule]}, $K_i = K_p/T_i$",
        )
        found[f"{rule} 1/Ti"] = Answer(
            1 / ti,
            digits=3,
            carried=(1 / t,),
            mistakes={"Kp kept": kp / ti, "not inverted": ti},
            asked=f"{NAMES[rule]}, $1/T_i$",
        )
    return found


@exercises.answer("exact-double-pole")
def exact_double_pole() -> Values:
    """Return the gains that give the loop with the exact dead time, K = tau = L = 1, a double pole at -a."""
    a = EXAMPLE_41.a
    return {"Kp": (3 * a - 1 - a**2) * math.exp(-a), "Ki": a**2 * (2 - a) * math.exp(-a)}


def _pade_error(x: float) -> float:
    """Return how far the phase of the second-order Padé model (7) is off at omega L = x, in degrees."""
    s = 1j * x
    return math.degrees(cmath.phase((1 - s / 2 + s**2 / 12) / (1 + s / 2 + s**2 / 12) * cmath.exp(s)))


@exercises.answer("pade-crossover")
def pade_crossover() -> Values:
    """Return omega L at the gain crossover of Example 4.1 and the error of the Padé model there, in degrees."""
    margins = Loop(EXAMPLE_41.plant, EXAMPLE_41.pole_assignment()).margins()
    crossover = margins.gain_crossover * EXAMPLE_41.L
    return {"omega L": crossover, "error": _pade_error(crossover)}


def _frequencies(rng: Random) -> Inputs:
    """Draw a frequency at which the model is good, one at which it still is, and one at which it fails."""
    ranges = {"low": (10, 16), "middle": (17, 27), "high": (33, 46)}
    return {name: rng.randint(*ends) / 10 for name, ends in ranges.items()}


@exercises.vary(
    "pade-phase",
    original={"low": 1.0, "middle": 2.0, "high": 4.0},
    variant=_frequencies,
    requires={"the arctangent passes 90 degrees": lambda inputs: float(inputs["high"]) > math.sqrt(12)},
    stated="Carry on with at least two decimals, and state the errors with two.",
)
def pade_phase(inputs: Inputs) -> Answers:
    """Return the error of the phase at three values of omega L, carried on with angles of two decimals."""
    found: dict[str, Answer] = {}
    for name, drawn in inputs.items():
        error, dead_time = _pade_error(float(drawn)), math.degrees(float(drawn))
        found[name] = Answer(
            error,
            unit="degrees",
            tolerance=0.01,
            carried=(round(dead_time, 2) - round(dead_time - error, 2),),
            mistakes={"half of the angle": (dead_time + error) / 2, "wrong sign": -error},
            asked=rf"error at $\omega L = {float(drawn):g}$",
        )
    return found


@exercises.answer("sample-counts")
def sample_counts() -> Values:
    """Count the rows of Tables 2 and 3 whose printed settling time is sample 909 or 910 of their own grid."""
    counts = in_steps()["settling_time"]
    return {"rows": float(counts.round().isin([909.0, 910.0]).sum()), "of": float(len(counts))}


@exercises.answer("misprint")
def misprint() -> Values:
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


sketch(
    exercises,
    "sketch",
    {"p": -0.5, "g": 1.0, "L": 0.8, "k": 0.6, "ki": 0.4},
    pole=(-0.9, -0.2),
    gain=(0.3, 0.9),
)
control_effort(exercises, "effort", {"K": 0.8, "T": 3.0, "L": 1.0, "k": 1.9, "ki": 0.5, "U": 5.0})
