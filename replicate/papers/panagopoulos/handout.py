"""Answers and figures of the handout's exercises; all of it belongs to paper I."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from replicate.exhibits.exercises import Exercises, Values
from replicate.exhibits.variants import Answer, Answers, Inputs, rounded
from replicate.loops import PI, Loop, Plant, Signal, design_pi
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import design, load_response
from replicate.papers.panagopoulos.part_1.plants import PLANTS
from replicate.papers.panagopoulos.part_1.settling import BAND, one_sided, two_sided
from replicate.papers.panagopoulos.part_1.settling_evidence import levels
from replicate.teaching import nyquist_reading, step_test, windup

if TYPE_CHECKING:
    from matplotlib.figure import Figure

exercises = Exercises()

TIMED = ("G1", "G2", "G3", "G5", "G6")  # the plants whose printed times belong to a unit load


@exercises.answer("undershoot")
def undershoot() -> Values:
    """Return the lowest value of the load response of G6 with Ms = 2."""
    return {"G6": load_response("G6", 2.0).trough().value}


@exercises.answer("late")
def late() -> Values:
    """Return by how many per cent the print is later than the one-sided times, and how far off the others are."""
    frame = levels()
    rows = [f"{plant} Ms={ms}" for plant in TIMED for ms in (1.4, 2.0)]
    chosen = frame.loc[rows]
    factor = max(float((chosen[name] / chosen["printed"]).max()) for name in ("within_5", "within_2"))
    return {"least": float(chosen["late"].min()), "most": float(chosen["late"].max()), "factor": factor}


def _pure(inputs: Inputs) -> tuple[float, float, float]:
    """Return frequency, k and ki of the design for a pure dead time."""
    L, ms = float(inputs["L"]), float(inputs["Ms"])
    if (L, ms) == (1.0, 2.0):
        printed = design("G7", 2.0)
        return printed.frequency, printed.k, printed.ki
    found = design_pi(Plant([1.0], [1.0], dead_time=L), ms=ms)
    return found.frequency, found.k, found.ki


def _worded(inputs: Inputs) -> Values:
    L, ms = float(inputs["L"]), float(inputs["Ms"])
    return {
        "G": "e^{-s}" if L == 1.0 else rf"e^{{-{L:g}s}}",
        "x": r"\omega" if L == 1.0 else rf"({L:g}\omega)",
        "R": r"\tfrac{1}{2}" if ms == 2.0 else rf"1/{ms:g}",
    }


@exercises.vary(
    "dead-time",
    original={"L": 1.0, "Ms": 2.0},
    variant=lambda rng: {"L": rng.randint(3, 60) / 10, "Ms": rng.randint(13, 24) / 10},
    requires={"L is not one": lambda inputs: abs(float(inputs["L"]) - 1.0) > 0.1},
    shown=_worded,
    stated="Carry on with at least four significant digits, and state the answers with three.",
)
def dead_time(inputs: Inputs) -> Answers:
    """Return frequency and gains of the design for a pure dead time, carried on with a frequency of four digits."""
    L, ms = float(inputs["L"]), float(inputs["Ms"])
    w, k, ki = _pure(inputs)
    x, early = w * L, rounded(w, 4) * L
    return {
        "w": Answer(
            w,
            digits=3,
            mistakes={"where the gain vanishes": (np.pi - np.arcsin(1 / ms)) / L, "dead time forgotten": x},
            asked=r"$\omega$",
        ),
        "k": Answer(k, digits=3, carried=(-math.cos(early),), mistakes={"sign": -k, "sine": math.sin(x)}, asked="$k$"),
        "ki": Answer(
            ki,
            digits=3,
            carried=(early / L * (math.sin(early) - 1 / ms),),
            mistakes={"1/Ms forgotten": w * math.sin(x), "dead time forgotten": ki * L},
            asked="$k_i$",
        ),
    }


@exercises.figure(
    "one-sided",
    "Load responses of G6",
    alt="Load responses of the sixth plant for maximum sensitivities of 1.4 and 2 with a band of plus or minus "
    "five per cent. A circle on the curve for 2 marks the printed settling time: there it crosses zero, and it then "
    "leaves the band downwards before it settles.",
    size=(6.3, 2.5),
)
def draw_one_sided(fig: Figure) -> None:
    """Draw the load responses of G6 and the printed settling times on them."""
    axes = fig.subplots()
    axes.axhspan(-BAND, BAND, color="0.5", alpha=0.2, linewidth=0.0)
    times = np.linspace(0.0, 8.0, 801)
    for ms, style in ((1.4, "--"), (2.0, "-")):
        response = load_response("G6", ms)
        (line,) = axes.plot(times, response(times), style, label=f"$M_s = {ms:g}$")
        mark = paper.printed_numbers("I-table-1")[f"G6 Ms={ms}", "ts"]
        axes.plot([mark], [float(response(mark))], "o", color=line.get_color(), markersize=6)
    axes.set(xlabel="time $t$", ylabel="output $y$", xlim=(0.0, 8.0))
    axes.legend()


def _load(ms: float) -> Signal:
    plant = PLANTS["G1"]
    return Loop(plant, design_pi(plant, ms=ms).controller).load_step()


@cache
def _jump() -> float:
    """Return the Ms at which the trough of the load response of G1 touches the band."""
    return float(optimize.brentq(lambda ms: _load(ms).trough().value + BAND, 1.4, 2.0, xtol=1e-10))


@exercises.answer("jump")
def jump() -> Values:
    """Return where the two-sided settling time of G1 jumps, and from where to where."""
    ms = _jump()
    before, after = two_sided(_load(ms - 1e-6)), two_sided(_load(ms + 1e-6))
    return {"ms": ms, "before": before, "after": after, "per_cent": 100.0 * (after / before - 1.0)}


@exercises.figure(
    "settling-over-ms",
    "Settling times of G1 over the maximum sensitivity",
    alt="Settling time of the load response of the first plant over the maximum sensitivity from 1.2 to 2.2. The "
    "one-sided time falls steadily. The two-sided one falls with it, then jumps up once and decreases slowly.",
    size=(5.6, 2.2),
)
def draw_settling(fig: Figure) -> None:
    """Draw the one-sided and the two-sided settling time of G1 over Ms."""
    ms = _jump()
    grid: NDArray[np.float64] = np.sort(np.append(np.linspace(1.2, 2.2, 61), [ms - 1e-6, ms + 1e-6]))
    responses = [_load(float(value)) for value in grid]
    axes = fig.subplots()
    axes.plot(grid, [two_sided(response) for response in responses], label="last outside ±5 %")
    axes.plot(grid, [one_sided(response) for response in responses], "--", label="last above +5 %")
    axes.set(xlabel="$M_s$", ylabel="settling time", ylim=(0.0, None))
    axes.legend()


def _nyquist_loop(inputs: Inputs) -> Loop:
    plant = Plant([1.0], np.polymul([float(inputs["T"]), 1.0], [1.0, 2.0, 1.0]))
    return Loop(plant, PI(k=float(inputs["k"]), ki=float(inputs["ki"])))


nyquist_reading(
    exercises,
    "nyquist",
    {"T": 1.0, "k": 1.6, "ki": 0.6},
    loop=_nyquist_loop,
    variant=lambda rng: {
        "T": rng.randint(3, 20) / 10,
        "k": rng.randint(8, 35) / 10,
        "ki": rng.randint(2, 15) / 10,
    },
)
step_test(exercises, "step-test", {"K": 1.7, "T": 6.0, "L": 2.5, "u": 1.4, "seed": 1998.0})
windup(exercises, "windup", {"K": 1.6, "T": 4.0, "L": 0.9, "k": 2.4, "ki": 0.7, "U": 1.2})
