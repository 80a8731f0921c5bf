"""Many loops of one plant as columns of arrays, and their transfer functions evaluated all at once.

The unit of time is the dead time, so that plants of equal ratio of dead time to time constants share everything that is
computed from the plant alone; without dead time it is one that suits the loops (`replicate.loops.sweep.paces`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.plant import Plant
from replicate.loops.units import Units

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating[Any, Any]]
Places = NDArray[np.intp]


SHARED = ("controller_poles", "shared_num", "den", "zeros", "poles")
OWN = ("gains", "controller_zeros", "num")


@dataclass(frozen=True)
class LoopColumns:
    """Loops of one plant whose controllers differ in k, ki, kd and b alone; each gain is zero in all loops or in none.

    Attributes
    ----------
    plant
        In units in which its dead time is one, if it has one.
    form
        A controller with the filters and weights that all share, in the same units; of its gains only which are zero
        counts.
    k, ki, kd, b
        Gains in these units, shape (n,).
    time, gain
        The units, in those of the user.
    """

    plant: Plant
    form: PID
    k: Array
    ki: Array
    kd: Array
    b: Array
    time: float
    gain: float

    @classmethod
    def of(
        cls, plant: Plant, form: PID, k: Array, ki: Array, kd: Array, b: Array, *, time: float | None = None
    ) -> LoopColumns:
        """Return the columns of a rational plant; ``time`` is the unit of one without dead time."""
        units = Units.of(plant)
        time, gain = plant.dead_time or time or units.time, units.gain
        scaled = plant.rescaled(time, gain)
        return cls(
            scaled, Units(time, gain).controller(form), k * gain, ki * (gain * time), kd * (gain / time), b, time, gain
        )  # fmt: skip

    def __len__(self) -> int:
        return self.k.size

    def take(self, places: Places) -> LoopColumns:
        """Return some of the columns."""
        part = replace(self, k=self.k[places], ki=self.ki[places], kd=self.kd[places], b=self.b[places])
        # what is known already is not computed again
        part.__dict__.update({name: self.__dict__[name] for name in SHARED if name in self.__dict__})
        part.__dict__.update({name: self.__dict__[name][:, places] for name in OWN if name in self.__dict__})
        return part

    @property
    def delay(self) -> float:
        """The dead time: one, or zero."""
        return self.plant.dead_time

    @cached_property
    def gains(self) -> Array:
        """Gains of the four building blocks of `replicate.loops.time_domain.chain`, shape (4, n)."""
        return np.stack([self.k * self.b, -self.k, self.ki, self.kd])

    @cached_property
    def controller_zeros(self) -> Array:
        """Coefficients of the controller's own numerator, measurement filter left out; descending powers of s."""
        return self._numerator(self.k, self.kd, self.ki)

    def _numerator(self, k: Array, kd: Array, ki: Array) -> Array:
        rows = [k, ki] if self.form.ki else [k]
        if self.form.kd:
            # (base)(lag s + 1) + kd s times the integrator
            lag, none = self.form.derivative_filter, np.zeros_like(k)
            rows = [high + lag * low for high, low in zip([none, *rows], [*rows, none], strict=True)]
            rows[0] = rows[0] + kd
        elif not self.form.k:
            rows = rows[1:]
        return np.stack(rows) if rows else np.zeros((0, len(self)))

    @cached_property
    def controller_poles(self) -> Array:
        """Coefficients of the controller's denominator, the same for all, measurement filter left out."""
        den = np.array([1.0, 0.0]) if self.form.ki else np.array([1.0])
        lag = self.form.derivative_filter
        return np.asarray(np.polymul(den, [lag, 1.0]), dtype=float) if lag and self.form.kd else den

    @cached_property
    def shared_num(self) -> Array:
        """The part of the loop's numerator that all columns share: the plant's and the measurement filter's."""
        return np.asarray(np.polymul(self.plant.num, self.form.measurement_filter_polynomials()[0]), dtype=float)

    @cached_property
    def num(self) -> Array:
        """Coefficients of L's numerator, shape (degree + 1, n)."""
        return column_products(self.controller_zeros, self.shared_num)

    @cached_property
    def den(self) -> Array:
        """Coefficients of L's denominator, the same for all."""
        den = np.polymul(self.plant.den, self.controller_poles)
        return np.asarray(np.polymul(den, self.form.measurement_filter_polynomials()[1]), dtype=float)

    @cached_property
    def zeros(self) -> ComplexArray:
        """The zeros of L that all columns share."""
        return np.asarray(np.roots(self.shared_num), dtype=complex)

    @cached_property
    def poles(self) -> ComplexArray:
        """The poles of L."""
        return np.asarray(np.roots(self.den), dtype=complex)

    @property
    def feedthrough(self) -> Array:
        """The limits of |L| at infinite frequency."""
        if self.num.shape[0] < self.den.size:
            return np.zeros(len(self))
        return np.asarray(np.abs(self.num[0] / self.den[0]))

    def value(self, s: ComplexArray) -> ComplexArray:
        """Evaluate L at ``s`` of shape (..., n), in the columns' unit of time."""
        return np.asarray(horner(self.num, s) / np.polyval(self.den, s) * np.exp(-self.delay * s))

    def feedback(self, s: ComplexArray) -> ComplexArray:
        """Evaluate the controllers' transfer functions from -y to u at ``s`` of shape (n,)."""
        num, den = self.form.measurement_filter_polynomials()
        controller = horner(self.controller_zeros, s) / np.polyval(self.controller_poles, s)
        return np.asarray(controller * np.polyval(num, s) / np.polyval(den, s))

    def newton_step(self, s: ComplexArray) -> ComplexArray:
        """Return f(s)/f'(s) of the characteristic function f = D + N exp(-delay s)."""
        return np.divide(*self._characteristic(s))

    def residues(self, s: ComplexArray, setpoint: float, load: float) -> ComplexArray:
        """Return the residues of the output's transform at closed-loop poles, after steps of set-point and load."""
        turn, (filter_num, filter_den) = np.exp(-self.delay * s), self.form.measurement_filter_polynomials()
        passed, drive = np.polyval(self.plant.num, s) * turn, np.zeros(s.shape, dtype=complex)
        if setpoint:
            num, den = self.form.setpoint_filter_polynomials()
            # at a pole N exp(-delay s) is -D: whichever loses less to rounding
            fed_back, opened = horner(self.num, s) * turn, -np.polyval(self.den, s)
            largest = horner(np.abs(self.num), np.abs(s)) * np.abs(turn)
            same = np.where(largest.real <= np.polyval(np.abs(self.den), np.abs(s)), fed_back, opened)
            drive += same / np.polyval(filter_num, s)
            if not np.all(self.b == 1.0) or self.form.c != 1.0:  # weights: not all that is fed back is fed forward
                drive += passed * horner(
                    self._numerator(self.k * (self.b - 1.0), self.kd * (self.form.c - 1.0), 0.0 * self.ki), s
                )
            drive *= setpoint * np.polyval(num, s) / np.polyval(den, s)
        if load:
            drive += load * passed * np.polyval(self.controller_poles, s)
        _, slope = self._characteristic(s)
        return np.asarray(drive * np.polyval(filter_den, s) / (s * slope))

    def _characteristic(self, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Return f = D + N exp(-delay s) and its derivative."""
        turn = np.exp(-self.delay * s)
        n, n_slope = horner_with_slope(self.num, s)
        d, d_slope = horner_with_slope(self.den[:, None], s)
        return d + n * turn, d_slope + (n_slope - self.delay * n) * turn

    def final(self, setpoint: float, load: float) -> tuple[Array, Array]:
        """Return the steady-state values of output and control signal; ``nan`` where there is none."""
        plant, nan = self.plant, np.full(len(self), np.nan)
        (num, den), (filter_num, filter_den) = (
            self.form.setpoint_filter_polynomials(), self.form.measurement_filter_polynomials(),
        )  # fmt: skip
        reference, measured = setpoint * float(num[-1] / den[-1]), float(filter_num[-1] / filter_den[-1])
        if plant.num[-1] == 0.0 or not measured:
            return nan, nan
        if self.form.ki:
            output = np.full(len(self), reference / measured)
            return output, output / plant.gain - load
        if np.isinf(plant.gain):
            return (self.k * self.b * reference + load) / (self.k * measured), np.full(len(self), -load)
        output = plant.gain * (self.k * self.b * reference + load) / (1.0 + plant.gain * self.k * measured)
        return output, self.k * (self.b * reference - measured * output)


def horner(coefficients: Array, s: ComplexArray) -> ComplexArray:
    """Evaluate polynomials whose coefficients are rows, descending powers, one polynomial in each column."""
    value = np.zeros(s.shape, dtype=complex) + coefficients[0]
    for row in coefficients[1:]:
        value *= s
        value += row
    return np.asarray(value)


def horner_with_slope(coefficients: Array, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Evaluate polynomials as `horner`, and their derivatives."""
    value = np.zeros(s.shape, dtype=complex) + coefficients[0]
    slope = np.zeros(s.shape, dtype=complex)
    for row in coefficients[1:]:
        slope *= s
        slope += value
        value *= s
        value += row
    return value, slope


def column_products(rows: Array, polynomial: Array) -> Array:
    """Return the products of polynomials in columns with one polynomial."""
    product = np.zeros((rows.shape[0] + polynomial.size - 1, rows.shape[1]))
    for i, factor in enumerate(polynomial):
        product[i : i + rows.shape[0]] += factor * rows
    return product
