"""A response that ends like a power of time: its integrals are finished exactly, or refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import NotSettledError
from replicate.loops.time_domain.signal import Signal

Array = NDArray[np.float64]

SMALL = 1e-7  # of the largest error: from here on its sign no longer changes, and rounding is still far away


class SlowSignal(Signal):
    """A response around a plant given by a function with a branch point at s = 0.

    Its error falls like a power of time, so slowly that the rounding errors of a piecewise polynomial, over so long a
    time, would be larger than what is left of an integral. The integral of the error over all time follows from the
    response's transform; where the sign of the error no longer changes, that is the rest of the absolute error, too.

    Parameters
    ----------
    breaks, coefficients, final, stable
        As for `Signal`.
    total_error
        The integral of ``final - y`` over all time; ``inf`` if it has none, ``nan`` if it is not known.
    """

    def __init__(
        self,
        breaks: Array,
        coefficients: Array,
        *,
        final: float = float("nan"),
        stable: Callable[[], bool] | None = None,
        total_error: float = float("nan"),
    ) -> None:
        super().__init__(breaks, coefficients, final=final, stable=stable)
        self.total_error = total_error

    def __mul__(self, factor: float) -> SlowSignal:
        """Scale the response."""
        scaled = super().__mul__(factor)
        return SlowSignal(
            scaled.breaks, scaled.coefficients, final=scaled.final, stable=self.stable,
            total_error=self.total_error * float(factor),
        )  # fmt: skip

    __rmul__ = __mul__

    def ie(self) -> float:
        """Return the integrated error over all time; see `Signal.ie`."""
        self._require_stable("integrated error")
        total = self._known("IE")
        return total if self.final or not np.isfinite(total) else -total

    def iae(self) -> float:
        """Return the integral of the absolute error over all time; ``inf`` where it does not converge."""
        self._require_stable("integrated absolute error")
        total = self._known("IAE")
        if not np.isfinite(total):
            return float("inf")
        early = self._until_small()
        signed = float(np.sum(early._piece_integrals(early._error)))  # noqa: SLF001  -- of the same kind
        return early.iae() + abs(total - signed)

    def itae(self) -> float:
        """Refuse: what is left of this integral lies beyond the digits of the response; NotSettledError always."""
        self._refuse("ITAE")

    def itse(self) -> float:
        """Refuse: what is left of this integral lies beyond the digits of the response; NotSettledError always."""
        self._refuse("ITSE")

    def ise(self) -> float:
        """Return the integral of the squared error; NotSettledError if the error falls too slowly for it."""
        self._require_stable("integrated squared error")
        early = self._until_small()
        value, rest = early.ise(), float(early._error[-1].sum()) ** 2 * early.horizon  # noqa: SLF001
        if rest > SMALL * value:
            self._refuse("ISE")
        return super().ise()

    def _known(self, what: str) -> float:
        if np.isnan(self.total_error):
            self._refuse(what)
        return self.total_error

    def _refuse(self, what: str) -> NoReturn:
        msg = f"the response approaches its final value like a power of time: its {what} cannot be computed"
        raise NotSettledError(msg)

    def _until_small(self) -> Signal:
        """Return the response up to where its error has become small for good."""
        error = np.max(np.abs(self.final - self._samples), axis=1)
        large = np.nonzero(error > SMALL * error.max())[0]
        end = int(large[-1]) + 1 if large.size else 1
        return Signal(self.breaks[: end + 1], self.coefficients[:end], final=self.final, stable=self.stable)
