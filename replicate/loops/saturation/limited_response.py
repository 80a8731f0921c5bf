"""The response of a loop whose control signal has limits, with and without anti-windup, exact to rounding."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.inputs import Input, Sine
from replicate.loops.saturation.anti_windup import (
    FREE,
    AntiWindup,
    LimitedController,
    checked_anti_windup,
    checked_limits,
)  # fmt: skip
from replicate.loops.saturation.limited_steps import Jump, LimitedSteps
from replicate.loops.time_domain.piece_flow import Row
from replicate.loops.time_domain.signal import Response, Signal
from replicate.loops.time_domain.slow_modes import SETTLED

if TYPE_CHECKING:
    from replicate.loops.loop import Loop

AT_LIMIT = 1e-12  # relative distance of a control signal from its limit that is rounding
MOST_EXTENSIONS = 40  # of the horizon, before a loop counts as one that never comes to rest
Place = Literal["within", "at a limit", "beyond"]  # of a control signal at rest
Given = float | Input | Sequence[Input]


@dataclass(frozen=True)
class AtLimit:
    """An interval of time during which the control signal is at a limit."""

    start: float
    end: float
    limit: float


@dataclass(frozen=True)
class LimitedResponse(Response):
    """Output and control signal of a loop whose control signal has limits.

    Attributes
    ----------
    command
        What the controller asks for; the control signal is the command within the limits.
    at_limit
        The intervals during which the control signal is at a limit, in order of time.
    """

    command: Signal
    at_limit: tuple[AtLimit, ...]


class LimitedViews:
    """Methods of `Loop` that answer what limits of the control signal do."""

    @property
    def _loop(self) -> Loop:
        return cast("Loop", self)

    def saturated(
        self,
        limits: tuple[float, float],
        anti_windup: AntiWindup = "none",
        *,
        tracking_time: float | None = None,
        setpoint: Given = 1.0,
        load: Given = 0.0,
        load_at: float = 0.0,
        until: float | None = None,
    ) -> LimitedResponse:
        r"""Return the exact response when the control signal has limits, with or without anti-windup.

        The instants at which the command meets or leaves a limit are found as roots of the response's polynomials;
        between them the loop is linear and computed as without limits.

        Parameters
        ----------
        limits
            The least and the largest control signal, before any load; 0, its value at rest, must be between them.
            ``inf`` and ``-inf`` mean no limit.
        anti_windup
            ``"none"``; ``"back-calculation"``: :math:`\dot I = k_i e + (u - v)/T_t`, v being the command and u the
            control signal; or ``"clamping"``: the integral part is held while v is beyond a limit and the error would
            drive it further.
        tracking_time
            Tt of back-calculation; by default Ti of a PI and the geometric mean of Ti and Td of a PID controller.
        setpoint, load
            Numbers (steps), or steps and pulses of `replicate.loops.inputs`, or several.
        load_at
            Time that is added to the load's own.
        until
            Horizon; by default the time at which the loop has come to rest.

        Raises
        ------
        LoopError
            If an argument is not allowed, the plant is given by a function, an ideal derivative acts on a set-point
            step, or the loop does not come to rest and no horizon is given.
        UnstableLoopError
            If no horizon is given and the loop without limits is unstable.

        Examples
        --------
        An integrator filled at its limit of 1/2 rises by 1/2 in each unit of time:

        >>> from replicate.loops import PI, Loop, Plant
        >>> loop = Loop(Plant([1.0], [1.0, 0.0]), PI(2.0))
        >>> response = loop.saturated(limits=(-0.5, 0.5))
        >>> round(float(response.output(1.0)), 12), [round(x.end, 12) for x in response.at_limit]
        (0.5, [1.5])
        """
        loop = self._loop
        low, high = checked_limits(limits)
        scheme, tracking = checked_anti_windup(anti_windup, tracking_time, loop.primary_controller)
        load_at = checks.non_negative("load_at", load_at, allowed="a time >= 0")
        setpoints, loads = _jumps("setpoint", setpoint, 0.0), _jumps("load", load, load_at)
        if until is not None:
            until = checks.positive("the horizon until", until, allowed="a finite time > 0")
        if not loop.plant.parts:
            msg = "limits of the control signal need a rational plant with dead times, not one given by a function"
            raise LoopError(msg)
        units, parts = loop.open_loop()
        chain, g = parts.chain, parts.gains
        if g[3] * chain.setpoint_impulse and setpoints:
            msg = "an ideal derivative of a set-point step has no limited response: give derivative_filter > 0 or c = 0"
            raise LoopError(msg)
        limited = LimitedController(
            chain, Row(g @ chain.wx, g @ chain.wv, float(g @ chain.wr)),
            (low * units.gain, high * units.gain), scheme, tracking / units.time,
        )  # fmt: skip
        steps = LimitedSteps(
            limited, parts.delays, parts.loaded,
            [(time / units.time, value) for time, value in setpoints],
            [(time / units.time, value * units.gain) for time, value in loads],
            units.time,
        )  # fmt: skip
        last = max([0.0, *(time for time, _ in [*setpoints, *loads])])
        final_y, final_u, place = _steady_state(loop, setpoints, loads, (low, high))
        with np.errstate(over="ignore", invalid="ignore"):
            if until is not None:
                steps.run(until / units.time)
            else:
                _run_to_rest(loop, steps, last, units.time, place)
        breaks = np.array(steps.breaks) * units.time

        def signal(pieces: list[np.ndarray], unit: float, final: float) -> Signal:
            return Signal(breaks, np.array(pieces) / unit, final=final, stable=loop.is_stable)

        return LimitedResponse(
            signal(steps.output, 1.0, final_y),
            signal(steps.control, units.gain, final_u),
            signal(steps.command, units.gain, final_u if place == "within" else float("nan")),
            _intervals(steps, breaks.tolist(), (low, high)),
        )


def _jumps(name: str, given: Given, at: float) -> list[Jump]:
    """Return the times at which a piecewise constant input jumps, and its new values."""
    if isinstance(given, Input):
        inputs: list[Input] = [given]
    elif isinstance(given, list | tuple) and all(isinstance(item, Input) for item in given):
        inputs = list(given)
    else:
        height = checks.finite(f"the {name}", given, allowed="a finite number, or steps and pulses")
        return [(at, height)] if height else []
    if any(isinstance(item, Sine) or any(order for _, order, _ in item.events()) for item in inputs):
        msg = f"under limits the {name} must be piecewise constant: a number, Step or Pulse, not {checks.shown(given)}"
        raise LoopError(msg)
    events = sorted((at + time, height) for item in inputs if not isinstance(item, Sine)
                    for time, _, height in item.events())  # fmt: skip
    found, value = [], 0.0
    for time, together in groupby(events, key=lambda event: event[0]):
        value += sum(height for _, height in together)
        found.append((time, value))
    return found


def _steady_state(
    loop: Loop, setpoints: list[Jump], loads: list[Jump], limits: tuple[float, float]
) -> tuple[float, float, Place]:
    """Return the final output and control signal, and where between its limits the latter is."""
    setpoint, load = (jumps[-1][1] if jumps else 0.0 for jumps in (setpoints, loads))
    output, control = loop.steady_state(setpoint, load)
    low, high = limits
    if any(abs(control - limit) <= AT_LIMIT * abs(limit) for limit in limits if np.isfinite(limit)):
        return output, control, "at a limit"
    if not control > high and not control < low:
        return output, control, "within"
    stuck = high if control > high else low
    return (loop.plant.gain * (stuck + load) if np.isfinite(loop.plant.gain) else float("nan")), stuck, "beyond"


def _run_to_rest(loop: Loop, steps: LimitedSteps, last: float, unit: float, place: Place) -> None:
    """March until the loop has been in one mode for as long as its slowest mode needs to decay."""
    settling = loop.horizon()
    rates = -loop.plant.poles().real
    may_stay = place != "within" and bool(np.all(rates > 0.0))
    if place == "beyond" and not may_stay:
        msg = "the control signal stays at its limit and the plant does not settle there: give a horizon until=..."
        raise LoopError(msg)
    if may_stay:
        longest = max(part.dead_time for part in loop.plant.parts)
        settling = max(settling, SETTLED / float(np.min(rates, initial=np.inf)) + longest)
    end = last + settling
    for _ in range(MOST_EXTENSIONS):
        steps.run(end / unit)
        needed = steps.last_change * unit + settling
        if needed <= end and (steps.mode == FREE or may_stay):
            return
        end = max(needed, end + (settling if steps.mode != FREE else 0.0))
    msg = f"the loop has not come to rest by t = {end:g}: give a horizon until=..."
    raise LoopError(msg)


def _intervals(steps: LimitedSteps, breaks: list[float], limits: tuple[float, float]) -> tuple[AtLimit, ...]:
    found = []
    index = 0
    for side, pieces in groupby(steps.modes, key=lambda mode: mode.side):
        count = len(list(pieces))
        if side:
            found.append(AtLimit(breaks[index], breaks[index + count], limits[1] if side > 0 else limits[0]))
        index += count
    return tuple(found)
