"""The response of a loop to any input of `replicate.loops.inputs`, by Duhamel's principle from its step responses.

Polynomial inputs are answered by repeated integrals of the step response, a sine by one spectral integral of it; both
are as exact as the step response itself. A disturbance at the output, and noise on the measurement, are answered by the
loop whose set-point takes the way of the measurement: b = c = 1, the measurement filter in front.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import reduce

import numpy as np

from replicate.loops import checks
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.inputs import Event, Input, Sine, Step
from replicate.loops.loop import Loop
from replicate.loops.numerics import chebyshev
from replicate.loops.time_domain.signal import Response, Signal

DEGREE = 26  # of the pieces of a response to a sine,
ANGLE = 2.0  # each of which is at most so long, in rad
CANCELLED = 1e-12  # size of a power of t, relative to its parts, that has ended

Given = float | Input | Sequence[Input]


def respond_to(
    loop: Loop,
    *,
    setpoint: Given = 0.0,
    load: Given = 0.0,
    output: Given = 0.0,
    noise: Given = 0.0,
    until: float | None = None,
) -> Response:
    """Return output and control signal for the given set-point and disturbances.

    Parameters
    ----------
    setpoint, load, output, noise
        A number (a step at t = 0), an input, or several to be added: the set-point, a load at the plant input, a
        disturbance of the output, and noise on its measurement.
    until
        Horizon; by default the last event plus the time in which every mode of the loop decays.

    Returns
    -------
    Response
        The output contains the disturbance of the output, not the noise.

    Raises
    ------
    LoopError
        If something is not an input, or a sine is given without a horizon.
    UnstableLoopError
        If no horizon is given and the loop is unstable.

    Examples
    --------
    Integral action makes a ramp's error constant, 1/ki for a plant of unit gain:

    >>> from replicate.loops import PI, Plant
    >>> from replicate.loops.inputs import Ramp
    >>> loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5))
    >>> y = respond_to(loop, setpoint=Ramp(1.0), until=60.0).output
    >>> round(60.0 - float(y(60.0)), 9)
    2.0
    """
    given = {name: _inputs(name, value) for name, value in
             (("setpoint", setpoint), ("load", load), ("output", output), ("noise", noise))}  # fmt: skip
    end = _end(loop, [item for items in given.values() for item in items], until)
    rest = _constant(0.0, end, loop.is_stable)
    y, u = [rest], [rest]
    for name, items in given.items():
        if not items:
            continue
        step = _step(loop, name, end)
        for item in items:
            y.append(_answer(step.output, item, end))
            u.append(_answer(step.control, item, end))
            if name == "output":
                y.append(_answer(_constant(1.0, end), item, end))
    return Response(reduce(Signal.__add__, y), reduce(Signal.__add__, u))


def _inputs(name: str, value: object) -> list[Input]:
    if isinstance(value, Input):
        return [value]
    if isinstance(value, Sequence) and all(isinstance(item, Input) for item in value):
        return list(value)
    height = checks.finite(f"the {name}", value, allowed="a number or inputs such as Step, Ramp, Sine")
    return [Step(height)] if height else []


def _end(loop: Loop, items: list[Input], until: float | None) -> float:
    if until is not None:
        return checks.positive("the horizon", until, allowed="positive and finite")
    if any(isinstance(item, Sine) for item in items):
        msg = "the response to a sine does not end: give a horizon, until=..."
        raise LoopError(msg)
    last = max((at for item in items if not isinstance(item, Sine) for at, _, _ in item.events()), default=0.0)
    return last + loop.horizon()


def _step(loop: Loop, name: str, end: float) -> Response:
    """Return the response to a unit step; of the output disturbance without that itself."""
    if name == "setpoint":
        return loop.respond(until=end)
    if name == "load":
        return loop.respond(setpoint=0.0, load=1.0, until=end)
    response = loop.with_primary(_by_measurement(loop.primary_controller)).respond(until=end)
    return Response(response.output * -1.0, response.control * -1.0)


def _by_measurement(controller: PID) -> PID:
    """Return the controller whose set-point takes the way of the measurement."""
    num, den = controller.measurement_filter_polynomials()
    plain = {name: getattr(controller, name) for name in controller.__dataclass_fields__}
    same_way = (tuple(num.tolist()), tuple(den.tolist())) if den.size > 1 or num[0] != 1.0 else 0.0
    return PID(**(plain | {"b": 1.0, "c": 1.0, "setpoint_filter": same_way}))


def _answer(step: Signal, item: Input, end: float) -> Signal:
    if isinstance(item, Sine):
        return _cut(_to_sine(step, item), end, final=float("nan"))
    events = item.events()
    parts = [_to_event(step, event) for event in events if event[0] < end]
    total = reduce(Signal.__add__, parts) if parts else step * 0.0
    return _cut(total, end, final=_final(step, events))


def _to_event(step: Signal, event: Event) -> Signal:
    at, order, height = event
    signal = step
    for _ in range(order):
        signal = signal.antiderivative()
    return (signal * height).delayed(at)


def _final(step: Signal, events: list[Event]) -> float:
    """Return the final value where the input ends constant, else nan."""
    left = 0.0
    highest = max(order for _, order, _ in events)
    for power in range(highest, -1, -1):  # what is left of each power of t after the last event
        parts = [
            height * math.comb(order, power) * (-at) ** (order - power) / math.factorial(order)
            for at, order, height in events
            if order >= power
        ]
        left = math.fsum(parts)
        if power and abs(left) > CANCELLED * sum(map(abs, parts)):
            return float("nan")
    return left * step.final


def _cut(signal: Signal, end: float, final: float) -> Signal:
    cut = signal + _constant(0.0, end)
    return type(cut)(cut.breaks, cut.coefficients, final=final, stable=signal.stable)


def _constant(value: float, end: float, stable: Callable[[], bool] | None = None) -> Signal:
    return Signal(np.array([0.0, end]), np.array([[value, 0.0]]), final=value, stable=stable)


def _to_sine(step: Signal, sine: Sine) -> Signal:
    r"""Return :math:`a [\sin\varphi\, s(t) + w \int_0^t s(\tau) \cos(w(t-\tau)+\varphi)\, d\tau]`."""
    w = sine.frequency
    pieces = np.maximum(1, np.ceil(np.diff(step.breaks) * w / ANGLE)).astype(int)
    ends = [np.linspace(a, b, n + 1)[1:] for a, b, n in zip(step.breaks[:-1], step.breaks[1:], pieces, strict=True)]
    mesh = np.concatenate([[0.0], *ends])
    fine = step + Signal(mesh, np.zeros((mesh.size - 1, DEGREE + 1)))  # the same function on the finer mesh
    half = 0.5 * np.diff(fine.breaks)
    t = fine.breaks[:-1, None] + half[:, None] * (chebyshev.nodes(DEGREE) + 1.0)
    value = fine.coefficients @ chebyshev.evaluation(DEGREE, DEGREE + 1)
    turning = value * np.exp(-1j * w * t)
    inner = (turning @ chebyshev.integration(DEGREE).T) * half[:, None]
    running = inner + np.concatenate([[0.0], np.cumsum(inner[:-1, -1])])[:, None]
    answer = np.sin(sine.phase) * value + w * (np.exp(1j * (w * t + sine.phase)) * running).real
    coefficients = sine.amplitude * answer @ chebyshev.values_to_coefficients(DEGREE).T
    return Signal(fine.breaks, coefficients, stable=step.stable).delayed(sine.at)
