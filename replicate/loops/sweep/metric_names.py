"""What a sweep can be asked for, and how one loop answers.

The names are data: a metric of the set-point response, the same with ``load_`` of the load response, or of the loop.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.loop import Loop
from replicate.loops.time_domain.signal import Response
from replicate.loops.time_domain.total_variation import total_variation

LOAD = "load_"


#: Metrics of a response, given the half-width of the settling band.
OF_A_RESPONSE: dict[str, Callable[[Response, float], float]] = {
    "overshoot": lambda response, _: response.output.overshoot(),
    "peak": lambda response, _: float(response.output.peak()),
    "peak_time": lambda response, _: response.output.peak().time,
    "settling_time": lambda response, band: response.output.settling_time(band),
    "rise_time": lambda response, _: response.output.rise_time(),
    "delay_time": lambda response, _: response.output.delay_time(),
    "iae": lambda response, _: response.output.iae(),
    "ise": lambda response, _: response.output.ise(),
    "ie": lambda response, _: response.output.ie(),
    "itae": lambda response, _: response.output.itae(),
    "itse": lambda response, _: response.output.itse(),
    "total_variation": lambda response, _: total_variation(response.control),
    "last_above": lambda response, band: response.output.last_crossing(band),
}

#: Metrics of the loop itself; an unstable loop has a rightmost pole, but none of the others.
OF_THE_LOOP: dict[str, Callable[[Loop], float]] = {
    "ms": lambda loop: loop.sensitivity_peak().value,
    "mp": lambda loop: loop.complementary_peak().value,
    "ms_frequency": lambda loop: loop.sensitivity_peak().frequency,
    "mp_frequency": lambda loop: loop.complementary_peak().frequency,
}

#: Attributes of the margins.
MARGINS = {"gain_margin": "gain", "phase_margin": "phase", "delay_margin": "delay"}

STABLE, POLE = "stable", "rightmost_pole"

#: Asked for by the package alone: the last time at which a load response is above the band, and where peaks are.
OWN = ("last_above", LOAD + "last_above", "ms_frequency", "mp_frequency")

ALLOWED: tuple[str, ...] = tuple(
    name
    for name in (*OF_A_RESPONSE, *(LOAD + name for name in OF_A_RESPONSE), *OF_THE_LOOP, *MARGINS, POLE, STABLE)
    if name not in OWN
)


def checked_metrics(names: str | Iterable[str]) -> tuple[str, ...]:
    """Return the names of metrics, each once, in the order given.

    Raises
    ------
    LoopError
        If there is none, or one is unknown; the message lists those that are allowed.
    """
    allowed = f"names of metrics: {', '.join(ALLOWED)}"
    given = [names] if isinstance(names, str) else checks.several("metrics", names, allowed)
    if not given:
        msg = f"metrics must name at least one of {', '.join(ALLOWED)}"
        raise LoopError(msg)
    for name in given:
        if not isinstance(name, str) or name not in ALLOWED:
            msg = f"unknown metric {checks.shown(name)}: allowed are {', '.join(ALLOWED)}"
            raise LoopError(msg)
    return tuple(dict.fromkeys(given))
