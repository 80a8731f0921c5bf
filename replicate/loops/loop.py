"""The feedback loop: the one object that answers questions about a plant under a controller."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import inversion, margins, method_of_steps, poles, sensitivity, stability
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError, UnstableLoopError
from replicate.loops.loop_transfer import LoopTransfer
from replicate.loops.margins import Margins
from replicate.loops.peaks import FrequencyPeak
from replicate.loops.plant import Plant
from replicate.loops.signal import Signal

ComplexArray = NDArray[np.complex128]

TAIL = 1e13  # time constants of the slowest mode after which an algebraic tail no longer counts
SETTLED = 34.0  # time constants of the slowest mode until it has decayed to rounding, exp(-34) = 2e-15


@dataclass(frozen=True)
class Response:
    """Output and control signal of one experiment.

    Attributes
    ----------
    output
        The plant output y.
    control
        The control signal u.
    """

    output: Signal
    control: Signal


class Loop:
    """A plant under feedback by a PI or PID controller, dead time exact.

    Parameters
    ----------
    plant : Plant
    controller : PI or PID

    Raises
    ------
    ImproperLoopError
        If the loop gain grows without bound at high frequency.

    Examples
    --------
    Twice an integrator with unit dead time under unit feedback: y = 2 (t - 1) on the second interval.

    >>> from replicate.loops import PI
    >>> loop = Loop(Plant([2.0], [1.0, 0.0], dead_time=1.0), PI(k=0.25))
    >>> loop.is_stable()
    True
    >>> y = loop.step(until=2.0)
    >>> round(float(y(1.5)), 12)
    0.25
    """

    def __init__(self, plant: Plant, controller: PID) -> None:
        self.plant = plant
        self.controller = controller
        self.transfer = LoopTransfer.of(plant, controller)

    def __call__(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the loop transfer function L(s) = C(s) G(s)."""
        return self.transfer(s)

    # ---- stability ------------------------------------------------------------------------------------------------

    @cached_property
    def _stable(self) -> bool:
        return stability.is_stable(self.transfer)

    def is_stable(self) -> bool:
        """Return whether all closed-loop poles are in the open left half-plane, by the argument principle."""
        return self._stable

    def unstable_poles(self) -> int:
        """Return the number of closed-loop poles in the closed right half-plane."""
        return stability.unstable_poles(self.transfer)

    @cached_property
    def _poles(self) -> ComplexArray:
        return poles.rightmost_poles(self.plant, self.controller, self.transfer, count=4)

    def rightmost_pole(self) -> complex:
        """Return the closed-loop pole with the largest real part (of a pair the one with Im > 0).

        Modes that cancel in the set-point response (plant poles cancelled by controller zeros) are included.
        """
        if self._poles.size == 0:
            msg = "a static loop has no poles; give a horizon to get its response"
            raise LoopError(msg)
        return complex(self._poles[0])

    def poles(self, count: int = 4) -> ComplexArray:
        """Return up to ``count`` rightmost closed-loop poles, descending real part, one of each conjugate pair."""
        if count < 1:
            msg = f"the number of poles must be at least 1, not {count}"
            raise LoopError(msg)
        return poles.rightmost_poles(self.plant, self.controller, self.transfer, count=count)

    def _require_stable(self, what: str) -> None:
        if not self._stable:
            msg = f"the loop is unstable: it has no {what}"
            raise UnstableLoopError(msg)

    # ---- frequency domain -----------------------------------------------------------------------------------------

    def sensitivity_peak(self) -> FrequencyPeak:
        """Return Ms = max |1/(1+L)| with its frequency.

        Raises
        ------
        UnstableLoopError
            If the loop is unstable.
        """
        self._require_stable("sensitivity peak")
        return sensitivity.sensitivity_peak(self.transfer, self._poles)

    def complementary_peak(self) -> FrequencyPeak:
        """Return Mp = max |L/(1+L)| with its frequency; UnstableLoopError if the loop is unstable."""
        self._require_stable("complementary sensitivity peak")
        return sensitivity.complementary_peak(self.transfer, self._poles)

    def margins(self) -> Margins:
        """Return gain, phase (degrees) and delay margin with their frequencies; UnstableLoopError if unstable."""
        self._require_stable("stability margins")
        return margins.margins(self.transfer)

    # ---- time domain ----------------------------------------------------------------------------------------------

    def horizon(self) -> float:
        """Return the time after which every closed-loop mode has decayed to rounding.

        Raises
        ------
        UnstableLoopError
            If the loop is unstable.
        """
        self._require_stable("settling horizon")
        if not self.plant.is_rational:
            # a branch point at s = 0 leaves an algebraic tail; pieces grow geometrically, so a long horizon is cheap
            return TAIL / abs(self.rightmost_pole().real)
        return SETTLED / self._slowest_decay() + 4.0 * self.plant.dead_time

    def _slowest_decay(self) -> float:
        """Return the decay rate of the slowest mode: of the loop, of its neutral tail, or of the set-point filter."""
        rates = [abs(self.rightmost_pole().real), *(-np.roots(self.controller.setpoint_filter_polynomials()[1]).real)]
        if self.plant.dead_time and self.transfer.feedthrough:  # the poles' real parts tend to this far from the axis
            rates.append(-np.log(self.transfer.feedthrough) / self.plant.dead_time)
        return float(min(rates))

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
        return self.respond(until=until).output

    def load_step(self, until: float | None = None) -> Signal:
        """Return the output after a unit step at the plant input, before the dead time, at t = 0.

        Parameters
        ----------
        until
            Time until which the response is computed; default: when it has settled.
        """
        return self.respond(setpoint=0.0, load=1.0, until=until).output

    def respond(
        self, *, setpoint: float = 1.0, load: float = 0.0, load_at: float = 0.0, until: float | None = None
    ) -> Response:
        """Return output and control signal for a set-point step at t = 0 and a load step at t = ``load_at``.

        Impulses in the control signal (an ideal derivative acting on the set-point step, weight c) act on the plant but
        are not part of the returned control signal.

        Parameters
        ----------
        setpoint, load
            Heights of the two steps; 0 for none.
        load_at
            Time of the load step, at the plant input before the dead time.
        until
            Time until which the responses are computed; default: when they have settled.

        Raises
        ------
        UnstableLoopError
            If no horizon is given and the loop is unstable.
        """
        end = load_at + self.horizon() if until is None else float(until)
        if not 0.0 < end < np.inf:
            msg = f"the horizon must be positive and finite, not {end:g}"
            raise LoopError(msg)
        for name, value in (("setpoint", setpoint), ("load", load)):
            if not np.isfinite(value):
                msg = f"the {name} step must be a finite number, not {value}"
                raise LoopError(msg)
        if load_at < 0.0 or load_at >= end:
            msg = f"the load step must come within the horizon, 0 <= load_at < {end:g}, not at {load_at:g}"
            raise LoopError(msg)
        if load and load_at:
            base = self.respond(setpoint=setpoint, until=end)
            added = self.respond(setpoint=0.0, load=load, until=end - load_at)
            return Response(base.output + added.output.delayed(load_at), base.control + added.control.delayed(load_at))
        if not self.plant.is_rational:
            return self._respond_by_inversion(setpoint, load, end)
        length, y, u = method_of_steps.respond(self.plant, [self.controller], end, setpoint=setpoint, load=load)
        return Response(*self._signals(length, y[0], u[0], end, setpoint, load))

    def _signals(
        self, length: float, y: NDArray[np.float64], u: NDArray[np.float64], end: float, setpoint: float, load: float
    ) -> tuple[Signal, Signal]:
        final_y, final_u = self.steady_state(setpoint, load)
        return (
            Signal.from_pieces(length, y, end, final=final_y, stable=self.is_stable),
            Signal.from_pieces(length, u, end, final=final_u, stable=self.is_stable),
        )

    def steady_state(self, setpoint: float, load: float) -> tuple[float, float]:
        """Return the steady-state values of output and control signal for the given set-point and load steps.

        Parameters
        ----------
        setpoint, load
            Heights of the two steps.
        """
        gain = self.plant.gain
        num, den = self.controller.setpoint_filter_polynomials()
        reference = setpoint * float(num[-1] / den[-1])
        if self.controller.ki:
            if not self.plant.is_rational or self.plant.num[-1]:
                output = reference
                return output, (output / gain if gain else float("nan")) - load
            return float("nan"), float("nan")
        k = self.controller.k
        if np.isinf(gain):  # the integrator's input vanishes: u = -load
            return (self.controller.b * reference + load / k if k else float("nan")), -load
        output = gain * (k * self.controller.b * reference + load) / (1.0 + gain * k)
        return output, k * (self.controller.b * reference - output)

    def _respond_by_inversion(self, setpoint: float, load: float, end: float) -> Response:
        plant, controller = self.plant, self.controller

        def forward(s: ArrayLike) -> ComplexArray:
            s = np.asarray(s, dtype=complex)
            return np.asarray((setpoint * controller.feedforward(s) + load) * plant.delay_free(s) / s)

        closed = inversion.ClosedLoop(self.transfer, forward, self.poles(count=8))
        breaks, coefficients = inversion.respond(closed, end, 1.0 / abs(self.rightmost_pole().real))
        final_y, final_u = self.steady_state(setpoint, load)
        output = Signal(breaks, coefficients, final=final_y, stable=self.is_stable)
        return Response(output, _control_from_output(controller, output, setpoint, final_u))

    def __repr__(self) -> str:
        return f"Loop({self.plant!r}, {self.controller!r})"


