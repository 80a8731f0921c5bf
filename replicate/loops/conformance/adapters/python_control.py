"""python-control: the dead time becomes a Padé approximation, of order 1 to 10 side by side.

Only public functions of the library are used, as its documentation shows them: `pade`, `feedback`, `stability_margins`,
`forced_response`, `step_info`.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, partial
from typing import Any

import numpy as np

from replicate.loops.conformance.goldens import Golden
from replicate.loops.conformance.library import Library

Value = float | complex
SAMPLES = 11  # a step response is exact at its samples, however few


class _PythonControl:
    @property
    def title(self) -> str:
        import control

        return f"python-control {control.__version__}"

    @property
    def settings(self) -> Sequence[str]:
        return tuple(f"Padé {order}" for order in range(1, 11))

    def values(self, golden: Golden, setting: str) -> Mapping[str, Value]:
        found: dict[str, Value] = {}
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            for name, ask in _questions(golden, int(setting.rsplit(maxsplit=1)[-1])):
                try:
                    found[name] = ask()
                except Exception:  # noqa: BLE001  -- whatever a library raises, the value is missing
                    found[name] = float("nan")
        return found


def _questions(golden: Golden, order: int) -> Iterator[tuple[str, Callable[[], Value]]]:
    import control

    systems = cache(lambda: _systems(golden, order))
    poles = cache(lambda: _upper_half(systems()[1].poles()))
    yield "stable", lambda: float(bool(np.all(systems()[1].poles().real < 0.0)))
    for index in range(len(golden.record["poles"])):
        yield f"pole {index + 1}", partial(_element, poles, index)
    if golden.stable:
        margins = cache(lambda: control.stability_margins(systems()[0]))
        yield "sensitivity_peak", lambda: 1.0 / margins()[2]
        yield "gain_margin", lambda: margins()[0]
        yield "phase_margin", lambda: margins()[1]
        yield "delay_margin", lambda: math.radians(margins()[1]) / margins()[4]
    for t in golden.times:
        yield f"step({t:g})", partial(_value, systems, 1, t)
        yield f"load_step({t:g})", partial(_value, systems, 2, t)
    if "metrics" in golden.record:
        info = cache(lambda: control.step_info(systems()[1]))
        yield "overshoot", lambda: info()["Overshoot"] / 100.0
        yield "peak_time", lambda: info()["PeakTime"]
        yield "rise_time", lambda: info()["RiseTime"]
        yield "settling_time", lambda: info()["SettlingTime"]


def _upper_half(poles: Any) -> list[complex]:
    return sorted((p for p in poles if p.imag >= -1e-9 * abs(p)), key=lambda p: (-p.real, p.imag))


def _element(poles: Callable[[], list[complex]], index: int) -> complex:
    return complex(poles()[index])


def _systems(golden: Golden, order: int) -> tuple[Any, Any, Any]:
    """Return the open loop, and the closed loop from the set-point and from the load to the output."""
    import control

    plant, x = golden.record["plant"], golden.record["controller"]
    process = control.tf(plant["num"], plant["den"])
    if plant["dead_time"]:
        process *= control.tf(*control.pade(plant["dead_time"], order))
    lag = [x["derivative_filter"], 1.0] if x["derivative_filter"] else [1.0]
    integral = [1.0, 0.0] if x["ki"] else [1.0]
    below = np.polymul(integral, lag)

    def numerator(k: float, kd: float) -> Any:
        part = np.polymul([k, x["ki"]] if x["ki"] else [k], lag)
        return np.polyadd(part, np.polymul([kd, 0.0], integral)) if kd else part

    num, den = process.num[0][0], process.den[0][0]
    feedback = numerator(x["k"], x["kd"])
    characteristic = np.polyadd(np.polymul(den, below), np.polymul(num, feedback))
    forward = numerator(x["b"] * x["k"], x["c"] * x["kd"])
    return (
        control.tf(np.polymul(num, feedback), np.polymul(den, below)),
        control.ss(control.tf(np.polymul(num, forward), characteristic)),
        control.ss(control.tf(np.polymul(num, below), characteristic)),
    )


def _value(systems: Callable[[], tuple[Any, Any, Any]], which: int, t: float) -> float:
    import control

    times = np.linspace(0.0, t, SAMPLES)
    return float(control.forced_response(systems()[which], times, np.ones(SAMPLES)).outputs[-1])


def library() -> Library:
    """Return the adapter."""
    return _PythonControl()
