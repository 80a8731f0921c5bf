r"""The loop transfer function of a Smith predictor, :math:`L = G / (1/C + \hat G_0 - \hat G)`."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.closed_loop_poles.pole_starts import generator_eigenvalues
from replicate.loops.controller import PID
from replicate.loops.errors import ImproperLoopError
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.frequency_domain.other_transfers import crossings_of_one
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

AT_REST = 1e-9  # modulus, relative to the largest, of a pole that is at s = 0
RESONANCES = 12  # approximate poles of the predictor itself around which the frequency response is resolved


class PredictorTransfer(LoopTransfer):
    """L of a Smith predictor: N/D is that of the primary controller with the plant alone."""

    outer: LoopTransfer
    inner: LoopTransfer
    difference: Plant
    primary: PID

    @classmethod
    def of_difference(cls, plant: Plant, primary: PID, difference: Plant) -> PredictorTransfer:
        """Return L for a primary controller and the model's difference.

        Raises
        ------
        ImproperLoopError
            If the gain of the plant's or of the model's loop does not vanish at high frequency.
        """
        outer, inner = LoopTransfer.of(plant, primary), LoopTransfer.of(difference, primary)
        if outer.feedthrough or inner.feedthrough:
            msg = "a Smith predictor needs a loop gain that vanishes at high frequency: filter the measurement"
            raise ImproperLoopError(msg)
        whole = cls(outer.num, outer.den, plant.dead_time, plant)
        for name, value in (("outer", outer), ("inner", inner), ("difference", difference), ("primary", primary)):
            object.__setattr__(whole, name, value)
        return whole

    @property
    def is_rational(self) -> bool:
        """False: there is more than one dead time."""
        return False

    def _inverse_controller(self, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Return 1/C and its slope."""
        num, den = self.primary.feedback_polynomials()
        top, below = np.polyval(den, s), np.polyval(num, s)
        slope = (np.polyval(np.polyder(den), s) * below - top * np.polyval(np.polyder(num), s)) / below**2
        return np.asarray(top / below), np.asarray(slope)

    def __call__(self, s: Any) -> ComplexArray:
        """Evaluate L(s) at complex ``s``."""
        s = np.asarray(s, dtype=complex)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse, _ = self._inverse_controller(s)
            return np.asarray(self.plant(s) / (inverse + self.difference(s)))

    def log_derivative(self, s: Any) -> ComplexArray:
        """Evaluate L'(s)/L(s)."""
        s = np.asarray(s, dtype=complex)
        inverse, slope = self._inverse_controller(s)
        value, rise = self.difference.taylor(s.ravel(), 1)
        below = inverse + value.reshape(s.shape)
        return np.asarray(self.plant.log_derivative(s) - (slope + rise.reshape(s.shape)) / below)

    @cached_property
    def feedthrough(self) -> float:
        """0: the loop gain vanishes at high frequency."""
        return 0.0

    @property
    def infinite_at_rest(self) -> bool:
        """Whether |L| is infinite at s = 0."""
        return bool(self.plant.integrators or (self.primary.ki and not self.difference.gain))

    @property
    def longest_dead_time(self) -> float:
        """The longest dead time of plant and model."""
        return max(self.outer.longest_dead_time, self.inner.longest_dead_time)

    @cached_property
    def corner_frequencies(self) -> ComplexArray:
        """Where the terms bend, and the predictor's own poles."""
        own = generator_eigenvalues(self.difference, self.primary, self.inner)
        own = own[np.argsort(-own.real)][:RESONANCES]
        found = np.concatenate([self.outer.corner_frequencies, self.inner.corner_frequencies, own])
        # the predictor has a pole at s = 0: the model's difference cancels the integral part there
        return np.asarray(found[np.abs(found) > AT_REST * np.max(np.abs(found), initial=0.0)])

    @cached_property
    def gain_crossovers(self) -> Array:
        """All frequencies at which |L(i w)| = 1, ascending, found on a grid."""
        return crossings_of_one(self)

    def beyond(self, level: float) -> float:
        """Return a frequency beyond which |L(i w)| provably stays below ``level``.

        Where both loops are below t = level / (1 + level), |L| is below t / (1 - t).
        """
        each = level / (1.0 + level)
        return max(self.outer.beyond(each), self.inner.beyond(each))

    def off_limit(self, w: float) -> float:
        """Return how large |L| is at most beyond a frequency that `beyond` has returned for a level below 1."""
        largest = max(self.outer.off_limit(w), self.inner.off_limit(w))
        return largest / (1.0 - largest)
