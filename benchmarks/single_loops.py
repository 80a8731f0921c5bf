"""One response and one design: time and error beside python-control, a method of steps by solve_ivp, and jitcdde."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import chdir
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from tempfile import TemporaryDirectory
from typing import Any

import control
import numpy as np
from scipy.integrate import solve_ivp

from benchmarks import exact_loop
from benchmarks.common import Table, open_loop, processor_time, seconds, times
from benchmarks.exact_loop import KI, K
from replicate.loops import PI, Loop, PIDDesign, Plant, Signal, design_pi, design_pid, step_responses

UNTIL = 40.0
TIMES = np.linspace(0.0, UNTIL, 4001)
CHECKED = TIMES[::40]
TOLERANCE = 1e-10
WHOLE = "Loop(...).step().overshoot()"
AIMS = {WHOLE: "20", "design_pi": "0.15", "design_pid": "1"}


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


def by_jitcdde() -> Callable[[], Any] | str:
    """Return a function that computes the response at all times by jitcdde, or why there is none."""
    if find_spec("jitcdde") is None:
        return "not installed"
    module, r = import_module("jitcdde"), import_module("symengine").Symbol("r")
    y, t = module.y, module.t
    # r is the set-point one dead time ago: zero at first
    equations = [K * (r - y(0, t - 1.0)) + KI * y(1, t - 1.0) - y(0), 1.0 - y(0)]
    compiled = module.jitcdde(equations, max_delay=1.0, control_pars=[r], verbose=False)
    try:
        with TemporaryDirectory() as elsewhere, chdir(elsewhere):  # setuptools would read our own pyproject.toml
            compiled.compile_C()
    except (Exception, SystemExit):  # noqa: BLE001  -- by which setuptools ends a program without a compiler
        return "does not compile here"

    def run() -> Any:
        compiled.purge_past()
        compiled.constant_past([0.0, 0.0], time=0.0)
        compiled.set_parameters(0.0)
        compiled.reset_integrator()
        compiled.set_integration_parameters(rtol=TOLERANCE, atol=TOLERANCE, first_step=1e-3)
        compiled.adjust_diff(shift_ratio=1e-12)
        values = []
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # several times lie in one of its steps
            for part in (TIMES[TIMES <= 1.0], TIMES[TIMES > 1.0]):
                values += [compiled.integrate(float(time))[0] for time in part]
                compiled.set_parameters(1.0)
                compiled.adjust_diff(shift_ratio=1e-12)
        return np.array(values)

    return run


def tables() -> list[Table]:
    """Return the tables of single loops."""
    reference = np.array([float(exact_loop.response(float(t))) for t in CHECKED])
    plant, controller = Plant.foptd(1.0, 1.0, 1.0), PI(K, KI)
    anchor = processor_time(by_control, 10)
    responses = Table(
        "One step response, 4001 points of (0.6 + 0.5/s) e^(-s)/(s + 1)",
        ("how", "processor time", "times as fast as python-control", "largest error"),
    )
    ways: list[tuple[str, Callable[[], Any] | str, int]] = [
        ("python-control, Pade 10", by_control, 5),
        ("method of steps by solve_ivp, 1e-10", by_steps, 2),
        ("jitcdde, 1e-10", by_jitcdde(), 2),
        ("replicate.loops", lambda: Loop(plant, controller).step(until=UNTIL)(TIMES), 30),
    ]
    for name, way, repeats in ways:
        if isinstance(way, str):
            responses.add(name, way, "", "")
            continue
        spent = anchor if way is by_control else processor_time(way, repeats)
        error = float(np.max(np.abs(np.asarray(way())[::40] - reference)))
        responses.add(name, seconds(spent), times(anchor / spent), f"{error:.1e}")

    return [responses, _questions(plant, controller), _designs(plant)]


def _questions(plant: Plant, controller: PI) -> Table:
    """Return what single questions cost, each beside the python-control call that answers it."""
    loop: Any = open_loop(K, KI, [1.0], [1.0, 1.0], 1.0)
    exact, gains = exact_loop.metrics(), [PI(K, KI * (1.0 + 1e-4 * i)) for i in range(1000)]
    reference = np.array([float(exact_loop.response(float(t))) for t in CHECKED])
    signal = Loop(plant, controller).step()
    lags = iter(1.0 + 1e-9 * i for i in range(10**6))

    def of_the_response(name: str) -> Callable[[], Any]:
        def ask() -> Any:
            fresh = Signal(signal.breaks, signal.coefficients, final=signal.final, stable=signal.stable)
            return float(fresh.peak().time) if name == "peak_time" else getattr(fresh, name)()

        return ask

    def of_the_loop(name: str) -> Callable[[], Any]:
        def ask() -> Any:
            return getattr(Loop(plant, controller), name)()

        return ask

    step_response = ("step_response", by_control)
    step_info = ("feedback + step_info", lambda: control.step_info(control.feedback(loop)))
    stability_margins = ("stability_margins", lambda: control.stability_margins(loop))
    poles = ("feedback + poles", lambda: control.feedback(loop).poles())

    def shown(value: Any, of: str) -> str:
        return f"{abs(value / exact[of] - 1.0):.1e}"

    margins = Loop(plant, controller).margins()
    worst = max(abs(margins.gain / exact["gain_margin"] - 1.0), abs(margins.phase / exact["phase_margin"] - 1.0))
    many = step_responses(plant, gains[:1], UNTIL)[0](CHECKED)
    rows: list[tuple[str, Callable[[], Any], float, tuple[str, Callable[[], Any]], str]] = [
        (WHOLE, lambda: Loop(plant, controller).step().overshoot(), 1, step_response,
         shown(signal.overshoot(), "overshoot")),
        ("the same, each loop of another plant",
         lambda: Loop(Plant.foptd(1.0, next(lags), 1.0), controller).step().overshoot(), 1, step_response,
         shown(signal.overshoot(), "overshoot")),
        ("each of 1000 in one step_responses", lambda: step_responses(plant, gains, UNTIL), 1000, step_response,
         f"{np.max(np.abs(many - reference)):.1e}"),
        *((f"{name} of a response", of_the_response(name), 1, step_info, shown(of_the_response(name)(), name))
          for name in ("overshoot", "peak_time", "settling_time", "rise_time", "iae")),
        ("sensitivity_peak", of_the_loop("sensitivity_peak"), 1, stability_margins,
         shown(Loop(plant, controller).sensitivity_peak().value, "ms")),
        ("margins", of_the_loop("margins"), 1, stability_margins, f"{worst:.1e}"),
        ("rightmost_pole", of_the_loop("rightmost_pole"), 1, poles,
         shown(Loop(plant, controller).rightmost_pole().real, "rightmost_pole")),
    ]  # fmt: skip
    table = Table(
        "One question about (0.6 + 0.5/s) e^(-s)/(s + 1), each beside python-control",
        ("question", "processor time", "beside it", "processor time", "times as quick", "aim", "largest error"),
    )
    beside: dict[str, float] = {}
    for name, ask, share, (other, anchor), error in rows:
        if other not in beside:
            beside[other] = processor_time(anchor, 7)
        spent = processor_time(ask, 2 if share > 1 else 30) / share
        ratio = times(beside[other] / spent)
        table.add(name, seconds(spent), other, seconds(beside[other]), ratio, AIMS.get(name, ""), error)
    return table


def _designs(plant: Plant) -> Table:
    anchor = processor_time(by_control, 10)
    table = Table(
        "Designs with Ms = 1.4, each beside one python-control step_response",
        ("design", "processor time", "share of one step_response", "aim: at most", "error of Ms"),
    )
    for name, design in (("design_pi", design_pi), ("design_pid", design_pid)):
        spent = processor_time(partial(design, plant, ms=1.4), 20)
        found = design(plant, ms=1.4)
        reached = exact_loop.sensitivity_peak(found.k, found.ki, found.kd if isinstance(found, PIDDesign) else 0.0)
        table.add(name, seconds(spent), times(spent / anchor), AIMS[name], f"{abs(reached - 1.4):.1e}")
    return table
