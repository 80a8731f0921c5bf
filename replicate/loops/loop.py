"""The feedback loop: the one object that answers questions about a plant under a controller."""

from __future__ import annotations

from functools import cached_property, partial
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.closed_loop_poles import poles
from replicate.loops.closed_loop_poles.proven_pole import proven_pole_with_others
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError, UnstableLoopError
from replicate.loops.evaluation import INFINITE, values
from replicate.loops.frequency_domain import margins, sensitivity, stability
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.frequency_domain.margins import Margins
from replicate.loops.loop_views import LoopViews
from replicate.loops.numerics.peaks import FrequencyPeak
from replicate.loops.numerics.polynomials import roots_of, trimmed
from replicate.loops.plant import Plant
from replicate.loops.plants.function_plant import FunctionPlant
from replicate.loops.prediction.smith_predictor import SmithPredictor
from replicate.loops.set_once import SetOnce
from replicate.loops.time_domain import function_responses
from replicate.loops.time_domain.chain import OpenLoop, open_loop_of
from replicate.loops.time_domain.responses import held, responses
from replicate.loops.time_domain.signal import Response, Signal
from replicate.loops.time_domain.slow_modes import SETTLED, Pieces, slow_groups, with_slow_end
from replicate.loops.time_domain.slow_signal import SlowSignal
from replicate.loops.time_domain.steady_state import steady_state
from replicate.loops.units import Units

ComplexArray = NDArray[np.complex128]

TAIL = 1e13  # time constants of the slowest mode after which an algebraic tail no longer counts
LONG = 1e-7  # of such a horizon, from which on rounding errors would show in its integrals
FAR = 200.0  # horizon, in units of the loop's time, from which on it pays to ask when the response is at rest
CLEAR = 1e-6  # distance of a pole from the imaginary axis, relative to its modulus, that leaves no doubt


