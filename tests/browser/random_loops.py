"""Random loops of every kind of plant, many of them close to the border of stability."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from replicate.loops import PID, Loop, Plant
from replicate.loops.notation import parse_plant

#: The rational plants of the bundled papers.
PRINTED = (
    "e^{-15s}/(s+1)^3", "e^{-5s}/(s+1)^3", "1/(s+1)^7", "1/(s+1)^4", "1/(s+1)^3", "150/(s^3+21s^2+120s+100)",
    "15625/(s^4+156s^3+4030s^2+19500s+15625)", "9/(s^3+s^2+9s+9)", "9/(s^3+3s^2+11s+9)", "(-2s+1)/(s+1)^3", "e^{-s}/s",
    "(150s+55)/(s^4+21.05s^3+121.05s^2+106s+5)", "1/(s(s+1)^2)", "1/(s(s+1)^3)", "e^{-s}", "e^{-0.4s}/(s-1)",
)  # fmt: skip

Rng = np.random.Generator


def _first_order(rng: Rng, delay: float, lag: float) -> Plant:
    return Plant([rng.uniform(0.3, 3.0)], [lag, 1.0], dead_time=delay)


def _second_order(rng: Rng, delay: float, lag: float) -> Plant:
    return Plant([1.0], np.convolve([lag, 1.0], [rng.uniform(0.05, 1.0) * lag, 1.0]), dead_time=delay)


def _stiff(rng: Rng, delay: float, lag: float) -> Plant:
    return Plant([1.0], np.convolve([lag, 1.0], [10.0 ** rng.uniform(-3.0, -1.0) * lag, 1.0]), dead_time=delay)


def _short_delay(rng: Rng, delay: float, lag: float) -> Plant:
    return Plant([1.0], [lag, 1.0], dead_time=delay * 10.0 ** rng.uniform(-3.0, -1.0))


def _integrating(rng: Rng, delay: float, lag: float) -> Plant:
    return Plant([1.0], [lag, 1.0, 0.0] if rng.random() < 0.5 else [lag, 0.0], dead_time=delay)


def _unstable(rng: Rng, delay: float, lag: float) -> Plant:
    return Plant([1.0], [lag, -1.0], dead_time=min(delay, rng.uniform(0.05, 0.6) * lag))


def _high_order(rng: Rng, delay: float, lag: float) -> Plant:
    den = np.poly([-1.0 / lag] * int(rng.integers(3, 9)))
    return Plant([den[-1]], den, dead_time=delay if rng.random() < 0.5 else 0.0)


def _poorly_damped(rng: Rng, delay: float, lag: float) -> Plant:
    return Plant([1.0], [lag**2, 2.0 * 10.0 ** rng.uniform(-2.0, -0.3) * lag, 1.0], dead_time=delay)


def _inverse(rng: Rng, delay: float, lag: float) -> Plant:
    den = np.convolve([lag, 1.0], [rng.uniform(0.2, 1.0) * lag, 1.0])
    return Plant([-rng.uniform(0.1, 1.0) * lag, 1.0], den, dead_time=delay)


def _without_delay(rng: Rng, delay: float, lag: float) -> Plant:
    return Plant([1.0], np.convolve([lag, 1.0], [delay, 1.0]) if rng.random() < 0.5 else [lag, 1.0])


def _printed(rng: Rng, _delay: float, _lag: float) -> Plant:
    return parse_plant(str(rng.choice(PRINTED)))


KINDS: tuple[Callable[[Rng, float, float], Plant], ...] = (
    _first_order, _second_order, _stiff, _short_delay, _integrating, _unstable, _high_order, _poorly_damped, _inverse,
    _without_delay, _printed,
)  # fmt: skip


def random_loop(rng: Rng, kind: int) -> tuple[dict[str, Any], Loop]:
    """Return plant and controller as the page has them, and the loop."""
    delay, lag = 10.0 ** rng.uniform(-1.0, 0.7), 10.0 ** rng.uniform(-0.5, 0.5)
    plant = KINDS[kind % len(KINDS)](rng, delay, lag)
    unstable = any(pole.real > 0.0 for pole in plant.poles())
    time = plant.dead_time + sum(1.0 / abs(pole) for pole in plant.poles() if pole)
    k = rng.uniform(1.1, 2.5) if unstable else 10.0 ** rng.uniform(-1.0, 0.5)
    ki = 0.05 * k / time if unstable else k / time * 10.0 ** rng.uniform(-0.7, 0.4)
    if rng.random() < 0.1:
        ki = 0.0
    kd = k * time * rng.uniform(0.02, 0.3) if rng.random() < 0.4 else 0.0
    lag_d = kd / k / rng.uniform(3.0, 20.0)
    extra: dict[str, Any] = {"b": float(rng.choice([0.0, 0.5, 1.0])), "derivative_filter": lag_d}
    if rng.random() < 0.2:
        extra["setpoint_filter"] = time * rng.uniform(0.1, 1.0)
    if kd and rng.random() < 0.3:
        extra["c"] = 1.0
    controller = PID(k, ki, kd, **extra)
    loop = Loop(plant, controller)
    if rng.random() < 0.5 and loop.is_stable():  # to the border, or over it
        margin = loop.margins().gain
        if 1.0 < margin < 1e3:
            factor = margin * float(rng.choice([0.8, 0.95, 0.99, 1.01, 1.05]))
            k, ki, kd = factor * k, factor * ki, factor * kd
            loop = Loop(plant, PID(k, ki, kd, **extra))
    given = {
        "plant": {"num": plant.num.tolist(), "den": plant.den.tolist(), "deadTime": plant.dead_time},
        "controller": {
            "k": k, "ki": ki, "kd": kd, "b": extra["b"], "c": extra.get("c", 0.0), "filter": lag_d,
            "prefilter": extra.get("setpoint_filter", 0.0),
        },
    }  # fmt: skip
    return given, loop
