"""A plant given by a function: any transfer function analytic for Re s > 0, times a dead time."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.plant import Plant
from replicate.loops.plants.at_rest import value_at_rest
from replicate.loops.plants.function_algebra import Rescaled
from replicate.loops.plants.function_resonances import resonances

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

STEP = 2e-3  # of a difference, relative to |s|,
NEAR_RESONANCE = 0.04  # relative to the distance of a resonance,
SMALLEST_STEP = 1e-9  # and never less, relative to |s|
CIRCLE_POINTS = 48
CIRCLE_RADIUS = 0.35  # of |w|; a cut or poles on the negative real axis stay well outside,
CLEAR = 0.5  # and of the distance of a resonance
BAND = 1e3  # factor beyond the corners on both sides within which resonances are looked for
LOWEST, HIGHEST, PER_OCTAVE = -100, 100, 4  # octaves of frequency in which a function's corners are looked for
ANALYTIC = 1e-4  # relative difference of a value and the mean around it that is not a rounding error
BESIDE = 1e-15  # relative distance of the next point
TINY = 1e-100  # modulus from which a function that overflows in its denominator goes on to zero
SMALLEST, LARGEST = 1e-290, 1e290  # modulus of a value whose logarithm tells a slope
AT_REST = 1e-3  # of the lowest corner: where only what happens at rest shows
AROUND = 0.1  # of |w|: radius of a mean that shows rounding errors
BENT = 0.3  # change of slope, or of phase in rad, at which a frequency response has left its asymptote
MOST_WAVES = 8  # changes between steeper and flatter than the asymptote, of a response that has corners
LAG = 4.0 * np.pi  # phase beyond which nothing of a frequency response matters to a loop


class FunctionPlant(Plant):
    r"""A plant :math:`f(s) e^{-sL}`; made by `Plant.from_function`."""

    function: Callable[[Any], Any]

    def __init__(self, function: Callable[[Any], Any], dead_time: float = 0.0) -> None:
        checks.function("the plant's function", function)
        self._set(np.ones(1), np.ones(1), checks.non_negative("the dead time", dead_time))
        self.function = function

    @property
    def is_rational(self) -> bool:
        """False: the plant is a function."""
        return False

    @property
    def parts(self) -> tuple[Plant, ...]:
        """None: a function is not a sum of rational plants."""
        return ()

    def _values(self, s: ArrayLike) -> ComplexArray:
        s = np.asarray(s, dtype=complex)
        with np.errstate(all="ignore"):  # values that are not finite are looked for where they matter
            values = np.array(np.asarray(self.function(s), dtype=complex) + np.zeros_like(s))
            lost = ~np.isfinite(values)
            if np.any(lost & (s == 0.0)):
                values[lost & (s == 0.0)] = self.gain
                lost &= s != 0.0
            if lost.any():
                values[lost] = self._beside(s[lost])
                lost = ~np.isfinite(values)
            if lost.any():
                values[lost] = self._vanished(s[lost], values[lost])
            return values

    def _beside(self, s: ComplexArray) -> ComplexArray:
        """Return the values next to points, which a function without damping has where it has a pole."""
        beside = s * (1.0 - BESIDE * 1j)
        return np.asarray(np.asarray(self.function(beside), dtype=complex) + np.zeros_like(s))

    def _vanished(self, s: ComplexArray, values: ComplexArray) -> ComplexArray:
        """Return 0 for values without a number where the function is tiny on the way there, as 1/cosh(1e3) is."""
        near = s
        for _ in range(HIGHEST):
            near = near / 2.0
            there = np.asarray(self.function(near), dtype=complex) + np.zeros_like(near)
            values = np.where(~np.isfinite(values) & (np.abs(there) < TINY), 0.0, values)
            if np.all(np.isfinite(values) | np.isfinite(there)):
                break
        return np.asarray(values)

    def delay_free(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the function itself at complex ``s``."""
        return self._values(s)

    def log_derivative(self, s: ArrayLike) -> ComplexArray:
        """Evaluate G'(s)/G(s), dead time included, by a sixth-order difference."""
        s = np.asarray(s, dtype=complex)
        return np.asarray(self.difference(self.delay_free, s) / self.delay_free(s) - self.dead_time)

    def difference(self, g: Callable[[ComplexArray], ComplexArray], s: ComplexArray) -> ComplexArray:
        """Return g'(s), of a function with the resonances of this one, by a difference of the sixth order."""
        h = np.minimum(STEP * np.abs(s), np.maximum(NEAR_RESONANCE * self._clearance(s), SMALLEST_STEP * np.abs(s)))
        slope = 45 * (g(s + h) - g(s - h)) - 9 * (g(s + 2 * h) - g(s - 2 * h)) + g(s + 3 * h) - g(s - 3 * h)
        return np.asarray(slope / (60 * h))

    def _clearance(self, s: ComplexArray) -> Array:
        """Return the distances of the nearest resonances, ``inf`` without any."""
        both = np.concatenate([self.resonances, self.resonances.conj()])
        return np.asarray(np.min(np.abs(s[..., None] - both), axis=-1, initial=np.inf))

    def taylor(self, s: ComplexArray, order: int) -> ComplexArray:
        """Return Taylor coefficients of the function at ``s`` by Cauchy's integral, shape (order + 1, len(s))."""
        turn = np.exp(2j * np.pi * np.arange(CIRCLE_POINTS) / CIRCLE_POINTS)
        radius = np.minimum(CIRCLE_RADIUS * np.abs(s), CLEAR * self._clearance(s))
        around = self.delay_free(s[:, None] + radius[:, None] * turn)
        powers = np.exp(-2j * np.pi * np.outer(np.arange(CIRCLE_POINTS), np.arange(order + 1)) / CIRCLE_POINTS)
        return np.asarray((around @ powers / CIRCLE_POINTS).T / radius ** np.arange(order + 1)[:, None])

    def rescaled(self, time: float, gain: float) -> FunctionPlant:
        """Return the plant in another unit of time, its gain divided by ``gain``."""
        time, gain = checks.positive("the unit of time", time), checks.nonzero("the unit of gain", gain)
        plant: FunctionPlant = self
        dead_time = self.dead_time / time
        if isinstance(self.function, Rescaled):
            plant, time, gain = self.function.plant, self.function.time * time, self.function.gain * gain
        function = plant.function if time == gain == 1.0 else Rescaled(plant, time, gain)
        return FunctionPlant(function, dead_time)

    def _times(self, factor: float) -> Plant:
        return self.rescaled(1.0, 1.0 / factor)

    @property
    def integrators(self) -> int:
        """0: a function's behaviour at s = 0 is its own."""
        return 0

    @property
    def gain(self) -> float:
        """The steady-state gain f(0), a limit if need be; ``inf`` where f grows towards it, ``nan`` without one."""
        with np.errstate(all="ignore"):
            at_rest = complex(np.asarray(self.function(np.zeros(1, dtype=complex)) + np.zeros(1))[0])
        if np.isfinite(at_rest):
            return float(at_rest.real)
        low, _ = self.corners
        return value_at_rest(self.delay_free, low)

    @property
    def gain_is_negative(self) -> bool:
        """Whether the gain is negative at low frequency."""
        low, _ = self.corners
        return bool(complex(self.delay_free(AT_REST * low)).real < 0.0)

    def poles(self) -> ComplexArray:
        """Return nothing: the poles of a function are not known."""
        return np.empty(0, dtype=complex)

    def zeros(self) -> ComplexArray:
        """Return nothing: the zeros of a function are not known."""
        return np.empty(0, dtype=complex)

    @cached_property
    def resonances(self) -> ComplexArray:
        """The function's poles close to the imaginary axis, Im > 0."""
        if isinstance(self.function, Rescaled):
            return self.function.plant.resonances * self.function.time
        low, high = self.corners
        return resonances(self.delay_free, low / BAND, high * BAND)

    @property
    def corners(self) -> tuple[float, float]:
        """Frequencies between which the function bends; both at one over the dead time, or at 1, if it never does."""
        at = 1.0 / self.dead_time if self.dead_time else 1.0
        return self.bends or (at, at)

    @cached_property
    def bends(self) -> tuple[float, float] | None:
        """Where the function leaves its asymptote at rest, and where its last one begins; None for a power of s."""
        if isinstance(self.function, Rescaled):
            bends = self.function.plant.bends
            return bends and (bends[0] * self.function.time, bends[1] * self.function.time)
        exponent = np.arange(LOWEST * PER_OCTAVE, HIGHEST * PER_OCTAVE + 1) / PER_OCTAVE
        w = 2.0**exponent
        with np.errstate(all="ignore"):
            value = self.delay_free(1j * w)
        known = np.isfinite(value) & (value != 0.0) & (np.abs(value) > SMALLEST) & (np.abs(value) < LARGEST)
        first = self._first_smooth(w, value) if known.any() else 0
        gone = np.nonzero(~known[first:])[0]
        last = first + int(gone[0]) if gone.size else known.size
        w, value = w[first:last], value[first:last]
        if w.size > 2 * PER_OCTAVE:
            slope = np.diff(np.log(np.abs(value))) * PER_OCTAVE / np.log(2.0)
            phase = np.unwrap(np.angle(value))
            bent = np.abs(slope - np.median(slope[:PER_OCTAVE])) > BENT
            turned = np.abs(phase[1:] - np.median(phase[:PER_OCTAVE])) > BENT
            left = np.nonzero(bent | turned)[0]
            if left.size:
                lagged = np.nonzero(np.abs(phase - phase[0]) > LAG)[0]
                end = int(lagged[0]) if lagged.size else w.size - 1
                waves = np.nonzero(np.diff(np.sign(slope[left[0] :] - np.median(slope[-PER_OCTAVE:]))))[0]
                if waves.size > MOST_WAVES:  # the ripple of a dead time in a sum, not corners
                    end = min(end, int(left[0] + waves[MOST_WAVES]))
                settled = np.abs(slope[: end + 1] - np.median(slope[-PER_OCTAVE:])) > BENT
                high = int(np.nonzero(settled)[0][-1]) if settled.any() and not lagged.size else min(end, w.size - 1)
                if not settled.any() and not lagged.size:
                    high = int(left[0])
                return float(w[left[0]]), float(max(w[high], w[left[0]]))
        return None

    def _first_smooth(self, w: Array, value: ComplexArray) -> int:
        """Return the first frequency from which on, for two octaves, the values are not rounding errors.

        A function such as (1 - e^{-s})/s loses its digits near s = 0. Where it has them, its value is the mean of those
        around it.
        """
        turn = np.exp(2j * np.pi * np.arange(8) / 8)
        with np.errstate(all="ignore"):
            mean = np.mean(self.delay_free(1j * w[:, None] * (1.0 + AROUND * turn)), axis=1)
            smooth = np.abs(mean - value) <= ANALYTIC * np.abs(value)
        smooth &= np.isfinite(value) & (np.abs(value) > SMALLEST) & (np.abs(value) < LARGEST)
        run = np.convolve(smooth, np.ones(2 * PER_OCTAVE), mode="valid") > 2 * PER_OCTAVE - 0.5
        return int(np.argmax(run)) if run.any() else int(np.argmax(value != 0.0))

    def state_space(self) -> tuple[Array, Array, Array, float]:
        """Refuse: a function has no state-space model; LoopError always."""
        msg = "a plant given by a function has no state-space model"
        raise LoopError(msg)

    def __repr__(self) -> str:
        name = getattr(self.function, "__name__", None) or repr(self.function)
        return f"Plant.from_function({name}, dead_time={checks.exact(self.dead_time)})"
