"""Paper VI: the flexible shaft, and the all-pass and band-pass filter that damp its resonance.

Everything is rational and without dead time, so transfer functions are pairs of polynomials, descending powers of s.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from replicate.loops import Plant

Array = NDArray[np.float64]

ZETA_A = 0.5
ZETA_B = 0.9
SLOPE, INTERCEPT = 0.33, -0.46  # (10) as printed


class Extremum(NamedTuple):
    """A local extremum of |P| and its frequency."""

    value: float
    frequency: float


@dataclass(frozen=True)
class Shaft:
    """Two flywheels coupled by a spring: gain / ((s + omega_f)(s^2 + 2 zeta_p omega_p s + omega_p^2)).

    In (3) the gain is omega_p^2, in the example it is kappa.
    """

    gain: float
    zeta_p: float
    omega_p: float
    omega_f: float

    @classmethod
    def as_in_eq_3(cls, zeta_p: float, omega_p: float, omega_f: float = 1.0) -> Shaft:
        """Return the process of (3); the test batch has omega_f = 1."""
        return cls(omega_p**2, zeta_p, omega_p, omega_f)

    @cached_property
    def plant(self) -> Plant:
        """The process as a plant."""
        mode = [1.0, 2.0 * self.zeta_p * self.omega_p, self.omega_p**2]
        return Plant([self.gain], np.polymul([1.0, self.omega_f], mode))

    @cached_property
    def p_max(self) -> float:
        """|P(i omega_p)|."""
        return float(abs(self.plant(1j * self.omega_p)))

    def extrema(self) -> tuple[Extremum, Extremum]:
        """Return the local minimum of |P| between corner and resonance, and the resonance peak.

        |P|^-2 is a cubic in x = w^2; its two stationary points solve a quadratic. They exist for small zeta_p and
        omega_p well above omega_f only.

        Raises
        ------
        ValueError
            If |P| falls monotonically.
        """
        square = self.omega_p**2
        mode = np.array([1.0, (4.0 * self.zeta_p**2 - 2.0) * square, square**2])
        x = np.sort_complex(np.roots(np.polyder(np.polymul([1.0, self.omega_f**2], mode))))
        if np.any(np.abs(x.imag) > 1e-9 * np.abs(x)) or np.any(x.real <= 0.0):
            msg = f"|P| has no minimum below its resonance for zeta_p = {self.zeta_p:g}, omega_p = {self.omega_p:g}"
            raise ValueError(msg)
        w = np.sqrt(x.real)
        sizes = np.abs(self.plant(1j * w))
        return Extremum(float(sizes[0]), float(w[0])), Extremum(float(sizes[1]), float(w[1]))

    @property
    def ratio(self) -> float:
        """P_max / P_min."""
        return self.p_max / self.extrema()[0].value

    @property
    def omega_a(self) -> float:
        """The frequency of the all-pass filter that solves (4) with zeta_a = 0.5.

        arg F_a(i w) = -2 theta with cot(theta) = (omega_a^2 - w^2)/(2 zeta_a omega_a w), a quadratic in omega_a.
        """
        phase = -(np.arctan2(self.omega_p, self.omega_f) + 0.5 * np.pi)  # of P(i omega_p), continuous from 0
        theta = 0.5 * (2.0 * np.pi + phase)
        half = ZETA_A / np.tan(theta)
        return float(self.omega_p * (half + np.sqrt(half**2 + 1.0)))

    def band_gain(self, k_b: float) -> float:
        """Return K_b of the band-pass filter (9); k_b = 1 is (6)."""
        return k_b * 2.0 * ZETA_B * self.omega_p / self.p_max

    def filter(self, k_b: float, *, zeta_a: float = ZETA_A, zeta_b: float = ZETA_B) -> tuple[Array, Array]:
        """Return numerator and denominator of the active filter F = F_a F_b, (1), (2).

        Other damping ratios keep what (4) and (5) ask for: the phase of F_a and the gain of F_b at omega_p.
        """
        theta_cot = (self.omega_a**2 - self.omega_p**2) / (2.0 * ZETA_A * self.omega_a * self.omega_p)
        half = zeta_a * theta_cot
        omega_a = self.omega_p * (half + np.sqrt(half**2 + 1.0))
        all_pass = allpass(omega_a, zeta_a)
        band = bandpass(self.omega_p, zeta_b, k_b * 2.0 * zeta_b * self.omega_p / self.p_max)
        num, den = (np.convolve(a, b) for a, b in zip(all_pass, band, strict=True))
        return num, den

    def damped(self, k_b: float, *, zeta_a: float = ZETA_A, zeta_b: float = ZETA_B) -> Plant:
        """Return P/(1 + P F), from load to output of the inner loop; k_b = 0 is the process itself."""
        if k_b == 0.0:
            return self.plant
        num, den = self.filter(k_b, zeta_a=zeta_a, zeta_b=zeta_b)
        plant = self.plant
        closed, fed_back = np.convolve(plant.den, den), np.convolve(plant.num, num)
        closed[closed.size - fed_back.size :] += fed_back
        return Plant(np.convolve(plant.num, den), closed)

    def largest_stable_gain(self) -> float:
        """Return the k_b at which the inner loop becomes unstable: the least at which it has a pole on the axis.

        With P F = k_b N/D these are k_b = -D/N at the frequencies at which that is real, the roots of Im(D N*).
        """
        plant, (filter_num, filter_den) = self.plant, self.filter(1.0)
        num, den = np.polymul(plant.num, filter_num), np.polymul(plant.den, filter_den)
        in_w = [p * 1j ** np.arange(p.size)[::-1] for p in (num, den)]
        w = np.roots(np.polymul(in_w[1], np.conj(in_w[0])).imag)
        s = 1j * w[(w.real > 0.0) & (np.abs(w.imag) < 1e-9 * np.abs(w))].real
        gains = -(np.polyval(den, s) / np.polyval(num, s)).real
        return float(np.min(gains[gains > 0.0]))


def allpass(omega: float, zeta: float) -> tuple[Array, Array]:
    """Return the all-pass filter (1)."""
    return np.array([1.0, -2.0 * zeta * omega, omega**2]), np.array([1.0, 2.0 * zeta * omega, omega**2])


def bandpass(omega: float, zeta: float, gain: float) -> tuple[Array, Array]:
    """Return the band-pass filter (2)."""
    return np.array([gain, 0.0]), np.array([1.0, 2.0 * zeta * omega, omega**2])


def damping_ratio(poles: NDArray[np.complex128]) -> float:
    """Return the smallest damping ratio among oscillatory poles."""
    pairs = poles[poles.imag > 1e-9 * np.abs(poles)]
    return float(np.min(-pairs.real / np.abs(pairs)))


def k_b_from(ratio: float) -> float:
    """Return k_b by (10)."""
    return INTERCEPT + SLOPE * ratio


# section "Example": the nominal model of the flexible shaft
EXAMPLE = Shaft(gain=15.21, zeta_p=0.02, omega_p=7.66, omega_f=0.10)
EXAMPLE_EQ_3 = Shaft.as_in_eq_3(EXAMPLE.zeta_p, EXAMPLE.omega_p, EXAMPLE.omega_f)
K_B = 2.75  # as printed
PI_GAIN, PI_INTEGRAL_TIME = 1.0, 12.5
