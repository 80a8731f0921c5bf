"""The loops of the eight processes and their answers to a unit load step: made once in a process of the computer."""

from __future__ import annotations

from functools import cache, lru_cache

from replicate.loops import PID, Loop, Response
from replicate.papers.panagopoulos.part_2.processes import PLANTS

MOST_LOOPS = 2000  # those of a table's printed gains and what rounds to them


@lru_cache(MOST_LOOPS)
def loop_of(process: str, controller: PID) -> Loop:
    """Return one of the eight processes under a controller; what it has been asked it knows, for other readings too."""
    return Loop(PLANTS[process], controller)


@cache
def load_experiment(process: str, controller: PID) -> Response:
    """Return output and control signal of one of the eight processes after a unit load step, until all has died out."""
    return loop_of(process, controller).respond(setpoint=0.0, load=1.0)
