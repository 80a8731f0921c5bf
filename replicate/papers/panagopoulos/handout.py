"""Answers and figures of the handout's exercises; all of it belongs to paper I."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from replicate.exhibits.exercises import Exercises, Values
from replicate.loops import Loop, Signal, design_pi
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import design, load_response
from replicate.papers.panagopoulos.part_1.plants import PLANTS
from replicate.papers.panagopoulos.part_1.settling import BAND, one_sided, two_sided
from replicate.papers.panagopoulos.part_1.settling_evidence import levels

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


@exercises.answer("dead-time")
def dead_time() -> Values:
    """Return the design for a pure dead time, Ms = 2."""
    found = design("G7", 2.0)
    return {"w": found.frequency, "k": found.k, "ki": found.ki}


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
