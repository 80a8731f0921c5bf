"""What the usual toolchain does with a dead time: Padé model, uniform sample grid, metrics read off samples.

Nothing here is exact, on purpose. A replication sometimes has to repeat what an author's tools did in order
to explain the digits that were printed, and then show how far those are from the truth; this module does the
repeating. It shares nothing with the exact core but textbook forms: python-control, which has them too, takes a second
to import.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import LoopError
from replicate.loops.numerics.controller_form import controller_form
from replicate.loops.numerics.pade import dead_time_polynomials

if TYPE_CHECKING:
    from replicate.loops import PI, Plant

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StateSpace:
    """A model x' = A x + b u, y = c x + d u with one input and one output, shapes (n, n), (n,), (n,) and scalar."""

    a: Array
    b: Array
    c: Array
    d: float

    def poles(self) -> NDArray[np.complex128]:
        """Return the eigenvalues of A."""
        return np.asarray(np.linalg.eigvals(self.a), dtype=complex)


def pade_loop(
    plant: Plant, controller: PI, order: int = 2, response: Literal["setpoint", "load"] = "setpoint"
) -> StateSpace:
    """Return the closed loop with the dead time replaced by its Padé approximation.

    Parameters
    ----------
    plant
        A rational transfer function with dead time.
    controller
        A PI controller, with its set-point weight.
    order
        Order n of the Padé approximation, numerator and denominator.
    response
        From the set point, or from a load at the plant input, to the output.

    Returns
    -------
    StateSpace
        From the set point or the load to the output.

    Raises
    ------
    LoopError
        If the plant is not rational, or the controller has filters, which this model leaves out.
    """
    if not plant.is_rational:
        msg = f"a Padé model needs a rational plant, not {plant!r}"
        raise LoopError(msg)
    if controller.measurement_filter or controller.setpoint_filter:
        msg = f"the Padé model is made for a PI controller without filters, not {controller!r}"
        raise LoopError(msg)

    delay_num, delay_den = dead_time_polynomials(plant.dead_time, order if plant.dead_time else 0)
    num = np.polymul(plant.num, delay_num)
    den = np.polymul(plant.den, delay_den)
    characteristic = np.polyadd(np.polymul([1.0, 0.0], den), np.polymul([controller.k, controller.ki], num))
    weights = [controller.b * controller.k, controller.ki] if response == "setpoint" else [1.0, 0.0]
    return StateSpace(*controller_form(np.polymul(weights, num), np.asarray(characteristic, dtype=float)))


def dominant_pole(system: StateSpace) -> complex:
    """Return the rightmost pole, of a complex pair the one in the upper half plane.

    A double real pole comes out of any eigenvalue routine as two poles about the square root of the rounding
    error apart; their mean is accurate to the rounding error itself and is what is returned for such a
    cluster.
    """
    poles = system.poles()
    rightmost = poles[np.argmax(poles.real)]
    cluster = poles[np.abs(poles - rightmost) <= 1e-5 * abs(rightmost)]
    if len(cluster) > 1:
        return complex(np.mean(cluster).real)
    return complex(rightmost.real, abs(rightmost.imag))


@dataclass(frozen=True)
class SampledResponse:
    """A unit step response known at equally spaced instants; metrics are samples, not interpolations.

    Attributes
    ----------
    time, output
        Shape (n,); time from the step, in the plant's unit.

    Examples
    --------
    >>> import numpy as np
    >>> ramp = SampledResponse(np.arange(6.0), np.array([0.0, 0.3, 0.6, 0.9, 1.2, 1.0]))
    >>> round(ramp.overshoot(), 12), ramp.settling_time(0.02), ramp.delay_time(), ramp.rise_time()
    (0.2, 4.0, 2.0, 2.0)
    """

    time: Array
    output: Array

    @property
    def spacing(self) -> float:
        """Distance of two samples."""
        return float(self.time[-1] / (len(self.time) - 1))

    def overshoot(self) -> float:
        """Largest sample above 1, as a fraction; 0 if there is none."""
        return max(float(self.output.max()) - 1.0, 0.0)

    def settling_index(self, band: float = 0.02) -> int:
        """Index of the last sample that is more than `band` away from 1."""
        outside = np.flatnonzero(np.abs(self.output - 1.0) > band)
        return int(outside[-1]) if outside.size else 0

    def settling_time(self, band: float = 0.02) -> float:
        """Time of the last sample that is more than `band` away from 1."""
        return self.settling_index(band) * self.spacing

    def delay_time(self, level: float = 0.5) -> float:
        """Time of the first sample at or above `level`, dead time included."""
        return self._first(level) * self.spacing

    def rise_time(self, low: float = 0.1, high: float = 0.9) -> float:
        """Time from the first sample at or above `low` to the first at or above `high`."""
        return (self._first(high) - self._first(low)) * self.spacing

    def _first(self, level: float) -> int:
        reached = np.flatnonzero(self.output >= level)
        if not reached.size:
            msg = f"the response does not reach {level} within its {len(self.output)} samples"
            raise ValueError(msg)
        return int(reached[0])


def sampled_step(system: StateSpace, until: float, steps: int) -> SampledResponse:
    """Return the unit step response on the grid 0, until/steps, ..., until.

    Between samples the state moves by a matrix exponential, so the samples themselves are accurate to rounding even
    for a system with multiple poles.

    Parameters
    ----------
    system
        From `pade_loop`.
    until
        Last instant.
    steps
        Number of grid intervals.
    """
    from scipy.linalg import expm

    order = system.b.size
    # x' = A x + B and the constant input 1 as one autonomous system
    flow = np.zeros((order + 1, order + 1))
    flow[:order, :order], flow[:order, order] = system.a, system.b
    step = expm(flow * (until / steps))
    states = np.eye(order + 1)[:, -1:]
    while states.shape[1] <= steps:  # twice as many in each turn
        states = np.hstack([states, step @ states])
        step = step @ step
    output = (np.append(system.c, system.d) @ states)[: steps + 1]
    return SampledResponse(np.linspace(0.0, until, steps + 1), output)
