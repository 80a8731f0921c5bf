"""What the table is used for in words."""

import numpy as np

from replicate.exhibits import Finding
from replicate.loops import PID, Loop, Plant
from skogestad2003 import paper
from skogestad2003.table_1 import DEAD_TIME, TIME_CONSTANT, exact_loops

claims = paper.claims()

SECOND = (0.1, 1.5, 4.0, 10.0)  # second time constants, in dead times; any value cancels
LAGS = {"first-order": [TIME_CONSTANT, 1.0], "integrating": [1.0, 0.0]}


@claims.claim(
    "second-order",
    r"The same margins apply to second-order processes if the derivative time is the second time constant.",
    where="Table 1",
)
def second_order() -> Finding:
    """Compare processes with a second lag under series PID control with those of the table under PI control."""
    differences = [
        abs(ours / theirs - 1.0)
        for name, loop in exact_loops().items()
        for second in SECOND
        for ours, theirs in zip(_margins(_with_lag(name, loop, second)), _margins(loop), strict=True)
    ]
    verdict = "holds" if max(differences) < 1e-9 else "fails"
    gain_margin = _with_lag("first-order", exact_loops()["first-order"], SECOND[0]).margins().gain
    return Finding(
        verdict,
        gain_margin,
        f"The gain margin is {gain_margin:.4g} with a second lag, too. Margins and peaks of both processes with "
        f"{len(SECOND)} second time constants, {min(SECOND):g} to {max(SECOND):g} dead times, agree with those of the "
        "table to nine digits: the second time constant cancels.",
    )


def _with_lag(name: str, loop: Loop, second: float) -> Loop:
    """Close the loop around the process with a second lag, the derivative time of the series form being its time."""
    controller = PID.series(loop.controller.k, loop.controller.integral_time, second)
    return Loop(Plant([1.0], np.polymul(LAGS[name], [second, 1.0]), dead_time=DEAD_TIME), controller)


def _margins(loop: Loop) -> tuple[float, ...]:
    margins = loop.margins()
    peaks = loop.sensitivity_peak().value, loop.complementary_peak().value
    return margins.gain, margins.phase, margins.delay, *peaks
