"""What the table is used for in words."""

from replicate.exhibits import Finding
from replicate.loops import PID, Loop, Plant
from skogestad2003 import paper
from skogestad2003.table_1 import DEAD_TIME, TIME_CONSTANT, exact_loops

claims = paper.claims()

SECOND = 1.5  # the second time constant; any value cancels


@claims.claim(
    "second-order",
    r"The same margins apply to second-order processes if the derivative time is the second time constant.",
    where="Table 1",
)
def second_order() -> Finding:
    """Compare a second-order process under series PID control with the first-order one under PI control."""
    first = exact_loops()["first-order"]
    lags = [TIME_CONSTANT * SECOND, TIME_CONSTANT + SECOND, 1.0]
    gain, integral = first.controller.k, first.controller.ki
    # Kc (1 + 1/(tau_I s)) (1 + tau_D s), multiplied out
    controller = PID(k=gain + integral * SECOND, ki=integral, kd=gain * SECOND)
    second = Loop(Plant([1.0], lags, dead_time=DEAD_TIME), controller)
    difference = max(
        abs(second.margins().gain / first.margins().gain - 1.0),
        abs(second.margins().phase / first.margins().phase - 1.0),
        abs(second.sensitivity_peak().value / first.sensitivity_peak().value - 1.0),
    )
    verdict = "holds" if difference < 1e-9 else "fails"
    return Finding(
        verdict,
        second.margins().gain,
        f"The gain margin is {second.margins().gain:.4g} in both loops; gain margin, phase margin and sensitivity peak "
        f"agree to nine digits for a second time constant of {SECOND:g} dead times.",
    )