class Loop(LoopViews, SetOnce):
    """A plant under feedback by a PI or PID controller or a Smith predictor, dead time exact.

    Parameters
    ----------
    plant : Plant
    controller : PI, PID or SmithPredictor

    Raises
    ------
    ImproperLoopError
        If the loop gain grows without bound at high frequency.
    LoopError
        If the plant is not a Plant or the controller not a PI, PID or SmithPredictor.

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

    # a loop that is read back from a file or sent to another process is made without arguments
    def __new__(cls, plant: Plant | None = None, controller: PID | SmithPredictor | None = None) -> Self:  # noqa: ARG004
        """Make the loop of a Smith predictor where the controller is one."""
        if cls is Loop and isinstance(controller, SmithPredictor):
            from replicate.loops.prediction.predictor_loop import PredictorLoop

            return super().__new__(PredictorLoop)  # type: ignore[return-value]
        return super().__new__(cls)

    _difference: Plant | None = None  # what a predictor adds to the output in the measurement

    def __init__(self, plant: Plant, controller: PID | SmithPredictor) -> None:
        checks.instance("the plant of a loop", plant, Plant, "a Plant (Plant.from_control makes one)")
        checks.instance("the controller of a loop", controller, PID, "a PI, PID or SmithPredictor")
        assert isinstance(controller, PID)  # noqa: S101  -- just checked
        self.plant = plant
        self.controller = controller
        # everything is computed in units in which the loop's numbers are of the order of one
        self._units = Units.of(plant, controller)
        self._plant, self._controller = self._units.plant(plant), self._units.controller(controller)
        self._transfer = LoopTransfer.of(self._plant, self._controller)

    def __call__(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the loop transfer function L(s) = C(s) G(s): ``inf`` at a pole, ``nan`` at infinity."""
        found = values(lambda s: self._transfer(s * self._units.time), s)
        if np.isfinite(found).all():
            return found
        controller, plant = self.controller.feedback(s), self.plant(s)
        pole = (np.isinf(controller) & (plant != 0.0)) | (np.isinf(plant) & (controller != 0.0))
        return np.asarray(np.where(pole, INFINITE, found))

    @cached_property
    def transfer(self) -> LoopTransfer:
        """The loop transfer function, in the units of the plant."""
        return LoopTransfer.of(self.plant, self.controller)

    # ---- stability ------------------------------------------------------------------------------------------------

    @cached_property
    def _stable(self) -> bool:
        proven = self.__dict__.get("_proven")
        if proven and abs(proven[0].real) > CLEAR * abs(proven[0]):
            return bool(proven[0].real < 0.0)
        return stability.is_stable(self._transfer)

    def is_stable(self) -> bool:
        """Return whether all closed-loop poles are in the open left half-plane, by the argument principle."""
        return self._stable

    def unstable_poles(self) -> int:
        """Return the number of closed-loop poles in the closed right half-plane."""
        return stability.unstable_poles(self._transfer)

    def _found(self, count: int) -> ComplexArray:
        return poles.rightmost_poles(self._plant, self._controller, self._transfer, count=count)

    _poles = cached_property(lambda self: self._found(4))
    _proven = cached_property(lambda self: proven_pole_with_others(self._transfer))

    @property
    def _landmarks(self) -> ComplexArray:
        """The rightmost pole and some others that are close to the imaginary axis."""
        return self._poles if self._proven is None else np.array(self._proven)

    def rightmost_pole(self) -> complex:
        """Return the closed-loop pole with the largest real part (of a pair the one with Im > 0).

        Modes that cancel in the set-point response (plant poles cancelled by controller zeros) are included.

        Raises
        ------
        LoopError
            If there is none: the loop is static, or its plant is a function whose cut takes the place of poles.
        """
        if self._landmarks.size == 0:
            msg = "a static loop has no poles; give a horizon to get its response"
            if not self.plant.parts:
                msg = "the loop has no pole off the negative real axis, where its plant, a function, has a cut"
            raise LoopError(msg)
        return complex(self._landmarks[0] / self._units.time)

    def poles(self, count: int = 4) -> ComplexArray:
        """Return up to ``count`` rightmost closed-loop poles, descending real part, one of each conjugate pair.

        A multiple pole is listed once; of equal real parts the lowest frequency comes first; 10,000 is the most.
        """
        count = checks.whole("the number of poles", count, most=poles.MOST)
        return np.asarray(self._found(count) / self._units.time)

    def _require_stable(self, what: str) -> None:
        if not self._stable:
            msg = f"the loop is unstable: it has no {what}"
            raise UnstableLoopError(msg)

    def _require_stable_by_pole(self, what: str) -> None:
        self._proven  # noqa: B018  -- the rightmost pole, which is needed next, says whether the loop is stable
        self._require_stable(what)

    # ---- frequency domain -----------------------------------------------------------------------------------------

    def sensitivity_peak(self) -> FrequencyPeak:
        """Return Ms = max |1/(1+L)| with its frequency.

        Raises
        ------
        UnstableLoopError
            If the loop is unstable.
        """
        self._require_stable_by_pole("sensitivity peak")
        return self._peak(sensitivity.sensitivity_peak(self._transfer, self._landmarks))

    def closest_approach(self, center: float) -> FrequencyPeak:
        """Return max 1/|center + L|, the inverse of the distance of the Nyquist curve from -center, center >= 1.

        Parameters
        ----------
        center
            With 1 it is the sensitivity peak.

        Raises
        ------
        UnstableLoopError
            If the loop is unstable.
        """
        self._require_stable_by_pole("closest approach")
        center = checks.at_least(1.0, "center", center)
        return self._peak(sensitivity.sensitivity_peak(self._transfer, self._landmarks, center))

    def complementary_peak(self) -> FrequencyPeak:
        """Return Mp = max |L/(1+L)| with its frequency; UnstableLoopError if the loop is unstable."""
        self._require_stable_by_pole("complementary sensitivity peak")
        return self._peak(sensitivity.complementary_peak(self._transfer, self._landmarks))

    def _peak(self, scaled: FrequencyPeak) -> FrequencyPeak:
        return FrequencyPeak(scaled.value, scaled.frequency / self._units.time)

    def margins(self) -> Margins:
        """Return gain, phase (degrees) and delay margin with their frequencies; UnstableLoopError if unstable."""
        self._require_stable("stability margins")
        return margins.margins(self._transfer).in_time(self._units.time)

    # ---- time domain ----------------------------------------------------------------------------------------------

    def horizon(self) -> float:
        """Return the time after which every closed-loop mode has decayed to rounding.

        Raises
        ------
        UnstableLoopError
            If the loop is unstable.
        """
        self._require_stable_by_pole("settling horizon")
        if not self.plant.parts:
            # a branch point at s = 0 leaves an algebraic tail; pieces grow geometrically, so a long horizon is cheap
            lasting = SETTLED / self._decay if self._decay else TAIL * function_responses.pace(self._poles)
            return lasting * self._units.time + 4.0 * self._longest
        return SETTLED / self._slowest_decay() + 4.0 * self._longest

    @cached_property
    def _decay(self) -> float:
        return function_responses.decay(self._transfer, self._poles)

    @property
    def _longest(self) -> float:
        return max((part.dead_time for part in self.plant.parts), default=self.plant.dead_time)

    def _slowest_decay(self) -> float:
        """Return the decay rate of the slowest mode: of the loop, of its neutral tail, or of the set-point filter."""
        return float(np.min(-self._filter_poles.real, initial=min(-self.rightmost_pole().real, self._crowd)))

    @property
    def _filter_poles(self) -> ComplexArray:
        """The poles of the set-point filter."""
        return roots_of(trimmed(self.controller.setpoint_filter_polynomials()[1]))

    @property
    def _crowd(self) -> float:
        """The distance from the imaginary axis to which the poles of a neutral loop tend; else ``inf``."""
        feedthrough = self._transfer.feedthrough
        return float(-np.log(feedthrough)) / self._longest if self._longest and feedthrough else float("inf")

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
        setpoint = checks.finite("the setpoint step", setpoint)
        load = checks.finite("the load step", load)
        load_at = checks.non_negative("load_at", load_at, allowed="a time with 0 <= load_at < the horizon")
        if until is None:
            end = load_at + self.horizon()
        else:
            end = checks.positive("the horizon until", until, allowed="a finite time > 0")
        if load_at >= end:
            msg = f"the load step must come within the horizon, 0 <= load_at < {end:g}, not at {load_at:g}"
            raise LoopError(msg)
        if load and load_at:
            base = self.respond(setpoint=setpoint, until=end)
            added = self.respond(setpoint=0.0, load=load, until=end - load_at)
            return Response(base.output + added.output.delayed(load_at), base.control + added.control.delayed(load_at))
        time, gain = self._units.time, self._units.gain
        breaks, y, control_breaks, u = self._responses(setpoint, load * gain, end / time)
        final_y, final_u = self.steady_state(setpoint, load)
        u = u / gain
        if isinstance(self._plant, FunctionPlant) and self._stable and not self._decay and end > LONG * self.horizon():
            total = function_responses.total_error(self._plant, self._controller, setpoint, load * gain, final_y)
            slow = SlowSignal(breaks * time, y, final=final_y, stable=self.is_stable, total_error=total * time)
            return Response(slow, SlowSignal(control_breaks * time, u, final=final_u, stable=self.is_stable))
        return Response(
            Signal(breaks * time, y, final=final_y, stable=self.is_stable),
            Signal(control_breaks * time, u, final=final_u, stable=self.is_stable),
        )

    def steady_state(self, setpoint: float, load: float) -> tuple[float, float]:
        """Return the steady-state values of output and control signal for the given set-point and load steps.

        Parameters
        ----------
        setpoint, load
            Heights of the two steps.
        """
        setpoint, load = checks.finite("the setpoint step", setpoint), checks.finite("the load step", load)
        return steady_state(self.plant, self.primary_controller, setpoint, load, inner_gain=self._inner_gain)

    @property
    def _inner_gain(self) -> float:
        """Steady-state gain of what a predictor adds to the measurement."""
        return 0.0

    def open_loop(self) -> tuple[Units, OpenLoop]:
        """Return the chain that is closed by the controller's gains, in the loop's units."""
        return self._units, open_loop_of(self._plant, self._controller)

    def _responses(
        self, setpoint: float, load: float, end: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        if not self.plant.parts:
            found = self.poles(count=8) * self._units.time
            inputs = (setpoint, load)
            return function_responses.respond(self._transfer, self._controller, found, inputs, end, self._units.time)
        if not (end > FAR and self._stable and self._landmarks.size):
            breaks, y, u = self._marched(setpoint, load, end)
        else:
            breaks, y, u = held(*self._to_rest(setpoint, load, min(end, self.horizon() / self._units.time)), end)
        return breaks, y, breaks, u

    def _to_rest(self, setpoint: float, load: float, end: float) -> Pieces:
        """Return a response over a horizon that is long in units of the loop's time."""
        time, filters = self._units.time, self._filter_poles
        all_poles = poles.merged(self._poles, filters[filters.imag >= 0.0] * time, self._poles.size + filters.size)
        system, steps = (self._plant, self._difference, self._controller), (setpoint, load)
        march = partial(self._marched, *steps)
        for modes, rate in slow_groups(all_poles, self._crowd * time):
            alone = SETTLED / rate + 4.0 * self._longest / time
            output, control = self.steady_state(setpoint, load / self._units.gain)
            rest = output, control * self._units.gain
            if found := with_slow_end(march, end, modes, alone, system, steps, rest, time):
                return found
        return march(end)

    def _marched(self, setpoint: float, load: float, end: float) -> Pieces:
        return responses(self._plant, [self._controller], end, setpoint=setpoint, load=load, unit=self._units.time)[0]
