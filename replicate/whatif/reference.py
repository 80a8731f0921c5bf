"""What Python computes for the page: the loop of its self-test, and the optimal controllers of a plant."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from replicate.loops import PI, PID, Loop, Plant, design_pi
from replicate.loops.errors import LoopError
from replicate.loops.notation import parse_controller, parse_plant
from replicate.loops.tune import ziegler_nichols

#: The loop with which the page tests itself: second order, with dead time, derivative filter and set-point weight.
REFERENCE = ("e^{-0.7s}/((s+1)(0.5s+1))", "k=1.1,ki=0.9,kd=0.3,derivative_filter=0.05,b=0.8")

#: Sensitivity peaks for which the controllers of largest integral gain are marked.
DESIGNED = (1.4, 2.0)

_TIMES = 40
_END = 12.0


def reference() -> dict[str, Any]:
    """Return a loop with its response and metrics, for the page to compare itself with."""
    plant, controller = REFERENCE
    loop = Loop(parse_plant(plant), parse_controller(controller))
    step, margins = loop.step(), loop.margins()
    times = np.linspace(0.0, _END, _TIMES + 1)
    return {
        "plant": plant,
        "controller": controller,
        "times": times.tolist(),
        "output": loop.step(until=1.01 * _END)(times).tolist(),
        "metrics": {
            "overshoot": step.overshoot(),
            "settling": step.settling_time(),
            "iae": step.iae(),
            "ms": float(loop.sensitivity_peak()),
            "gain": margins.gain,
            "phase": margins.phase,
            "delay": margins.delay,
        },
    }


def optimal(plant: str) -> list[dict[str, Any]]:
    """Return the PI controllers that only Python computes for the gain plane of a plant.

    Those of largest integral gain for two sensitivity peaks, and, where the step response method of Ziegler and Nichols
    does not apply, the one of their other method.

    Parameters
    ----------
    plant
        In the notation of `replicate.loops`. A controller that does not exist is left out.
    """
    process = parse_plant(plant)
    designs: dict[str, Callable[[], PI | PID]] = {f"Ms {ms}": partial(_largest, process, ms) for ms in DESIGNED}
    if process.den.size > 2 or process.num.size > 1 or not process.dead_time:
        designs["ZN"] = partial(ziegler_nichols, process, method="ultimate")
    found = []
    for name, design in designs.items():
        with contextlib.suppress(LoopError, ValueError):  # no such controller
            controller = design()
            found.append({"name": name, "k": controller.k, "ki": controller.ki, "kd": controller.kd})
    return found


def _largest(plant: Plant, ms: float) -> PI:
    return design_pi(plant, ms=ms).controller
