r"""Where the Nyquist curve of an optimal PI loop touches the circle: at one frequency, or at two.

A smooth optimum is a root of h(w) (18), a corner of the envelope solves four equations (15).

Reference: Astrom, Panagopoulos and Hagglund, "Design of PI controllers based on non-convex optimization", Automatica 34
(1998) 585-601.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from replicate.loops.design.circles import Circle
from replicate.loops.design.pi_result import PIDesign
from replicate.loops.numerics.bracketed import bracketed_root
from replicate.loops.plant import Plant
from replicate.loops.plants.jets import value_and_slope

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

APART = 1e-6  # relative distance of two frequencies that are two tangencies and not one
SMALLEST_GAIN = 1e-3  # of ki/w: size that a vanishing k has, so that it can be scaled
SOLVED, ROUNDING = 1e-9, 1e-15  # residual of the equations that is a solution, and what Newton's method is asked for


def smooth_condition(plant: Plant, circle: Circle, w: Array) -> Array:
    """Evaluate h(w) / (2 R) of (18); a smooth optimum is a root of it."""
    return np.asarray(_condition(circle, w, plant(1j * w), 1j * plant.log_derivative(1j * w)))


def _condition(circle: Circle, w: Any, value: Any, slope: Any) -> Any:
    """Return h(w) / (2 R) from G(i w) and d log G / d w = r'/r + i phi', numbers or arrays."""
    direction = value / abs(value)  # cos phi + i sin phi
    radius, center = circle.radius, circle.center
    return (radius + center * direction.imag) * (slope.real - 1.0 / w) - center * slope.imag * direction.real


def smooth_gains(plant: Plant, circle: Circle, w: float) -> tuple[float, float]:
    """Return (k, ki) of the lowest vertex of the ellipse at a frequency (17)."""
    value = complex(plant(1j * w))
    r, direction = abs(value), value / abs(value)
    return -circle.center * direction.real / r, -w / r * (circle.center * direction.imag + circle.radius)


def smooth_optimum(plant: Plant, circle: Circle, w: Array, h: Array, near: float) -> PIDesign | None:
    """Return the optimum that touches the circle once, at the maximum of the lower vertex closest to ``near``.

    ``h`` is the smooth condition on the frequencies ``w``.
    """
    changes = np.nonzero((h[:-1] > 0.0) & (h[1:] < 0.0))[0]
    if changes.size == 0:
        return None
    index = changes[np.argmin(np.abs(np.log(w[changes] / near)))]

    def condition(x: float) -> float:
        return float(_condition(circle, x, *value_and_slope(plant, x)))

    frequency = bracketed_root(condition, w[index], w[index + 1])
    k, ki = smooth_gains(plant, circle, frequency)
    return PIDesign(k, ki, float("nan"), frequency, (frequency,), "smooth", "optimal")


def closest_frequencies(value: ComplexArray, circle: Circle, w: Array, k: float, ki: float) -> tuple[float, float]:
    """Return the two frequencies at which the Nyquist curve comes closest to the circle's center, ascending.

    ``value`` is G on the frequencies ``w``.
    """
    distance = np.abs(circle.center + (k - 1j * ki / w) * value)
    inner = np.nonzero((distance[1:-1] <= distance[:-2]) & (distance[1:-1] <= distance[2:]))[0] + 1
    closest = np.sort(inner[np.argsort(distance[inner])][:2])
    return (float(w[closest[0]]), float(w[closest[-1]])) if closest.size else (0.0, 0.0)


def corner_optimum(plant: Plant, circle: Circle, k: float, ki: float, w1: float, w2: float) -> PIDesign | None:
    """Solve the four equations (15) for two tangencies by Newton's method, all unknowns scaled to one."""
    if not (w2 > w1 * (1.0 + APART) and ki > 0.0):
        return None
    scale = np.array([max(abs(k), SMALLEST_GAIN * ki / w2), ki, w1, w2])

    def equations(x: Array) -> Array:
        gain, integral, *frequencies = x * scale
        result = []
        for frequency in frequencies:
            plant_value, plant_slope = value_and_slope(plant, frequency)
            value = (gain - 1j * integral / frequency) * plant_value
            slope = plant_slope * value + 1j * integral / frequency**2 * plant_value
            offset = circle.center + value
            result += [abs(offset) ** 2 / circle.radius**2 - 1.0, frequency * (offset.conjugate() * slope).real]
        return np.array(result)

    with np.errstate(all="ignore"):  # a start that is not a corner may wander off; the residual tells
        solution = root(equations, np.array([k, ki, w1, w2]) / scale, method="hybr", options={"xtol": ROUNDING})
    if not np.max(np.abs(solution.fun)) <= SOLVED:
        return None
    gain, integral, first, second = (float(v) for v in solution.x * scale)
    if integral <= 0.0 or first <= 0.0 or second <= 0.0 or abs(first / second - 1.0) < APART:
        return None
    first, second = sorted((first, second))
    return PIDesign(gain, integral, float("nan"), first, (first, second), "corner", "optimal")
