"""The authors' computation, as far as the printed digits reveal it.

The printed times are whole multiples of a step that belongs to each row. That step follows from a rule:
simulate the loop with the second-order Padé dead time (7) over the time in which its dominant mode decays to
2 %, twice over, on 1000 intervals; if the response settles in the first half, once more over 1.1 times the
settling time just read. The metrics are samples; nothing is interpolated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

from replicate.loops import PI
from replicate.loops.emulation import SampledResponse, StateSpace, dominant_pole, pade_loop, sampled_step
from replicate.papers.bayhan.processes import SPECIFICATIONS, Process


@dataclass(frozen=True)
class SampleGrid:
    """On which instants a response is sampled.

    Attributes
    ----------
    steps
        The number of intervals.
    decays
        The horizon, in times that the dominant mode takes to decay to 2 %.
    again
        The horizon of a second look at a response that settles in the first half, in settling times; 0: none is taken.
    """

    steps: int = 1000
    decays: float = 2.0
    again: float = 1.1


AUTHORS_GRID = SampleGrid()
GRIDS_TRIED: dict[str, tuple[float, ...]] = {
    "samples": (500, 1000, 2000),
    "horizon": (1.5, 2.0, 2.5, 3.0),
    "second look": (0.0, 1.0, 1.1, 1.2),
}


@cache
def _pade_loop(process: Process, k: float, ki: float) -> tuple[StateSpace, float]:
    """Return the loop with the Padé dead time (7), and how fast its dominant mode decays."""
    loop = pade_loop(process.plant, PI(k=k, ki=ki), order=2)
    return loop, -dominant_pole(loop).real


@cache
def sampled_response(process: Process, k: float, ki: float, grid: SampleGrid = AUTHORS_GRID) -> SampledResponse | None:
    """Return the unit step response on the samples of a grid; ``None`` if the Padé loop is unstable."""
    loop, decay = _pade_loop(process, k, ki)
    if decay <= 0.0:
        return None
    response = sampled_step(loop, grid.decays * math.log(50.0) / decay, grid.steps)
    if grid.again and response.settling_index() < grid.steps // 2:
        response = sampled_step(loop, grid.again * response.settling_time(), grid.steps)
    return response


def sampled_specifications(process: Process, controller: PI, grid: SampleGrid = AUTHORS_GRID) -> dict[str, float]:
    """Return overshoot (a fraction) and times as samples of a grid; ``nan`` if unstable."""
    response = sampled_response(process, controller.k, controller.ki, grid)
    if response is None:
        return dict.fromkeys(SPECIFICATIONS, math.nan)
    return {
        "overshoot": response.overshoot(),
        "settling_time": response.settling_time(),
        "delay_time": response.delay_time(),
        "rise_time": response.rise_time(),
    }
