"""What Python computes for the page: the loop of its self-test, and where tuning rules put their controllers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from replicate.loops import PID, Loop, design_pi
from replicate.loops.errors import LoopError
from replicate.loops.notation import parse_controller, parse_plant
from replicate.loops.tune import amigo, simc, ziegler_nichols

#: The loop with which the page tests itself: second order, with dead time, derivative filter and set-point weight.
REFERENCE = ("e^{-0.7s}/((s+1)(0.5s+1))", "k=1.1,ki=0.9,kd=0.3,derivative_filter=0.05,b=0.8")

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


def markers(text: str) -> list[dict[str, Any]]:
    """Return where the tuning rules that apply to a plant put their controllers."""
    plant = parse_plant(text)
    rules: tuple[tuple[str, Callable[[], Any]], ...] = (
        ("SIMC", lambda: simc(plant, plant.dead_time)),
        ("AMIGO", lambda: amigo(plant)),
        ("ZN", lambda: ziegler_nichols(plant)),
        ("Ms 1.4", lambda: design_pi(plant, ms=1.4).controller),
        ("Ms 2.0", lambda: design_pi(plant, ms=2.0).controller),
    )
    found = []
    for name, rule in rules:
        try:
            controller = rule()
        except (LoopError, ValueError):  # the rule does not apply to this plant
            continue
        if isinstance(controller, PID):
            found.append({"name": name, "k": controller.k, "ki": controller.ki, "kd": controller.kd})
    return found
