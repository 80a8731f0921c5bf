"""The metrics of one loop of a sweep: each asked for is computed once, and what does not exist has a reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.sweep.metric_names import LOAD, MARGINS, OF_A_RESPONSE, OF_THE_LOOP, POLE, STABLE
from replicate.loops.time_domain.signal import Response

UNSTABLE = "the loop is unstable"


@dataclass
class LoopMetrics:
    """What a loop answered: values by name (those that do not exist are missing), and why others are missing."""

    stable: bool = False
    values: dict[str, Any] = field(default_factory=dict)
    reasons: list[str] = field(default_factory=list)

    @property
    def reason(self) -> str:
        """Why values are missing, on one line; empty if none is."""
        return "; ".join(dict.fromkeys(self.reasons))

    def ask(self, name: str, question: Callable[[], Any]) -> None:
        """Keep the answer to a question, or the reason why there is none."""
        try:
            self.values[name] = question()
        except LoopError as error:
            self.reasons.append(f"{name}: {error}")


def loop_metrics(
    plant: Plant, controller: PID, metrics: tuple[str, ...], until: float | None, band: float
) -> LoopMetrics:
    """Return the metrics of one loop.

    An unstable loop has a rightmost pole and nothing else, whatever the horizon.

    Parameters
    ----------
    metrics
        Checked names.
    until
        Horizon of the responses; by default each has its own, at which every mode has decayed to rounding.
    band
        Half-width of the settling band.
    """
    found = LoopMetrics()
    try:
        loop = Loop(plant, controller)
        found.stable = loop.is_stable()
    except LoopError as error:  # not proper, not well posed: no loop at all
        found.reasons.append(str(error))
        return found
    if POLE in metrics:
        found.ask(POLE, loop.rightmost_pole)
    if not found.stable:
        if set(metrics) - {POLE, STABLE}:
            found.reasons.insert(0, UNSTABLE)
        return found

    # margins and responses answer several questions: each is computed at the first one
    margins = lru_cache(maxsize=1)(loop.margins)

    @lru_cache(maxsize=2)
    def response(load: bool) -> Response:
        return loop.respond(setpoint=0.0 if load else 1.0, load=1.0 if load else 0.0, until=until)

    for name in metrics:
        if name in MARGINS:
            found.ask(name, lambda name=name: getattr(margins(), MARGINS[name]))  # type: ignore[misc]
        elif name in OF_THE_LOOP:
            found.ask(name, lambda name=name: OF_THE_LOOP[name](loop))  # type: ignore[misc]
        elif name not in {STABLE, POLE}:
            load, metric = name.startswith(LOAD), OF_A_RESPONSE[name.removeprefix(LOAD)]
            found.ask(name, lambda load=load, metric=metric: metric(response(load), band))  # type: ignore[misc]
    return found
