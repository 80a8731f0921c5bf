"""The result of a sweep: arrays by metric, and the tables they make."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.records import Record

if TYPE_CHECKING:
    import pandas as pd

GRID, PAIRWISE = "grid", "pairwise"


@dataclass(frozen=True, eq=False)
class SweepResult(Record):
    """The metrics of all loops of a sweep.

    ``result["overshoot"]`` is the array of a metric; ``result["stable"]`` is always there.

    Attributes
    ----------
    pairing
        ``grid`` or ``pairwise``.
    plants, controllers
        Labels along the two sides of the grid, or of each pair.
    metrics
        The names asked for, in that order.
    values
        The arrays by name, shape (plants, controllers) of a grid and (pairs,) of pairs: float, complex for
        ``rightmost_pole``, bool for ``stable``.
    reason
        Text of the same shape: why a loop lacks values (they are ``nan``); empty where nothing is missing.
    """

    pairing: str
    plants: list[Any]
    controllers: list[Any]
    metrics: tuple[str, ...]
    values: dict[str, NDArray[Any]]
    reason: NDArray[np.object_]

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of every array."""
        return self.reason.shape

    def __len__(self) -> int:
        return int(self.reason.size)

    def __contains__(self, metric: object) -> bool:
        return metric in tuple(self.values)  # by equality: a list has no hash

    def __getitem__(self, metric: str) -> NDArray[Any]:
        """Return the array of one metric; LoopError if it was not asked for."""
        if metric not in self:
            msg = f"the sweep has no metric {checks.shown(metric)}: it has {', '.join(self.values)}"
            raise LoopError(msg)
        return self.values[metric]

    def to_frame(self) -> pd.DataFrame:
        """Return one row for each loop: index (plant, controller), columns the metrics, ``stable`` and ``reason``."""
        import pandas as pd

        if self.pairing == GRID:
            index = pd.MultiIndex.from_product([self.plants, self.controllers], names=["plant", "controller"])
        else:
            index = pd.MultiIndex.from_arrays([self.plants, self.controllers], names=["plant", "controller"])
        columns: dict[str, Any] = {name: array.ravel() for name, array in self.values.items()}
        return pd.DataFrame({**columns, "reason": self.reason.ravel()}, index=index)

    def to_xarray(self) -> Any:
        """Return the arrays as an xarray dataset with the dimensions ``plant`` and ``controller``, or ``pair``.

        Raises
        ------
        LoopError
            If xarray is not installed.
        """
        try:
            xr = import_module("xarray")
        except ImportError:
            msg = "to_xarray needs xarray, which is not installed: pip install xarray"
            raise LoopError(msg) from None
        if self.pairing == GRID:
            dims: tuple[str, ...] = ("plant", "controller")
            along = dims
        else:
            dims = ("pair",)
            along = dims * 2
        coordinates = {
            "plant": (along[0], _one_dimensional(self.plants)),
            "controller": (along[1], _one_dimensional(self.controllers)),
        }
        arrays: dict[str, Any] = {name: (dims, array) for name, array in self.values.items()}
        return xr.Dataset({**arrays, "reason": (dims, self.reason)}, coords=coordinates)

    def __repr__(self) -> str:
        missing = int(np.sum(self.reason != ""))
        size = " x ".join(str(n) for n in self.shape)
        return f"SweepResult({self.pairing}, {size} loops, {missing} with values missing: {', '.join(self.metrics)})"


def _one_dimensional(labels: list[Any]) -> Any:
    """Return labels as xarray takes them for one dimension, also the tuples of a frame with several levels."""
    if not any(isinstance(label, tuple) for label in labels):
        return labels
    array = np.empty(len(labels), dtype=object)
    array[:] = labels
    return array
