"""The record of a peak: its value as a number, and where it is reached."""

from __future__ import annotations

from typing import Self


class _Located(float):
    """A number that also knows where it was found."""

    _where: float

    def __new__(cls, value: float, where: float) -> Self:
        located = super().__new__(cls, value)
        located._where = where
        return located

    @property
    def value(self) -> float:
        """The number alone, as a plain float."""
        return float(self)

    def __getnewargs__(self) -> tuple[float, float]:  # type: ignore[override]
        return float(self), self._where


class Peak(_Located):
    """The value of an extremum of a time response; a float that also knows when it is reached.

    Parameters
    ----------
    value
        The extremum itself.
    where
        Its time.

    Attributes
    ----------
    value : float
        The extremum itself.
    time : float
        When it is reached.
    """

    @property
    def time(self) -> float:
        """When the extremum is reached."""
        return self._where


class FrequencyPeak(_Located):
    """The peak of a frequency response; a float that also knows its frequency.

    Parameters
    ----------
    value
        The peak itself.
    where
        Its frequency.

    Attributes
    ----------
    value : float
        The peak itself.
    frequency : float
        Where it is reached, rad per unit of time; ``inf`` if only in the limit, 0 if at steady state.
    """

    @property
    def frequency(self) -> float:
        """Where the peak is reached, rad per unit of time."""
        return self._where
