"""What one asks a plant to be shown as, and when two are equal."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any, cast

from replicate.loops.errors import LoopError

if TYPE_CHECKING:
    from replicate.loops.plant import Plant


class PlantViews:
    """Methods of `Plant` that only show what it is."""

    @property
    def _plant(self) -> Plant:
        return cast("Plant", self)

    def notation(self) -> str:
        """Return the plant as a text from which `replicate.loops.notation.parse_plant` gives the same plant."""
        from replicate.loops.notation import plant_notation

        return plant_notation(self._plant)

    def to_control(self, pade: int | None = None) -> Any:
        """Return the plant as a python-control transfer function.

        Parameters
        ----------
        pade
            Order of the Padé approximation of the dead time; needed if there is one.
        """
        from replicate.loops.to_control import plant_to_control

        return plant_to_control(self._plant, pade)

    def identity(self) -> tuple[object, ...]:
        """Return what tells one plant from another: coefficients, dead times, or the function."""
        plant = self._plant
        if plant.is_rational:
            return (tuple(plant.num.tolist()), tuple(plant.den.tolist()), plant.dead_time)
        if plant.parts:
            return tuple(part.identity() for part in plant.parts)
        return (plant.function, plant.dead_time)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, PlantViews):
            return NotImplemented
        return self.identity() == other.identity()

    def __hash__(self) -> int:
        return hash(self.identity())

    def _repr_html_(self) -> str:
        try:
            text = self.notation()
        except LoopError:  # a Python function has no text
            text = repr(self)
        return f"<code>{html.escape(text)}</code>"
