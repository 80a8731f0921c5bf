"""Every loop's answer to a unit load step: computed once in a process of the computer, read by many tables."""

from __future__ import annotations

from functools import cache

from replicate.loops import PID, Loop, Response
from replicate.papers.panagopoulos.part_2.processes import PLANTS


@cache
def load_experiment(process: str, controller: PID) -> Response:
    """Return output and control signal of one of the eight processes after a unit load step, until all has died out."""
    return Loop(PLANTS[process], controller).respond(setpoint=0.0, load=1.0)
