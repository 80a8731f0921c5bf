r"""Exact time responses by a spectral method of steps whose pieces adapt: several dead times, stiff and slow loops.

The delayed inputs v_i(t) = u(t - L_i) of a piece [a, a + h] are known from earlier pieces where t - L_i < a; elsewhere
they are the piece's own control signal, read from its polynomial. Together with the chain in integral form

    X = 1 (x) X_0 + h/2 (S X A^T + sum_i S v_i B_i^T + S 1 E^T r),    u = U_x X + sum_i U_i v_i + U_r r

this is one linear system on Chebyshev-Lobatto nodes, a fixed map for each length h. A jump of the response returns
after every sum of dead times, smoother each time by the integrations on its way: while it can matter as it arrives,
pieces end there, however smooth it leaves the plant. In between their length doubles where the solution is smooth,
also beyond the dead times, and is halved where its last Chebyshev coefficients are not at rounding level. A short dead
time in a slow loop, or a fast lag, thus costs a few dozen pieces and not as many as fit into the horizon.

Reference: Bellman and Cooke, "Differential-Difference Equations" (1963), chapters 3 and 5.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.errors import ImproperLoopError, LoopError
from replicate.loops.frequency_domain.loop_transfer import ILL_POSED
from replicate.loops.plant import Plant
from replicate.loops.time_domain.chain import Chain, open_loop_of
from replicate.loops.time_domain.pending_jumps import PendingJumps
from replicate.loops.time_domain.piece_flow import (
    DEGREE,
    MOST_PIECES,
    SAME,
    STARTING,
    Row,
    delayed_values,
    nominal,
    piece_flow,
    too_many_pieces,
)  # fmt: skip
from replicate.loops.time_domain.resolution import START, Resolution, as_good_as_it_gets, coefficients

Array = NDArray[np.float64]


def respond(
    plant: Plant, controller: PID, until: float, *, setpoint: float, load: float, unit: float = 1.0
) -> tuple[Array, Array, Array]:
    """Return breaks and the Chebyshev coefficients of output and control signal on [0, until].

    Parameters
    ----------
    plant
        Rational with any number of dead times.
    setpoint, load
        Heights of the steps at t = 0 in the set-point and at the plant input (before the dead times).
    unit
        Unit of time in the user's, for messages.

    Raises
    ------
    LoopError
        If the response needs too many pieces, or grows out of range.
    """
    parts = open_loop_of(plant, controller)
    loads = load * parts.loaded
    return march(parts.chain, parts.gains, parts.delays, until, setpoint=setpoint, loads=loads, unit=unit)


def march(
    chain: Chain, g: Array, delays: Array, until: float, *, setpoint: float, loads: Array, unit: float = 1.0
) -> tuple[Array, Array, Array]:
    """Return the response of a chain closed by the gains ``g`` as `respond` does; each input has a load of its own."""
    steps = _March(chain, g, delays, setpoint, loads, unit)
    with np.errstate(over="ignore", invalid="ignore"):
        steps.run(until)
    return np.array(steps.breaks), coefficients(np.array(steps.output)), np.array(steps.control)


@dataclass
class _March:
    """The state of a march: what has been computed, and what is still on its way around the loop."""

    chain: Chain
    g: Array
    delays: Array
    setpoint: float
    loads: Array
    unit: float  # of time, in the user's
    breaks: list[float] = field(default_factory=lambda: [0.0])
    output: list[Array] = field(default_factory=list)  # node values of y
    control: list[Array] = field(default_factory=list)  # coefficients of u
    impulses: list[tuple[float, int, float]] = field(default_factory=list)  # (arrival, dead time, weight)
    maps: dict[float, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.row = Row(self.g @ self.chain.wx, self.g @ self.chain.wv, float(self.g @ self.chain.wr))
        self.jumps = PendingJumps(self.chain, self.row, self.delays)
        self.x = self.chain.start * self.setpoint
        self.resolution = Resolution(START * abs(self.setpoint), unit=self.unit)
        self.algebraic = 1.0 - (float(self.row.v[0]) if self.delays[0] == 0.0 else 0.0)
        if abs(self.algebraic) < ILL_POSED:
            msg = "the loop without dead time is not well posed: its algebraic feedback equals one"
            raise ImproperLoopError(msg)

    def run(self, until: float) -> None:
        """March to the horizon."""
        self._send(0.0, float(self.g[3]) * self.chain.setpoint_impulse * self.setpoint / self.algebraic)
        self.jumps.expect(0.0)
        length = self.resolution.fastest = self._first_length()
        previous = np.inf
        while self.breaks[-1] < until * (1.0 - SAME):
            start = self.breaks[-1]
            self.jumps.pass_by(start)
            rest = min(self.jumps.next, until) - start
            pieces = max(1.0, np.ceil(rest / length * (1.0 - SAME)))
            h = rest / pieces if pieces <= 2.0 else length
            self._receive(start)
            y, signals, end = self._piece(start, h)
            remaining, smooth = self.resolution.check(start, h, signals)
            if not as_good_as_it_gets(remaining, previous):
                previous, length = remaining, 0.5 * h
                if start + length == start:
                    msg = f"the response is not resolved at t = {start * self.unit:g}"
                    raise LoopError(msg)
                continue
            previous = np.inf
            stop = min(self.jumps.next, until) if pieces <= 1.0 else start + h
            self.breaks.append(stop)
            self.output.append(y)
            self.control.append(signals[1])
            self.x = end
            length = 2.0 * h if smooth else max(h, length if pieces <= 1.0 else h)
            if len(self.output) > MOST_PIECES:
                raise too_many_pieces(MOST_PIECES, until * self.unit)

    def _first_length(self) -> float:
        a = self.chain.a
        if self.delays[0] == 0.0:
            a = a + np.outer(self.chain.b[:, 0], self.row.x) / self.algebraic
        radius = float(np.max(np.abs(np.linalg.eigvals(a)), initial=0.0))
        return STARTING / radius if radius else np.inf

    # ---- impulses on their way ---------------------------------------------------------------------------

    def _send(self, time: float, weight: float) -> None:
        """Note an impulse of the control signal: it arrives after each dead time."""
        if weight:
            for i, delay in enumerate(self.delays):
                heapq.heappush(self.impulses, (time + float(delay), i, weight))

    def _receive(self, start: float) -> None:
        while self.impulses and self.impulses[0][0] <= start * (1.0 + SAME):
            time, i, weight = heapq.heappop(self.impulses)
            self.x = self.x + self.chain.b[:, i] * weight
            if self.delays[i] and self.row.v[i]:
                self._send(time, float(self.row.v[i]) * weight / self.algebraic)

    # ---- one piece -------------------------------------------------------------------------------------------------

    def _piece(self, start: float, h: float) -> tuple[Array, Array, Array]:
        """Return node values of y, coefficients of y, u and the delayed inputs as rows, and the state at the end."""
        points, n = DEGREE + 1, self.x.size
        known = np.array([self._history(start, h, i) for i in range(self.delays.size)])
        result = self._map(h) @ np.concatenate([known.ravel(), self.x, [self.setpoint]])
        signals = result[: result.size - n].reshape(-1, points)
        return signals[0], coefficients(signals), result[result.size - n :]

    def _history(self, start: float, h: float, i: int) -> Array:
        """Return the part of a delayed input that earlier pieces and the load make, on the nodes of a piece."""
        delay = float(self.delays[i])
        values, _ = delayed_values(self.breaks, self.control, start, h, delay)
        return values + (float(self.loads[i]) if start >= delay * (1.0 - SAME) else 0.0)

    def _map(self, h: float) -> Array:
        """Return the map of a piece from (known inputs, start state, set-point) to (y, u, inputs, end state)."""
        h = nominal(h)
        if h not in self.maps:
            flow = piece_flow(self.chain, self.row, self.delays, h)
            self.maps[h] = np.concatenate([flow.y, flow.u, *flow.v, flow.x[-1]])
        return self.maps[h]
