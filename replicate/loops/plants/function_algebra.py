"""Functions made of plants: sums, products and changes of units that are equal, shown and stored by their parts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from replicate.loops.plant import Plant
    from replicate.loops.plants.function_plant import FunctionPlant

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Sum:
    """The sum of plants, times exp(s L) of the shortest of their dead times."""

    plants: tuple[Plant, ...]

    @property
    def dead_time(self) -> float:
        """The shortest dead time, L."""
        return min(plant.dead_time for plant in self.plants)

    def __call__(self, s: ComplexArray) -> ComplexArray:
        """Evaluate at complex ``s`` of any shape."""
        shortest = self.dead_time
        first, *others = (plant.delay_free(s) * np.exp(-s * (plant.dead_time - shortest)) for plant in self.plants)
        return np.asarray(sum(others, first))


@dataclass(frozen=True)
class Product:
    """Two plants in series, without their dead times."""

    first: Plant
    second: Plant

    def __call__(self, s: ComplexArray) -> ComplexArray:
        """Evaluate at complex ``s`` of any shape."""
        return np.asarray(self.first.delay_free(s) * self.second.delay_free(s))


@dataclass(frozen=True)
class Rescaled:
    """A plant in another unit of time and of gain, without its dead time."""

    plant: FunctionPlant
    time: float
    gain: float

    def __call__(self, s: ComplexArray) -> ComplexArray:
        """Evaluate at complex ``s`` of any shape."""
        return np.asarray(self.plant.function(np.asarray(s) / self.time) / self.gain)
