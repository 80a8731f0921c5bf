"""What one asks a response to be shown as, and when two are equal."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from numpy.typing import ArrayLike

from replicate.loops.frames import signal_frame
from replicate.loops.records import comparable
from replicate.loops.summary import SignalSummary, summarize_signal
from replicate.loops.time_domain.total_variation import total_variation

if TYPE_CHECKING:
    import pandas as pd

    from replicate.loops.time_domain.signal import Signal


class SignalViews:
    """Methods of `Signal` that only show what other methods know."""

    @property
    def _signal(self) -> Signal:
        return cast("Signal", self)

    def summary(self, band: float = 0.02) -> SignalSummary:
        """Return all metrics in one record; ``nan`` where one does not exist.

        Parameters
        ----------
        band
            Half-width of the settling band, a fraction of the final value.
        """
        return summarize_signal(self._signal, band)

    def total_variation(self) -> float:
        """Return the sum of all ups and downs, jumps with their height; the signal is zero before t = 0."""
        return total_variation(self._signal)

    def to_frame(self, times: ArrayLike | None = None) -> pd.DataFrame:
        """Return a pandas data frame with the index ``t`` and the column ``value``.

        Parameters
        ----------
        times : array
            Times within the horizon; by default 501 equally spaced ones.
        """
        return signal_frame(self._signal, times)

    @property
    def _identity(self) -> tuple[object, ...]:
        signal = self._signal
        shape = signal.coefficients.shape
        return signal.breaks.tobytes(), signal.coefficients.tobytes(), shape, comparable(signal.final)

    def __eq__(self, other: object) -> bool:
        """Compare pieces and final value."""
        return self._identity == other._identity if isinstance(other, SignalViews) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._identity)

    def __repr__(self) -> str:
        signal = self._signal
        pieces = signal.breaks.size - 1
        return f"<{type(self).__name__} on [0, {signal.horizon:g}], {pieces} pieces, final {signal.final:g}>"

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()
