"""What the two other methods of section 6 know of a plant: the ultimate point, and gain, time constant and dead time.

The paper does not say how it finds the model ``e^{-sL}/(1 + sT)`` for lambda tuning. Five usual ways are here.

References
----------
K. J. Astrom and T. Hagglund, PID Controllers: Theory, Design, and Tuning, 2nd ed., ISA 1995, sections 2.4 and 4.2.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

from replicate.loops import PI, Loop, Signal
from replicate.papers.panagopoulos.part_1.plants import PLANTS

SMALL_GAIN = 0.1  # stable for every plant that the ultimate point is asked of
SETTLED = 60.0  # time constants (all plants here have a slowest one of 1) after which a step response is at rest
LAMBDA = 3.0  # closed-loop over open-loop time constant, section 6


@dataclass(frozen=True)
class FirstOrder:
    """A first-order model with dead time and gain 1."""

    time_constant: float
    dead_time: float

    def lambda_tuning(self) -> PI:
        """Return the controller whose loop has the time constant 3T."""
        total = self.dead_time + LAMBDA * self.time_constant
        return PI(self.time_constant / total, 1.0 / total)


@cache
def ultimate_point(plant: str) -> tuple[float, float]:
    """Return ultimate gain and period."""
    margins = Loop(PLANTS[plant], PI(SMALL_GAIN)).margins()
    return SMALL_GAIN * margins.gain, 2.0 * math.pi / margins.phase_crossover


def ziegler_nichols(plant: str) -> PI:
    """Return the PI controller of the frequency-response method, 0.45 Ku and Tu/1.2."""
    gain, period = ultimate_point(plant)
    return PI.from_integral_time(0.45 * gain, period / 1.2)


@cache
def step_response(plant: str) -> Signal:
    """Return the step response of a stable plant by itself."""
    return Loop(PLANTS[plant], PI(0.0)).load_step(until=SETTLED)


def area_method(plant: str) -> FirstOrder:
    """Return the model from two areas: T + L above the step response, T/e below it up to T + L."""
    integral = step_response(plant).antiderivative()
    residence = SETTLED - float(integral(SETTLED))
    time_constant = math.e * float(integral(residence))
    return FirstOrder(time_constant, residence - time_constant)


def two_points(plant: str) -> FirstOrder:
    """Return the model that agrees with the step response at 28.3 % and 63.2 %."""
    early, late = (step_response(plant).first_reach(1.0 - math.exp(-share)) for share in (1.0 / 3.0, 1.0))
    return FirstOrder(1.5 * (late - early), late - 1.5 * (late - early))


def tangent(plant: str) -> FirstOrder:
    """Return the model from the steepest tangent alone."""
    response = step_response(plant)
    slope = response.derivative().peak()
    return FirstOrder(1.0 / slope.value, slope.time - float(response(slope.time)) / slope.value)


def tangent_and_63(plant: str) -> FirstOrder:
    """Return the model with the dead time of the steepest tangent, exact at 63.2 %."""
    dead_time = tangent(plant).dead_time
    return FirstOrder(step_response(plant).first_reach(1.0 - math.exp(-1.0)) - dead_time, dead_time)


def moments(plant: str) -> FirstOrder:
    """Return the model whose impulse response has the plant's mean T + L and variance T^2, for a numerator of 1."""
    model = PLANTS[plant]
    _, linear, square = (float(c) for c in (model.den / model.den[-1])[:-4:-1])  # 1 + a1 s + a2 s^2 + ...
    time_constant = math.sqrt(linear**2 - 2.0 * square)
    return FirstOrder(time_constant, model.dead_time + linear - time_constant)


METHODS: dict[str, Callable[[str], FirstOrder]] = {
    "area": area_method,
    "two-points": two_points,
    "tangent": tangent,
    "tangent-63": tangent_and_63,
    "moments": moments,
}
