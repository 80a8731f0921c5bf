"""The authors' computation, as far as the printed digits reveal it.

The printed times are whole multiples of a step that belongs to each row. That step follows from a rule:
simulate the loop with the second-order Padé dead time (7) over the time in which its dominant mode decays to
2 %, twice over, on 1000 intervals; if the response settles in the first half, once more over 1.1 times the
settling time just read. The metrics are samples; nothing is interpolated.
"""

from __future__ import annotations

import math
from functools import cache

from replicate.loops import PI
from replicate.loops.emulation import SampledResponse, dominant_pole, pade_loop, sampled_step
from replicate.papers.bayhan.processes import SPECIFICATIONS, Process

STEPS = 1000


@cache
def sampled_response(process: Process, k: float, ki: float) -> SampledResponse | None:
    """Return the unit step response on the authors' grid; ``None`` if the Padé loop is unstable."""
    loop = pade_loop(process.plant, PI(k=k, ki=ki), order=2)
    decay = -dominant_pole(loop).real
    if decay <= 0.0:
        return None
    response = sampled_step(loop, 2.0 * math.log(50.0) / decay, STEPS)
    if response.settling_index() < STEPS // 2:
        response = sampled_step(loop, 1.1 * response.settling_time(), STEPS)
    return response


def sampled_specifications(process: Process, controller: PI) -> dict[str, float]:
    """Return overshoot (a fraction) and times as samples of the authors' grid; ``nan`` if unstable."""
    response = sampled_response(process, controller.k, controller.ki)
    if response is None:
        return dict.fromkeys(SPECIFICATIONS, math.nan)
    return {
        "overshoot": response.overshoot(),
        "settling_time": response.settling_time(),
        "delay_time": response.delay_time(),
        "rise_time": response.rise_time(),
    }
