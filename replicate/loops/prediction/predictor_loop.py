"""A plant under a Smith predictor: the loop that `Loop` makes when its controller is one."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.closed_loop_poles import poles
from replicate.loops.errors import LoopError
from replicate.loops.frequency_domain import stability
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.plants.sum_plant import roots_without, sum_of
from replicate.loops.prediction.predictor_transfer import PredictorTransfer
from replicate.loops.prediction.smith_predictor import SmithPredictor
from replicate.loops.time_domain import adaptive_steps
from replicate.loops.time_domain.chain import OpenLoop, open_loop_of_spaces
from replicate.loops.time_domain.slow_modes import Pieces
from replicate.loops.to_control import Kind
from replicate.loops.units import Units

if TYPE_CHECKING:
    from replicate.loops.controller import PID

ComplexArray = NDArray[np.complex128]


class PredictorLoop(Loop):
    """A plant under a Smith predictor, model and plant different or equal, all dead times exact.

    Parameters
    ----------
    plant : Plant
        Rational, with any number of dead times.
    controller : SmithPredictor

    Raises
    ------
    LoopError
        If the plant is given by a function.
    ImproperLoopError
        If the loop gain does not vanish at high frequency.
    """

    def __init__(self, plant: Plant, controller: SmithPredictor) -> None:
        checks.instance("the plant of a loop", plant, Plant, "a Plant (Plant.from_control makes one)")
        if not plant.parts:
            msg = "a Smith predictor needs a rational plant with dead times, not one given by a function"
            raise LoopError(msg)
        self.plant = plant
        self.controller = controller  # type: ignore[assignment]
        self.predictor = controller
        self._units = Units.of(plant, controller.controller)
        self._plant, self._controller = self._units.plant(plant), self._units.controller(controller.controller)
        scaled = SmithPredictor(self._controller, self._units.plant(controller.model))
        self._difference = scaled.difference
        self._transfer = self._loop_transfer(self._plant, self._controller, self._difference)
        # the loop around plant and model together has the poles of the whole
        self._together = (
            sum_of([*self._plant.parts, *self._difference.parts]) if self._difference is not None else self._plant
        )
        self._whole = LoopTransfer.of(self._together, self._controller)

    @staticmethod
    def _loop_transfer(plant: Plant, primary: PID, difference: Plant | None) -> LoopTransfer:
        if difference is None:
            return LoopTransfer.of(plant, primary)
        return PredictorTransfer.of_difference(plant, primary, difference)

    @cached_property
    def transfer(self) -> LoopTransfer:
        """The loop transfer function, in the units of the plant."""
        return self._loop_transfer(self.plant, self.predictor.controller, self.predictor.difference)

    @property
    def primary_controller(self) -> PID:
        """The PI or PID controller without the model."""
        return self.predictor.controller

    def with_primary(self, controller: PID) -> Loop:
        """Return the loop of the same plant and model with another PI or PID controller.

        Parameters
        ----------
        controller : PI or PID
            Takes the place of `primary_controller`.
        """
        return PredictorLoop(self.plant, SmithPredictor(controller, self.predictor.model))

    def to_control(self, pade: int | None = None, response: Kind = "setpoint") -> Any:  # noqa: ARG002
        """Refuse: a Smith predictor has dead times inside; LoopError always.

        Parameters
        ----------
        pade, response
            As for `Loop.to_control`.
        """
        msg = "only a loop with a PI or PID controller becomes a transfer function, not one with a Smith predictor"
        raise LoopError(msg)

    # ---- stability ------------------------------------------------------------------------------------------------

    @cached_property
    def _hidden(self) -> ComplexArray:
        """Poles of plant and model that feedback does not move."""
        if self._difference is None:
            return np.empty(0, dtype=complex)
        both = np.concatenate([self._plant.poles(), self._difference.poles()])
        hidden = roots_without(both, self._together.poles())
        return hidden[hidden.imag >= 0.0]

    @cached_property
    def _stable(self) -> bool:
        return bool(np.all(self._hidden.real < 0.0)) and stability.is_stable(self._whole)

    def unstable_poles(self) -> int:
        """Return the number of closed-loop poles in the closed right half-plane, hidden ones included."""
        hidden = self._hidden[self._hidden.real >= 0.0]
        return stability.unstable_poles(self._whole) + int(hidden.size + np.sum(hidden.imag > 0.0))

    def _found(self, count: int) -> ComplexArray:
        moved = poles.rightmost_poles(self._together, self._controller, self._whole, count=count)
        return poles.merged(moved, self._hidden, count)

    _proven = None  # hidden poles belong to the loop, too

    @property
    def _longest(self) -> float:
        return max(part.dead_time for part in (*self.plant.parts, self.predictor.model))

    # ---- time domain ----------------------------------------------------------------------------------------------

    def open_loop(self) -> tuple[Units, OpenLoop]:
        """Return the chain of plant and model side by side; the output is the plant's alone."""
        return self._units, open_loop_of_spaces(self._plant, self._difference, self._controller)

    def _marched(self, setpoint: float, load: float, end: float) -> Pieces:
        units, parts = self.open_loop()
        loads = load * parts.loaded
        return adaptive_steps.march(
            parts.chain, parts.gains, parts.delays, end, setpoint=setpoint, loads=loads, unit=units.time
        )

    @property
    def _inner_gain(self) -> float:
        difference = self.predictor.difference
        return difference.gain if difference is not None else 0.0
