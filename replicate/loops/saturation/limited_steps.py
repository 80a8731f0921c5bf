"""Exact time responses of loops whose control signal has limits: a method of steps that restarts at each event.

Between events the loop is linear (`replicate.loops.saturation.anti_windup` names its modes), and a piece is computed as
in `replicate.loops.time_domain.adaptive_steps`. On each piece the command is a polynomial; the first root at which a
condition of the mode ends is an event. The piece is cut there, the next one begins in the mode that follows, and the
kink that the event leaves in the control signal makes pieces end wherever it comes back after sums of dead times.

Reference: Shampine and Thompson, "Event location for ordinary differential equations", Comput. Math. Appl. 39 (2000).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import ImproperLoopError, LoopError
from replicate.loops.saturation.anti_windup import FREE, LimitedController, Mode
from replicate.loops.saturation.limit_events import Piece, first_end
from replicate.loops.time_domain.pending_jumps import PendingJumps
from replicate.loops.time_domain.piece_flow import (
    DEGREE,
    MOST_PIECES,
    SAME,
    STARTING,
    PieceFlow,
    Row,
    delayed_values,
    nominal,
    piece_flow,
)  # fmt: skip
from replicate.loops.time_domain.resolution import START, Resolution, as_good_as_it_gets, coefficients

Array = NDArray[np.float64]

ON_LIMIT = 1e-12  # of the largest command: distance from the limit at which it slides along it

Jump = tuple[float, float]  # time, and the new value


@dataclass
class LimitedSteps:
    """A march through time, and all that it has computed so far.

    Parameters
    ----------
    controller
        The chain, the command, its limits and its anti-windup.
    delays
        The dead time of each of the chain's inputs.
    loaded
        1 for the inputs that the load enters, 0 for the others.
    setpoints, loads
        Piecewise constant inputs: their jumps in order of time, the first at t = 0.
    unit
        Unit of time in the user's, for messages.
    """

    controller: LimitedController
    delays: Array
    loaded: Array
    setpoints: list[Jump]
    loads: list[Jump]
    unit: float = 1.0
    mode: Mode = FREE
    breaks: list[float] = field(default_factory=lambda: [0.0])
    output: list[Array] = field(default_factory=list)  # coefficients
    control: list[Array] = field(default_factory=list)
    command: list[Array] = field(default_factory=list)
    modes: list[Mode] = field(default_factory=list)
    maps: dict[tuple[Mode, float, float], PieceFlow] = field(default_factory=dict)
    tried: list[Mode] = field(default_factory=list)  # modes in which the next piece cannot begin

    def __post_init__(self) -> None:
        chain, row = self.controller.chain, self.controller.command
        direct = float(row.v[0]) if self.delays[0] == 0.0 else 0.0
        if direct > 1.0 - SAME:
            msg = "the loop without dead time is not well posed under limits: its algebraic feedback must be below one"
            raise ImproperLoopError(msg)
        self.x = np.zeros(chain.e.size)
        self.setpoint = 0.0
        self.jumps = PendingJumps(chain, row, self.delays)
        largest = max((abs(value) for _, value in self.setpoints), default=0.0)
        self.resolution = Resolution(START * largest, unit=self.unit)
        for time, _ in self.setpoints:
            self.jumps.expect(time)
        for time, _ in self.loads:
            self.jumps.expect_load(time)
        a = chain.a + (np.outer(chain.b[:, 0], row.x) / (1.0 - direct) if self.delays[0] == 0.0 else 0.0)
        radius = float(np.max(np.abs(np.linalg.eigvals(a)), initial=0.0))
        self.length = self.resolution.fastest = STARTING / radius if radius else np.inf

    @property
    def last_change(self) -> float:
        """The time at which the mode changed last."""
        changes = [i for i in range(1, len(self.modes)) if self.modes[i] != self.modes[i - 1]]
        return self.breaks[changes[-1]] if changes else 0.0

    def run(self, until: float) -> None:
        """March on to a horizon."""
        previous = np.inf
        while self.breaks[-1] < until * (1.0 - SAME):
            start = self.breaks[-1]
            self._arrive(start)
            stop = min(self.jumps.next, until)
            rest = stop - start
            pieces = max(1.0, np.ceil(rest / self.length * (1.0 - SAME)))
            h = rest / pieces if pieces <= 2.0 else self.length
            y, u, v, command, x = self._piece(start, h, self.mode)
            remaining, smooth = self.resolution.check(start, h, np.concatenate([[y, command], v, [u]]))
            if not as_good_as_it_gets(remaining, previous):
                previous, self.length = remaining, 0.5 * h
                if start + self.length == start:
                    msg = f"the response is not resolved at t = {start * self.unit:g}"
                    raise LoopError(msg)
                continue
            previous = np.inf
            event = self._event(start, h, v, command)
            if event is None:
                self._accept(stop if pieces <= 1.0 else start + h, y, u, command, x)
                self.length = 2.0 * h if smooth else max(h, self.length if pieces <= 1.0 else h)
            elif event[0] > -1.0:
                share = 0.5 * (event[0] + 1.0) * h
                y, u, _, command, x = self._piece(start, share, self.mode)
                self._accept(start + share, y, u, command, x)
                self.mode = event[1]
                self.jumps.send(start + share, 1)
                self.length = h
            else:
                self._change_at_once(start, event[1])
            if len(self.output) > MOST_PIECES:
                end = until * self.unit
                msg = f"the response needs more than {MOST_PIECES} pieces up to t = {end:g}: choose a shorter horizon"
                raise LoopError(msg)

    def _accept(self, end: float, y: Array, u: Array, command: Array, x: Array) -> None:
        if self.mode.kind == "sliding":
            command = u
        self.tried = []
        self.breaks.append(end)
        self.output.append(y)
        self.control.append(u)
        self.command.append(command)
        self.modes.append(self.mode)
        self.x = x

    # ---- what arrives ----------------------------------------------------------------------------------------------

    def _arrive(self, start: float) -> None:
        """Let the jumps that are reached go around again, and move the set-point."""
        self.jumps.pass_by(start)
        setpoint = _value(self.setpoints, start)
        if setpoint != self.setpoint:
            self.x = self.x + self.controller.chain.start * (setpoint - self.setpoint)
            self.setpoint = setpoint

    # ---- one piece -------------------------------------------------------------------------------------------------

    def _change_at_once(self, start: float, following: Mode) -> None:
        """Enter another mode without leaving the time: the piece cannot begin in this one."""
        self.tried.append(self.mode)
        if following in self.tried:
            following = Mode("sliding", max(self.tried, key=lambda mode: abs(mode.side)).side)
            if self.controller.anti_windup != "clamping" or following in self.tried:
                msg = f"the control signal leaves its limit and returns to it at once, at t = {start * self.unit:g}"
                raise LoopError(msg)
        self.mode = following
        if start:
            self.jumps.send(start, 1)

    def _event(self, start: float, h: float, v: Array, command: Array) -> tuple[float, Mode] | None:
        size = max(self.resolution.size_u, float(np.max(np.abs(command))))
        if self.mode.kind == "sliding":
            limit = self.controller.limit(self.mode)
            off = float(np.sum(command * (-1.0) ** np.arange(command.size))) - limit
            if abs(off) > ON_LIMIT * size:  # a jump has thrown the command off its limit
                return -1.0, Mode("held", self.mode.side) if off * self.mode.side > 0.0 else FREE
        rate = np.zeros(DEGREE + 1)
        if self.controller.anti_windup == "clamping" and self.controller.integrator is not None:
            rate = self._signal(start, h, self.controller.integral_rate, v)
        return first_end(self.controller, self.mode, Piece(command, rate, h), size)

    def _piece(self, start: float, h: float, mode: Mode) -> tuple[Array, Array, Array, Array, Array]:
        """Return coefficients of output, control signal, delayed inputs and command, and the state at the end."""
        inputs = self._inputs(start, h, mode)
        flow = self._flow(h, mode)
        command, y, v = coefficients(flow.u @ inputs), coefficients(flow.y @ inputs), coefficients(flow.v @ inputs)
        x = np.asarray(flow.x[-1] @ inputs)
        if mode == FREE:
            return y, command, v, command, x
        limit = np.zeros_like(command)
        limit[0] = self.controller.limit(mode)
        if mode.kind == "sliding":
            # the integral part makes up for what the rest of the command loses
            index = self.controller.integrator
            x[index] += (limit[0] - float(np.sum(command))) / self.controller.command.x[index]
        return y, limit, v, command, x

    def _signal(self, start: float, h: float, row: Row, v: Array) -> Array:
        """Return the coefficients of another signal of the chain on a piece."""
        states = self._flow(h, self.mode).x @ self._inputs(start, h, self.mode)
        values = coefficients(states @ row.x) + row.v @ v
        values[0] += row.r * self.setpoint
        return np.asarray(values)

    def _inputs(self, start: float, h: float, mode: Mode) -> Array:
        """Return what enters a piece: the known part of the delayed inputs, the state, and the unit set-point."""
        known = []
        for delay, loaded in zip(self.delays.tolist(), self.loaded.tolist(), strict=True):
            values, earlier = delayed_values(self.breaks, self.control, start, h, delay)
            if mode != FREE:
                values[~earlier] = self.controller.limit(mode)
            known.append(values + loaded * _value(self.loads, start - delay, slack=SAME * start))
        return np.concatenate([np.array(known).ravel(), self.x, [1.0]])

    def _flow(self, h: float, mode: Mode) -> PieceFlow:
        h = nominal(h)
        key = (mode, self.setpoint, h)
        if key not in self.maps:
            chain, row = self.controller.chain_in(mode, self.setpoint)
            self.maps[key] = piece_flow(chain, row, self.delays, h, closed=mode == FREE)
        return self.maps[key]


def _value(jumps: list[Jump], time: float, *, slack: float = 0.0) -> float:
    """Return the value of a piecewise constant input, the right-hand one at a jump."""
    value = 0.0
    for at, new in jumps:
        if at <= time + max(slack, SAME * abs(time)):
            value = new
    return value
