"""One response and one design: time and error beside python-control, a method of steps by solve_ivp, and jitcdde."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import control
import numpy as np
from scipy.integrate import solve_ivp

from benchmarks import exact_loop
from benchmarks.common import Table, open_loop, processor_time, seconds, times
from benchmarks.exact_loop import KI, K
from replicate.loops import PI, Loop, Plant, design_pi, design_pid

UNTIL = 40.0
TIMES = np.linspace(0.0, UNTIL, 4001)
CHECKED = TIMES[::40]
TOLERANCE = 1e-10


def by_control() -> Any:
    """Return the response at all times by python-control."""
    loop = control.feedback(open_loop(K, KI, [1.0], [1.0, 1.0], 1.0))
    return np.asarray(control.step_response(loop, TIMES).outputs)


def by_steps() -> Any:
    """Return the response at all times by the method of steps, one solve_ivp for each dead time."""

    def control_signal(state: Any) -> Any:
        return K * (1.0 - state[0]) + KI * state[1]

    state, values = np.zeros(2), np.zeros(TIMES.size)
    before: Callable[[float], Any] | None = None
    for n in range(int(UNTIL)):

        def slope(t: float, x: Any, earlier: Callable[[float], Any] | None = before) -> list[float]:
            delayed = control_signal(earlier(t - 1.0)) if earlier is not None else 0.0
            return [delayed - x[0], 1.0 - x[0]]

        found = solve_ivp(
            slope, (n, n + 1.0), state, rtol=TOLERANCE, atol=TOLERANCE, method="DOP853", dense_output=True
        )
        here = np.clip(TIMES, n, n + 1.0) == TIMES
        before = found.sol
        values[here] = found.sol(TIMES[here])[0]  # type: ignore[misc]  # asked for
        state = found.y[:, -1]
    return values


def by_jitcdde() -> Callable[[], Any] | None:
    """Return a function that computes the response at all times by jitcdde, or None if it is not installed."""
    if find_spec("jitcdde") is None:
        return None
    module = import_module("jitcdde")
    y, t = module.y, module.t
    equations = [K * (1.0 - y(0, t - 1.0)) + KI * y(1, t - 1.0) - y(0), 1.0 - y(0)]
    compiled = module.jitcdde(equations, max_delay=1.0)

    def run() -> Any:
        compiled.purge_past()
        # before the step the control signal is zero: y = 1 and no integral
        compiled.constant_past([1.0, 0.0])
        compiled.set_integration_parameters(rtol=TOLERANCE, atol=TOLERANCE)
        compiled.step_on_discontinuities()
        return np.array([compiled.integrate(float(max(t, compiled.t)))[0] for t in TIMES])

    return run


def tables() -> list[Table]:
    """Return the tables of single loops."""
    reference = np.array([float(exact_loop.response(float(t))) for t in CHECKED])
    plant, controller = Plant.foptd(1.0, 1.0, 1.0), PI(K, KI)
    anchor = processor_time(by_control, 5)
    responses = Table(
        "One step response, 4001 points of (0.6 + 0.5/s) e^(-s)/(s + 1)",
        ("how", "processor time", "times as fast as python-control", "largest error"),
    )
    ways: list[tuple[str, Callable[[], Any] | None, int]] = [
        ("python-control, Pade 10", by_control, 5),
        ("method of steps by solve_ivp, 1e-10", by_steps, 2),
        ("jitcdde, 1e-10", by_jitcdde(), 2),
        ("replicate.loops", lambda: Loop(plant, controller).step(until=UNTIL)(TIMES), 30),
    ]
    for name, way, repeats in ways:
        if way is None:
            responses.add(name, "not installed", "", "")
            continue
        spent = anchor if way is by_control else processor_time(way, repeats)
        error = float(np.max(np.abs(np.asarray(way())[::40] - reference)))
        responses.add(name, seconds(spent), times(anchor / spent), f"{error:.1e}")

    whole = Table(
        "Whole questions, each beside one python-control step_response",
        ("question", "processor time", "share of one step_response", "error"),
    )
    exact = exact_loop.metrics()["overshoot"]
    spent = processor_time(lambda: Loop(plant, controller).step().overshoot(), 30)
    error = abs(Loop(plant, controller).step().overshoot() - exact)
    whole.add("Loop(...).step().overshoot()", seconds(spent), f"1/{anchor / spent:.3g}", f"{error:.1e}")
    for name, design in (("design_pi", design_pi), ("design_pid", design_pid)):
        spent = processor_time(partial(design, plant, ms=1.4), 5)
        found = design(plant, ms=1.4)
        reached = Loop(plant, found.controller).sensitivity_peak().value if name == "design_pid" else None
        reached = Loop(plant, PI(found.k, found.ki)).sensitivity_peak().value if reached is None else reached
        whole.add(f"{name}, Ms = 1.4", seconds(spent), times(spent / anchor), f"{abs(reached - 1.4):.1e} of Ms")
    return [responses, whole]
