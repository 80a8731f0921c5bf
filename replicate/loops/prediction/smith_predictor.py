r"""The Smith predictor: a controller that acts on what a model says the output would be without dead time.

With the model :math:`\hat G = \hat G_0 e^{-s\hat L}` the measurement becomes :math:`y + (\hat G_0 - \hat G) u`, so that

.. math:: C_{eq} = \frac{C}{1 + C (\hat G_0 - \hat G)}, \qquad
          1 + C_{eq} G = \frac{1 + C (G + \hat G_0 - \hat G)}{1 + C (\hat G_0 - \hat G)} .

The closed loop is that of C around :math:`G + \hat G_0 - \hat G`, a plant with up to three dead times, and equals the
loop without dead time where model and plant agree. The model is computed from the control signal alone; its poles, and
the plant's where they agree, remain poles of the closed loop, which a load excites.

References
----------
O. J. M. Smith, "Closer control of loops with dead time", Chem. Eng. Progress 53 (1957) 217.
J. E. Normey-Rico and E. F. Camacho, "Control of Dead-time Processes" (2007), chapter 5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.evaluation import quotient, values
from replicate.loops.plant import Plant
from replicate.loops.plants.sum_plant import sum_of

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class SmithPredictor:
    """A PI or PID controller with the model of a plant in front of it; `Loop` takes it as its controller.

    Parameters
    ----------
    controller : PI or PID
        The primary controller, usually designed for the model without dead time.
    model : Plant
        A rational model with one dead time.

    Raises
    ------
    LoopError
        If the controller is not a PI or PID, or the model not a rational plant with one dead time.

    Examples
    --------
    Where model and plant agree, the set-point response is that of the loop without dead time, delayed:

    >>> from replicate.loops import PI, Loop
    >>> plant = Plant.foptd(1.0, 1.0, 2.0)
    >>> loop = Loop(plant, SmithPredictor(PI(3.0, 3.0), model=plant))
    >>> y = loop.step(until=9.0)
    >>> round(float(y(2.5)), 12) == round(1.0 - float(np.exp(-3.0 * 0.5)), 12)
    True
    """

    controller: PID
    model: Plant

    def __post_init__(self) -> None:
        checks.instance("the controller of a Smith predictor", self.controller, PID, "a PI or PID")
        checks.instance("the model of a Smith predictor", self.model, Plant, "a Plant")
        if not self.model.is_rational:
            msg = f"the model of a Smith predictor must be a rational plant with one dead time, not {self.model!r}"
            raise LoopError(msg)

    @property
    def difference(self) -> Plant | None:
        """The model without its dead time minus the model; None if it has no dead time."""
        if not self.model.dead_time:
            return None
        return sum_of([Plant(self.model.num, self.model.den), -self.model])

    @property
    def k(self) -> float:
        """The proportional gain of the primary controller."""
        return self.controller.k

    @property
    def ki(self) -> float:
        """The integral gain of the primary controller."""
        return self.controller.ki

    @property
    def kd(self) -> float:
        """The derivative gain of the primary controller."""
        return self.controller.kd

    def setpoint_filter_polynomials(self) -> tuple[Array, Array]:
        """Return (num, den) of the primary controller's set-point filter."""
        return self.controller.setpoint_filter_polynomials()

    def measurement_filter_polynomials(self) -> tuple[Array, Array]:
        """Return (num, den) of the primary controller's measurement filter."""
        return self.controller.measurement_filter_polynomials()

    def feedback(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the transfer function from -y to u.

        Parameters
        ----------
        s
            Complex frequencies, any shape.
        """
        return values(lambda s: quotient(np.ones_like(s), self._inverse(s)), s)

    def feedforward(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the transfer function from r to u.

        Parameters
        ----------
        s
            Complex frequencies, any shape.
        """
        return values(lambda s: self.controller.feedforward(s) / (self.controller.feedback(s) * self._inverse(s)), s)

    def _inverse(self, s: ComplexArray) -> ComplexArray:
        """Return one over the feedback: 1/C + what the model adds."""
        primary = self.controller.feedback(s)
        difference = self.difference
        inner = difference(s) if difference is not None else 0.0
        return np.asarray(quotient(np.ones_like(s), primary) + inner)

    def __repr__(self) -> str:
        return f"SmithPredictor({self.controller!r}, model={self.model!r})"
