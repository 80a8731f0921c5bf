r"""The open chain from the delayed control signal to the controller's building blocks.

On an interval no longer than the dead time the plant sees only what the controller did one dead time ago. Everything in
that interval, output and next control signal alike, is therefore an explicit linear function of known signals:
there is no feedback inside. The chain holds the states of the plant, of the filters and of the integrator,

    X' = A X + B v + E r,    y = C X + D v,    w = W_x X + W_v v + W_r r,    u = g . w,

with v the plant input after each of its dead times, r the set-point, and w the four signals r_f, y_f,
integral(r_f - y_f) and derivative whose gains are (k b, -k, ki, kd). The gains appear only in the last product, so one
chain serves a whole sweep. The states are scaled by powers of two that balance the whole chain, feedback included.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.errors import ImproperLoopError
from replicate.loops.kept import Kept
from replicate.loops.numerics.controller_form import controller_form
from replicate.loops.plant import Plant
from replicate.loops.plants.sum_plant import SumPlant

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Chain:
    """State-space matrices of the open chain for m dead times.

    Shapes A (n, n), B (n, m), E, C (n,), D (m,), W_x (4, n), W_v (4, m), W_r (4,).
    """

    a: Array
    b: Array
    e: Array
    c: Array
    d: Array
    wx: Array
    wv: Array
    wr: Array
    setpoint_impulse: float  # weight of the impulse that an ideal derivative makes of a set-point step, per unit of kd
    start: Array  # states right after a unit step of the set-point, shape (n,)

    def balanced(self, g: Array) -> Chain:
        """Return the chain with its states scaled by powers of two, so that the loop closed by gains ``g`` is balanced.

        Scaling is exact; it keeps the solutions of stiff and of badly scaled chains accurate.
        """
        n = self.b.shape[0]
        if n == 0:
            return self
        feedback, drive = np.abs(g) @ np.abs(self.wx), np.abs(self.b).sum(axis=1)
        whole = np.zeros((n + 1, n + 1))
        whole[:n, :n], whole[:n, n], whole[n, :n] = self.a, drive, feedback
        _, _, _, scale, _ = scipy.linalg.lapack.dgebal(whole, scale=1, permute=0)
        scale = scale[:n] / scale[n]
        return Chain(
            self.a * scale / scale[:, None], self.b / scale[:, None], self.e / scale, self.c * scale, self.d,
            self.wx * scale, self.wv, self.wr, self.setpoint_impulse, self.start / scale,
        )  # fmt: skip


def gains(controller: PID) -> Array:
    """Return the gains of the four building blocks, shape (4,)."""
    return np.array([controller.k * controller.b, -controller.k, controller.ki, controller.kd])


@dataclass(frozen=True)
class OpenLoop:
    """A chain with what closes it: the gains (4,), the dead time of each input, and which inputs a load enters."""

    chain: Chain
    gains: Array
    delays: Array
    loaded: Array


def open_loop_of(plant: Plant, controller: PID) -> OpenLoop:
    """Return the balanced chain of one controller."""
    g = gains(controller)
    chain = build_chain(plant, controller, integral=bool(g[2]), derivative=bool(g[3])).balanced(g)
    delays = np.array([part.dead_time for part in plant.parts])
    return OpenLoop(chain, g, delays, np.ones(delays.size))


def open_loop_of_spaces(plant: Plant, model: Plant | None, controller: PID) -> OpenLoop:
    """Return the chain of a controller that measures the sum of a plant and a model which the load does not enter.

    The output is the plant's alone. Inputs are ordered by their dead times.
    """
    if model is None:
        return open_loop_of(plant, controller)
    (a, b, c, d), (e, f, g, h) = _plant_state_space(plant), _plant_state_space(model)
    n, m = a.shape[0], b.shape[1]
    delays = np.array([part.dead_time for part in (*plant.parts, *model.parts)])
    order = np.argsort(delays, kind="stable")
    loaded = (np.arange(delays.size) < m).astype(float)
    space = (
        scipy.linalg.block_diag(a, e), scipy.linalg.block_diag(b, f)[:, order],
        np.concatenate([c, g]), np.concatenate([d, h])[order],
    )  # fmt: skip
    closing = gains(controller)
    chain = build_chain(plant, controller, integral=bool(closing[2]), derivative=bool(closing[3]), space=space)
    only = np.concatenate([c, np.zeros(chain.e.size - n)])
    chain = replace(chain, c=only, d=(np.concatenate([d, np.zeros(h.size)])[order])).balanced(closing)
    return OpenLoop(chain, closing, delays[order], loaded[order])


def build_chain(
    plant: Plant,
    controller: PID,
    *,
    integral: bool = True,
    derivative: bool = True,
    space: tuple[Array, Array, Array, Array] | None = None,
) -> Chain:
    """Return the chain of a rational plant and a controller's filters and weights (its gains are not used).

    Parameters
    ----------
    integral, derivative
        Whether any controller that will use this chain has integral or derivative action.
    space
        (A, B, C, D) of what is measured, an input for each dead time, if it is not the plant's own.

    Raises
    ------
    ImproperLoopError
        If an ideal derivative meets a plant whose output jumps with its input.
    """
    if space is None and plant.is_rational:
        shape = (controller.c, controller.derivative_filter, controller.measurement_filter)
        filters = (controller.measurement_filter_order, controller.setpoint_filter)
        key = (plant.num.tobytes(), plant.den.tobytes(), *shape, *filters, integral, derivative)
        return _CHAINS.get(key, lambda: _built(controller, integral, derivative, _plant_state_space(plant)))
    return _built(controller, integral, derivative, _plant_state_space(plant) if space is None else space)


_CHAINS: Kept[Chain] = Kept(64)


def _built(controller: PID, integral: bool, derivative: bool, space: tuple[Array, Array, Array, Array]) -> Chain:
    pa, pb, pc, d = space
    n_plant, inputs = pb.shape
    n_filter = controller.measurement_filter_polynomials()[1].size - 1
    n_integral = 1 if integral else 0
    n_lag = 1 if derivative and controller.derivative_filter else 0
    fa, fb, fc, fd = controller_form(*controller.setpoint_filter_polynomials())
    i_filter = n_plant
    i_integral = i_filter + n_filter
    i_lag = i_integral + n_integral
    i_setpoint = i_lag + n_lag
    n = i_setpoint + fb.size

    a, b, e = np.zeros((n, n)), np.zeros((n, inputs)), np.zeros(n)
    a[:n_plant, :n_plant], b[:n_plant] = pa, pb
    y = _Row(np.concatenate([pc, np.zeros(n - n_plant)]), d, 0.0)

    measured, slope = _measured(controller, y, slice(i_filter, i_integral), a, b)
    a[i_setpoint:, i_setpoint:], e[i_setpoint:] = fa, fb
    setpoint = _Row(np.concatenate([np.zeros(i_setpoint), fc]), np.zeros(inputs), fd)
    error = setpoint - measured

    integrated = _Row(np.zeros(n), np.zeros(inputs), 0.0)
    if integral:
        a[i_integral], b[i_integral], e[i_integral] = error.x, error.v, error.r
        integrated = _Row.state(i_integral, n, inputs)

    differentiated, impulse, start = _Row(np.zeros(n), np.zeros(inputs), 0.0), 0.0, np.zeros(n)
    if derivative:
        if slope is None and not np.any(measured.v):
            slope = _Row(measured.x @ a, measured.x @ b, 0.0)
        if slope is None and not n_lag:
            msg = "an ideal derivative of an output that jumps with the plant's input is not a causal controller"
            raise ImproperLoopError(msg)
        setpoint_slope = _Row(setpoint.x @ a, np.zeros(inputs), float(setpoint.x @ e))
        state, lag = _Row.state(i_lag, n, inputs) if n_lag else differentiated, controller.derivative_filter
        if slope is None:
            differentiated = (setpoint * controller.c - measured - state) * (1.0 / lag)
            a[i_lag], b[i_lag], e[i_lag] = differentiated.x, differentiated.v, differentiated.r
        elif n_lag:  # the filtered slope itself is the state; a jump of the set-point makes it jump
            change = (setpoint_slope * controller.c - slope - state) * (1.0 / lag)
            a[i_lag], b[i_lag], e[i_lag] = change.x, change.v, change.r
            start[i_lag] = controller.c * fd / lag
            differentiated = state
        else:
            differentiated = setpoint_slope * controller.c - slope
            impulse = controller.c * fd

    rows = (setpoint, measured, integrated, differentiated)
    return Chain(
        a, b, e, y.x, d,
        np.array([row.x for row in rows]), np.array([row.v for row in rows]), np.array([row.r for row in rows]),
        impulse, start,
    )  # fmt: skip


@dataclass(frozen=True)
class _Row:
    """A signal of the chain as a linear function of its state, the plant input v and the set-point r."""

    x: Array
    v: Array
    r: float

    @classmethod
    def state(cls, index: int, size: int, inputs: int) -> _Row:
        x = np.zeros(size)
        x[index] = 1.0
        return cls(x, np.zeros(inputs), 0.0)

    def __sub__(self, other: _Row) -> _Row:
        return _Row(self.x - other.x, self.v - other.v, self.r - other.r)

    def __mul__(self, factor: float) -> _Row:
        return _Row(self.x * factor, self.v * factor, self.r * factor)


def _measured(controller: PID, y: _Row, own: slice, a: Array, b: Array) -> tuple[_Row, _Row | None]:
    """Enter the measurement filter's states into A and B; return the filtered output, and its slope if known."""
    n, inputs = b.shape
    lag = controller.measurement_filter
    if isinstance(lag, tuple):
        fa, fb, fc, fd = controller_form(*controller.measurement_filter_polynomials())
        a[own], b[own] = np.outer(fb, y.x), np.outer(fb, y.v)
        a[own, own] = fa
        measured = _Row(fd * y.x, fd * y.v, 0.0)
        measured.x[own] = fc
        return measured, None
    if np.any(y.v):  # the output jumps: its slope is not a state of the chain
        measured, slope = y, None
        for index in range(own.start, own.stop):  # a chain of equal first-order lags
            slope = (measured - _Row.state(index, n, inputs)) * (1.0 / lag)
            a[index], b[index] = slope.x, slope.v
            measured = _Row.state(index, n, inputs)
        return measured, slope
    # the slope z of the filtered output is the state: lag z' = slope of the output - z; a difference of output and
    # filtered output, divided by a short lag, would be rounding error
    measured, slope = y, _Row(y.x @ a, y.x @ b, 0.0)
    for index in range(own.start, own.stop):
        state = _Row.state(index, n, inputs)
        change = (slope - state) * (1.0 / lag)
        a[index], b[index] = change.x, change.v
        measured, slope = measured - state * lag, state
    return measured, slope if own.stop > own.start else None


def _plant_state_space(plant: Plant) -> tuple[Array, Array, Array, Array]:
    """Return (A, B, C, D) of a plant with an input for each of its dead times."""
    if isinstance(plant, SumPlant):
        return plant.state_space_by_dead_time()
    a, b, c, d = plant.state_space()
    return a, b[:, None], c, np.array([d])
