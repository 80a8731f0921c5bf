"""Units in which a loop's own numbers are of the order of one.

Every computation is made in them, so that its result does not depend on whether the user counts in nanoseconds or in
years, in volts or in microvolts. Both units are powers of two: the change of units is exact.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from replicate.loops.controller import PID
from replicate.loops.filters import Filter
from replicate.loops.numerics.polynomials import horner
from replicate.loops.plant import Plant
from replicate.loops.plants.function_plant import HIGHEST, LOWEST, FunctionPlant


@dataclass(frozen=True)
class Units:
    """The unit of time, in the user's, and the unit of the plant's gain."""

    time: float = 1.0
    gain: float = 1.0

    @classmethod
    def of(cls, plant: Plant, controller: PID | None = None) -> Units:
        """Return the units of a loop: a mean of its corner frequencies, and the plant's gain there."""
        frequency = _mean(_corners(plant))
        if frequency is None and controller is not None:
            frequency = _mean(_controller_corners(controller)) or _mean(_crossover(plant, controller))
        time = 1.0 if frequency is None else _power_of_two(1.0 / frequency)
        gain = _gain_at(plant, 1j / time)
        if not (math.isfinite(gain) and gain > 0.0):
            gain = 1.0 / abs(controller.k) if controller is not None and controller.k else 1.0
        return cls(time, _power_of_two(gain))

    def plant(self, plant: Plant) -> Plant:
        """Return the plant in these units."""
        if self.time == self.gain == 1.0:
            return plant
        return plant.rescaled(self.time, self.gain)

    def controller(self, controller: PID) -> PID:
        """Return the controller in these units."""
        if self.time == self.gain == 1.0:
            return controller
        return PID(
            controller.k * self.gain,
            controller.ki * self.gain * self.time,
            controller.kd * self.gain / self.time,
            controller.b,
            controller.c,
            derivative_filter=controller.derivative_filter / self.time,
            measurement_filter=self._filter(controller.measurement_filter),
            measurement_filter_order=controller.measurement_filter_order,
            setpoint_filter=self._filter(controller.setpoint_filter),
        )

    def _filter(self, given: Filter) -> Filter:
        if not isinstance(given, tuple):
            return given / self.time
        num, den = (np.array(part) for part in given)
        scale = self.time ** np.arange(den.size - 1, -1, -1.0)
        return tuple((num / scale[den.size - num.size :]).tolist()), tuple((den / scale).tolist())


def _gain_at(plant: Plant, s: complex) -> float:
    """Return the size of the plant without its dead time."""
    if type(plant) is Plant:
        try:
            return float(abs(horner(plant.num.tolist(), s) / horner(plant.den.tolist(), s)))
        except (ZeroDivisionError, OverflowError):
            pass
    with np.errstate(all="ignore"):
        return float(np.abs(plant.delay_free(np.array([s])))[0])


def _corners(plant: Plant) -> list[float]:
    """Return frequencies, each as often as it counts: moduli of poles and zeros, and one over each dead time."""
    if isinstance(plant, FunctionPlant):
        return [*(plant.bends or ()), *([1.0 / plant.dead_time] if plant.dead_time else [])]
    found = []
    for part in plant.parts:
        for polynomial in (part.num, part.den):
            coefficients = polynomial.tolist()
            while not coefficients[-1]:
                coefficients.pop()
            degree = len(coefficients) - 1
            if degree:  # the product of the roots needs no roots
                size = math.log2(abs(coefficients[-1])) - math.log2(abs(coefficients[0]))
                found += [float(np.exp2(size / degree))] * degree
        if part.dead_time:
            found.append(1.0 / part.dead_time)
    return found


def _controller_corners(controller: PID) -> list[float]:
    found = [1.0 / controller.derivative_filter] if controller.derivative_filter else []
    _, den = controller.measurement_filter_polynomials()
    found += [float(abs(root)) for root in np.roots(den)]
    if controller.k and controller.ki:
        found.append(abs(controller.ki / controller.k))
    elif controller.kd and controller.ki:
        found.append(float(np.sqrt(abs(controller.ki / controller.kd))))
    if controller.k and controller.kd:
        found.append(abs(controller.k / controller.kd))
    return found


def _crossover(plant: Plant, controller: PID) -> list[float]:
    """Return the gain crossover of integrators alone, |k| K = w^n, or of a function, to a factor of two."""
    size = abs(controller.k) or abs(controller.kd) or abs(controller.ki)
    if not plant.parts:
        w = 2.0 ** np.arange(LOWEST, HIGHEST + 1)
        below = np.nonzero(size * np.abs(plant.delay_free(1j * w)) < 1.0)[0]
        return [float(w[i]) for i in below[:1]]
    if not plant.integrators or not size:
        return []
    return [float((size * abs(plant.parts[0].num[-1])) ** (1.0 / plant.integrators))]


def _mean(frequencies: Iterable[float]) -> float | None:
    logs = [math.log2(f) for f in frequencies if 0.0 < f < math.inf]
    return float(np.exp2(math.fsum(logs) / len(logs))) if logs else None


def _power_of_two(value: float) -> float:
    return float(np.exp2(round(math.log2(value))))