def _control_from_output(controller: PID, output: Signal, setpoint: float, final: float) -> Signal:
    """Return u of a controller without filters, computed from y itself."""
    num, den = controller.setpoint_filter_polynomials()
    if controller.derivative_filter or controller.measurement_filter or den.size > 1 or num.size > 1:
        msg = "the control signal of a plant given by a function is available for controllers without filters only"
        raise LoopError(msg)
    error = output * -1.0
    error.coefficients[:, 0] += setpoint
    control = error.antiderivative() * controller.ki
    proportional = output * -controller.k
    proportional.coefficients[:, 0] += controller.k * controller.b * setpoint
    control = control + proportional
    if controller.kd:
        control = control + output.derivative() * -controller.kd
    return Signal(control.breaks, control.coefficients, final=final, stable=output.stable)


def step_responses(
    plant: Plant, controllers: Sequence[PID], until: float, *, setpoint: float = 1.0, load: float = 0.0
) -> list[Signal]:
    """Return the outputs of one rational plant under many controllers that differ only in their gains.

    With dead time all loops advance together: one matrix product per dead-time interval for the whole sweep.

    Parameters
    ----------
    plant
        A rational plant.
    controllers
        The controllers.
    until
        Time until which the responses are computed.
    setpoint, load
        Heights of the steps of the set point and, at the plant input, of the load.

    Raises
    ------
    LoopError
        If the controllers differ in more than k, ki, kd and b.
    """
    if not controllers:
        return []
    length, y, _ = method_of_steps.respond(plant, list(controllers), until, setpoint=setpoint, load=load)
    signals = []
    for controller, coefficients in zip(controllers, y, strict=True):
        loop = Loop(plant, controller)
        final, _ = loop.steady_state(setpoint, load)
        signals.append(Signal.from_pieces(length, coefficients, until, final=final, stable=loop.is_stable))
    return signals
