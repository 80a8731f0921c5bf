"""What one asks a loop to be shown as: summaries, frequency responses, python-control systems, text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from replicate.loops.frequency_domain import frequency_response
from replicate.loops.frequency_domain.frequency_response import Bode, ComplexArray
from replicate.loops.saturation.limited_response import LimitedViews
from replicate.loops.summary import LoopSummary, summarize_loop
from replicate.loops.to_control import Kind, loop_to_control

if TYPE_CHECKING:
    from replicate.loops.controller import PID
    from replicate.loops.experiments import Given
    from replicate.loops.loop import Loop
    from replicate.loops.time_domain.signal import Response, Signal


class LoopViews(LimitedViews):
    """Methods of `Loop` that only show what other methods know."""

    def __repr__(self) -> str:
        return f"Loop({self._loop.plant!r}, {self._loop.controller!r})"

    @property
    def primary_controller(self) -> PID:
        """The PI or PID controller, that of a Smith predictor without its model."""
        return self._loop.controller

    def with_primary(self, controller: PID) -> Loop:
        """Return the same loop with another PI or PID controller.

        Parameters
        ----------
        controller : PI or PID
            Takes the place of `primary_controller`.
        """
        return type(self._loop)(self._loop.plant, controller)

    def step(self, until: float | None = None) -> Signal:
        """Return the output after a unit step of the set-point at t = 0, at rest before.

        Parameters
        ----------
        until
            Horizon; by default the time at which every mode has decayed to rounding.

        Raises
        ------
        UnstableLoopError
            If no horizon is given and the loop is unstable.
        """
        return self._loop.respond(until=until).output

    def load_step(self, until: float | None = None) -> Signal:
        """Return the output after a unit step at the plant input, before the dead time, at t = 0.

        Parameters
        ----------
        until
            Time until which the response is computed; default: when it has settled.
        """
        return self._loop.respond(setpoint=0.0, load=1.0, until=until).output

    def summary(self) -> LoopSummary:
        """Return stability, peaks, margins, and the metrics of the step and load responses in one record."""
        return summarize_loop(self._loop)

    def bode(self, w: ArrayLike) -> Bode:
        """Return magnitude and continuous phase of L(i w).

        Parameters
        ----------
        w : array
            Frequencies > 0, rad per unit of time, in any order.
        """
        return frequency_response.bode(self._loop, w)

    def nyquist(self, w: ArrayLike) -> ComplexArray:
        """Return the points L(i w) of the Nyquist curve.

        Parameters
        ----------
        w : array
            Frequencies > 0, rad per unit of time, in any order.
        """
        return frequency_response.nyquist(self._loop, w)

    def S(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the sensitivity 1/(1 + L).

        Parameters
        ----------
        s : array
            Complex numbers; ``1j * w`` for a frequency response.
        """
        return frequency_response.sensitivity(self._loop, s)

    def T(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the complementary sensitivity L/(1 + L).

        Parameters
        ----------
        s : array
            Complex numbers.
        """
        return frequency_response.complementary(self._loop, s)

    def PS(self, s: ArrayLike) -> ComplexArray:
        """Evaluate P/(1 + L), from a load at the plant input to the output.

        Parameters
        ----------
        s : array
            Complex numbers.
        """
        return frequency_response.load_sensitivity(self._loop, s)

    def CS(self, s: ArrayLike) -> ComplexArray:
        """Evaluate C/(1 + L), from noise to the control signal, with the sign changed.

        Parameters
        ----------
        s : array
            Complex numbers.
        """
        return frequency_response.noise_sensitivity(self._loop, s)

    def respond_to(
        self,
        *,
        setpoint: Given = 0.0,
        load: Given = 0.0,
        output: Given = 0.0,
        noise: Given = 0.0,
        until: float | None = None,
    ) -> Response:
        """Return output and control signal for steps, ramps, pulses, sines and other inputs.

        Parameters
        ----------
        setpoint, load, output, noise
            A number (a step at t = 0), one of `replicate.loops.inputs`, or several: the set-point, a load at the plant
            input, a disturbance of the output, noise on its measurement.
        until
            Horizon; by default the last event plus the time in which every mode decays.
        """
        from replicate.loops.experiments import respond_to

        return respond_to(self._loop, setpoint=setpoint, load=load, output=output, noise=noise, until=until)

    def to_control(self, pade: int | None = None, response: Kind = "setpoint") -> Any:
        """Return the closed loop as a python-control transfer function.

        Parameters
        ----------
        pade
            Order of the Padé approximation of the dead time.
        response
            From the ``setpoint`` or from a ``load`` at the plant input to the output, or the open ``loop`` L.
        """
        return loop_to_control(self._loop, pade, response)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, LoopViews):
            return NotImplemented
        return self._loop.plant == other._loop.plant and self._loop.controller == other._loop.controller

    def __hash__(self) -> int:
        return hash((self._loop.plant, self._loop.controller))

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()
