"""What a library has to offer to be measured, and the measurement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from replicate.loops.conformance.digits import Quantity, digits
from replicate.loops.conformance.goldens import Golden


class Library(Protocol):
    """An adapter: one small file that asks a library for the values of a loop."""

    @property
    def title(self) -> str:
        """Name and version of the library."""

    @property
    def settings(self) -> Sequence[str]:
        """Ways to use it that are measured side by side, such as orders of the Padé approximation."""

    def values(self, golden: Golden, setting: str) -> Mapping[str, float | complex]:
        """Return what the library finds, by the names of `Golden.quantities`; what it cannot do is left out."""


def measure(library: Library, golden: Golden, setting: str) -> dict[Quantity, float | None]:
    """Return the digits of every value that the library offers; None for those that it does not."""
    found = library.values(golden, setting)
    return {
        quantity: digits(quantity, found[quantity.name]) if quantity.name in found else None
        for quantity in golden.quantities()
    }
