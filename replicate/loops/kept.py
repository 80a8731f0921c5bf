"""Results that depend on few numbers, kept for the next loop that needs the same."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

T = TypeVar("T")


class Kept(Generic[T]):
    """A bounded memory of results by key; forgets all when it is full.

    Parameters
    ----------
    most
        The number of results that are kept.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._results: dict[Hashable, T] = {}

    def get(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return the result for a key, made once.

        Parameters
        ----------
        key
            All numbers that the result depends on.
        make
            Makes the result.
        """
        known = self._results.get(key)
        if known is None:
            known = make()
            if len(self._results) >= self._most:
                self._results = {}
            self._results[key] = known
        return known
