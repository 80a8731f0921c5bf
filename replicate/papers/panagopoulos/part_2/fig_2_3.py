"""Figures 2 and 3 of paper II: set-point step and load step for all processes, PID and PI."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from replicate.loops import PID, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.designs import optimal, pi_design, printed
from replicate.papers.panagopoulos.part_2.processes import NEAR_INTEGRATING, PLANTS
from replicate.papers.panagopoulos.part_2.setpoint import with_setpoint
from replicate.papers.panagopoulos.part_2.tables import REPLACEMENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# half of each horizon for the set point, half for the load
HORIZONS = {"G1": 160.0, "G2": 120.0, "G3": 5.0, "G4": 60.0, "G5": 70.0, "G6": 80.0, "G7": 100.0, "G8": 60.0}
LOADS = {"G1": 0.2, "G3": 10.0}  # where a unit load would leave the scale, or not be seen
POINTS = 601


def controller_of(row: str) -> PID:
    """Return the optimal controller; for the rows no reading reproduces, the one the errata print."""
    return printed(REPLACEMENT, row) if row[:2] in NEAR_INTEGRATING else optimal(row)


def draw(fig: Figure, ms: float) -> None:
    """Draw output and control signal of the eight processes, two to a line."""
    outer: Any = fig.subfigures(4, 2)
    for name, part in zip(PLANTS, outer.flat, strict=True):
        row = f"{name} Ms={ms}"
        until, load = HORIZONS[name], LOADS.get(name, 1.0)
        top, bottom = part.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        t = np.linspace(0.0, until, POINTS)
        pi = pi_design(row)
        for label, controller, color, line in (
            ("PID", with_setpoint(row, controller_of(row)), "C0", "-"),
            ("PI", pi.controller, "C1", "--"),
        ):
            response = Loop(PLANTS[name], controller).respond(load=load, load_at=0.5 * until, until=until)
            top.plot(t, response.output(t), color=color, linestyle=line, label=label)
            bottom.plot(t, response.control(t), color=color, linestyle=line, label=label)
        size = "" if load == 1.0 else f", load {load:g}"
        top.set_title(f"$G_{name[1]}${size}", fontsize=10)
        top.set_ylabel("$y$")
        bottom.set_ylabel("$u$")
        bottom.set_xlim(0.0, until)
        bottom.set_xlabel("time $t$")
        if name == "G1":
            top.legend(loc="upper left")


for _id, _ms in (("II-fig-2", 1.4), ("II-fig-3", 2.0)):
    paper.figure(
        _id,
        f"PID and PI responses for $M_s = {_ms}$",
        caption="A unit step of the set point, then a load step halfway (unit size unless the panel says "
        "otherwise); output above, control signal below. PID: the optimum of the stated problem, for $G_1$ and $G_3$ "
        "the controllers of the errata; set-point weight by (13) and (15), filter by the corrected (16). PI: paper I "
        "with its set-point weight.",
        alt=f"Eight pairs of panels, one per process, Ms = {_ms}. The PID responses to the load have smaller "
        f"peaks and return "
        "sooner than the PI responses; "
        + ("all are well damped." if _ms < 2.0 else "they swing below zero once or twice."),
        size=(7.4, 11.0),
    )(partial(draw, ms=_ms))
