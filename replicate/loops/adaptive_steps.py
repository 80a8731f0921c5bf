r"""Exact time responses by a spectral method of steps whose pieces adapt: several dead times, stiff and slow loops.

The delayed inputs v_i(t) = u(t - L_i) of a piece [a, a + h] are known from earlier pieces where t - L_i < a; elsewhere
they are the piece's own control signal, read from its polynomial. Together with the chain in integral form

    X = 1 (x) X_0 + h/2 (S X A^T + sum_i S v_i B_i^T + S 1 E^T r),    u = U_x X + sum_i U_i v_i + U_r r

this is one linear system on Chebyshev-Lobatto nodes, a fixed map for each length h. A jump of the response returns
after every sum of dead times, smoother each time by the integrations on its way: while it can matter, pieces end
there. In between their length doubles where the solution is smooth, also beyond the dead times, and is halved where its
last Chebyshev coefficients are not at rounding level. A short dead time in a slow loop, or a fast lag, thus costs a few
dozen pieces and not as many as fit into the horizon.

Reference: Bellman and Cooke, "Differential-Difference Equations" (1963), chapters 3 and 5.
"""

from __future__ import annotations

import heapq
from bisect import bisect_right
from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import chebyshev as cheb
from numpy.typing import NDArray

from replicate.loops import chebyshev
from replicate.loops.chain import Chain, build_chain, gains
from replicate.loops.controller import PID
from replicate.loops.errors import ImproperLoopError, LoopError
from replicate.loops.plant import Plant

Array = NDArray[np.float64]

DEGREE = 18
RESOLVED = 2e-14  # size of the last coefficients relative to the largest, at which a piece counts as resolved
SMOOTH = 1e-14  # size of the upper third of the coefficients at which the next piece may be twice as long
STARTING = 3.5  # first piece, in units of the fastest time constant
SMOOTHEST = 12  # order of a derivative whose jump no longer has to fall on the end of a piece
SMALLEST_JUMP = 1e-17
START = 1e-4  # of the set-point step: an output below this is resolved as if it were this large
SAME = 1e-12  # relative distance of two times that are one
CLOCK = 4.0 * float(np.finfo(float).eps)
MOST_PIECES = 200_000
LARGEST = 1e100  # size of a diverging response at which its metrics could overflow


def respond(plant: Plant, controller: PID, until: float, *, setpoint: float, load: float) -> tuple[Array, Array, Array]:
    """Return breaks and the Chebyshev coefficients of output and control signal on [0, until].

    Parameters
    ----------
    plant
        Rational with any number of dead times.
    setpoint, load
        Heights of the steps at t = 0 in the set-point and at the plant input (before the dead times).

    Raises
    ------
    LoopError
        If the response needs too many pieces, or grows out of range.
    """
    g = gains(controller)
    chain = build_chain(plant, controller, integral=bool(g[2]), derivative=bool(g[3])).balanced(g)
    march = _March(chain, g, np.array([part.dead_time for part in plant.parts]), setpoint, load)
    with np.errstate(over="ignore", invalid="ignore"):
        march.run(until)
    to_coefficients = chebyshev.values_to_coefficients(DEGREE).T
    return np.array(march.breaks), np.array(march.output) @ to_coefficients, np.array(march.control)


@dataclass
class _March:
    """The state of a march: what has been computed, and what is still on its way around the loop."""

    chain: Chain
    g: Array
    delays: Array
    setpoint: float
    load: float
    breaks: list[float] = field(default_factory=lambda: [0.0])
    output: list[Array] = field(default_factory=list)  # node values of y
    control: list[Array] = field(default_factory=list)  # coefficients of u
    impulses: list[tuple[float, int, float]] = field(default_factory=list)  # (arrival, dead time, weight)
    maps: dict[float, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.ux, self.uv, self.ur = self.g @ self.chain.wx, self.g @ self.chain.wv, float(self.g @ self.chain.wr)
        self.x = self.chain.start * self.setpoint
        # what the output is compared with before it has moved
        self.size_y, self.size_u = START * abs(self.setpoint), 0.0
        self.algebraic = 1.0 - (float(self.uv[0]) if self.delays[0] == 0.0 else 0.0)
        if abs(self.algebraic) < SAME:
            msg = "the loop without dead time is not well posed: its algebraic feedback equals one"
            raise ImproperLoopError(msg)

    def run(self, until: float) -> None:
        """March to the horizon."""
        stops = [*self._jumps(until), until]
        self._send(0.0, float(self.g[3]) * self.chain.setpoint_impulse * self.setpoint / self.algebraic)
        length = min(self._first_length(), stops[0])
        previous = np.inf
        while self.breaks[-1] < until * (1.0 - SAME):
            start = self.breaks[-1]
            while stops[0] <= start * (1.0 + SAME):
                stops.pop(0)
            rest = stops[0] - start
            pieces = np.ceil(rest / length * (1.0 - SAME))
            h = rest / pieces if pieces <= 2.0 else length
            self._receive(start)
            y, u, v, end = self._piece(start, h)
            remaining, smooth = self._check(h, y, u, v)
            if remaining > RESOLVED and not (remaining < 1e-9 and remaining > 0.25 * previous):
                previous, length = remaining, 0.5 * h
                if start + length == start:
                    msg = f"the response is not resolved at t = {start:g}"
                    raise LoopError(msg)
                continue
            previous = np.inf
            stop = stops[0] if pieces <= 1.0 else start + h
            self.breaks.append(stop)
            self.output.append(y)
            self.control.append(u)
            self.x = end
            length = 2.0 * h if smooth else max(h, length if pieces <= 1.0 else h)
            if len(self.output) > MOST_PIECES:
                msg = f"the response needs more than {MOST_PIECES} pieces up to t = {until:g}: choose a shorter horizon"
                raise LoopError(msg)

    def _first_length(self) -> float:
        a = self.chain.a
        if self.delays[0] == 0.0:
            a = a + np.outer(self.chain.b[:, 0], self.ux) / self.algebraic
        radius = float(np.max(np.abs(np.linalg.eigvals(a)), initial=0.0))
        return STARTING / radius if radius else np.inf

    # ---- jumps and impulses on their way ---------------------------------------------------------------------------

    def _jumps(self, until: float) -> list[float]:
        """Return the times at which a derivative that matters can jump: sums of dead times, ascending."""
        around = [self._integrations(i) for i in range(self.delays.size)]
        pending, found = [(0.0, 0, 1.0)], []
        known: dict[float, tuple[int, float]] = {}
        while pending:
            time, order, size = heapq.heappop(pending)
            while pending and pending[0][0] <= time * (1.0 + SAME):
                _, other, weight = heapq.heappop(pending)
                order, size = min(order, other), max(size, weight) if other == order else size
            if time:
                found.append(time)
            for i, delay in enumerate(self.delays):
                weight = size * abs(float(self.uv[i])) if around[i] == 0 else size
                if delay and order + around[i] < SMOOTHEST and weight > SMALLEST_JUMP and time + delay < until:
                    heapq.heappush(pending, (time + float(delay), order + around[i], weight))
            known[time] = (order, size)
            if len(found) > MOST_PIECES:
                msg = f"the response jumps more than {MOST_PIECES} times up to t = {until:g}: choose a shorter horizon"
                raise LoopError(msg)
        return found

    def _integrations(self, i: int) -> int:
        """Return how many times an input is integrated before it shows in the control signal."""
        if self.uv[i]:
            return 0
        reached, size = self.chain.b[:, i], np.abs(self.chain.b[:, i])
        for order in range(1, self.x.size + 1):
            if abs(float(self.ux @ reached)) > SAME * float(np.abs(self.ux) @ size):
                return order
            reached, size = self.chain.a @ reached, np.abs(self.chain.a) @ size
        return SMOOTHEST

    def _send(self, time: float, weight: float) -> None:
        """Note an impulse of the control signal: it arrives after each dead time."""
        if weight:
            for i, delay in enumerate(self.delays):
                heapq.heappush(self.impulses, (time + float(delay), i, weight))

    def _receive(self, start: float) -> None:
        while self.impulses and self.impulses[0][0] <= start * (1.0 + SAME):
            time, i, weight = heapq.heappop(self.impulses)
            self.x = self.x + self.chain.b[:, i] * weight
            if self.delays[i] and self.uv[i]:
                self._send(time, float(self.uv[i]) * weight / self.algebraic)

    # ---- one piece -------------------------------------------------------------------------------------------------

    def _piece(self, start: float, h: float) -> tuple[Array, Array, Array, Array]:
        """Return node values of y, coefficients of u and of the delayed inputs, and the state at the end."""
        points, n = DEGREE + 1, self.x.size
        known = np.array([self._history(start, h, float(delay)) for delay in self.delays])
        flow = self._map(h)
        result = flow @ np.concatenate([known.ravel(), self.x, [self.setpoint]])
        u, y, v = result[:points], result[points : 2 * points], result[2 * points : -n or None]
        transform = chebyshev.values_to_coefficients(DEGREE)
        delayed = v[: points * self.delays.size].reshape(-1, points) @ transform.T
        return y, transform @ u, delayed, result[result.size - n :]

    def _history(self, start: float, h: float, delay: float) -> Array:
        """Return the part of a delayed input that earlier pieces and the load make, on the nodes of a piece."""
        nodes = start + 0.5 * h * (chebyshev.nodes(DEGREE) + 1.0)
        loaded = self.load if start >= delay * (1.0 - SAME) else 0.0
        values = np.full(nodes.size, loaded)
        earlier = ~_later(_nominal(h), delay)
        times = nodes[earlier] - delay
        if times.size == 0 or not self.control:
            return values
        middle = 0.5 * (times[0] + times[-1]) if times.size > 1 else times[0] + 0.25 * min(h, delay)
        first, last = (min(bisect_right(self.breaks, t) - 1, len(self.control) - 1) for t in (times[0], times[-1]))
        central = min(bisect_right(self.breaks, middle) - 1, len(self.control) - 1)
        if central < 0:
            return values
        slack = SAME * start
        if times[0] >= self.breaks[central] - slack and times[-1] <= self.breaks[central + 1] + slack:
            pieces = np.full(times.size, central)
        else:
            pieces = np.clip(np.searchsorted(self.breaks, times, side="right") - 1, max(first, 0), max(last, 0))
        for piece in np.unique(pieces):
            here = pieces == piece
            left, right = self.breaks[piece], self.breaks[piece + 1]
            x = np.clip(2.0 * (times[here] - left) / (right - left) - 1.0, -1.0, 1.0)
            where = np.nonzero(earlier)[0][here]
            values[where] += np.where(times[here] >= -slack, cheb.chebval(x, self.control[piece]), 0.0)
        return values

    def _map(self, h: float) -> Array:
        """Return the map of a piece from (known inputs, start state, set-point) to (u, y, inputs, end state)."""
        h = _nominal(h)
        if h in self.maps:
            return self.maps[h]
        points, n, m = DEGREE + 1, self.x.size, self.delays.size
        half_s = 0.5 * h * chebyshev.integration(DEGREE)
        own = [_own_part(h, float(delay)) for delay in self.delays]
        enter = [np.kron(half_s, self.chain.b[:, [i]]) for i in range(m)]
        # the state from (known inputs, start state, set-point, own control signal), then the control signal itself
        right = np.zeros((points * n, (m + 1) * points + n + 1))
        for i in range(m):
            right[:, i * points : (i + 1) * points] = enter[i]
            right[:, -points:] += enter[i] @ own[i]
        right[:, m * points : m * points + n] = np.kron(np.ones((points, 1)), np.eye(n))
        right[:, m * points + n] = np.kron(half_s.sum(axis=1), self.chain.e)
        states = np.linalg.solve(np.eye(points * n) - np.kron(half_s, self.chain.a), right) if n else right
        through = np.kron(np.eye(points), self.ux) @ states
        for i in range(m):
            through[:, i * points : (i + 1) * points] += self.uv[i] * np.eye(points)
            through[:, -points:] += self.uv[i] * own[i]
        through[:, m * points + n] += self.ur
        fed_back = np.eye(points) - through[:, -points:]
        u = np.linalg.solve(fed_back, through[:, :-points]) if any(part.any() for part in own) else through[:, :-points]
        x = (states[:, :-points] + states[:, -points:] @ u).reshape(points, n, -1)
        v = []
        for i in range(m):
            part = own[i] @ u
            part[:, i * points : (i + 1) * points] += np.eye(points)
            v.append(part)
        y = np.einsum("i,pic->pc", self.chain.c, x) + sum(d * part for d, part in zip(self.chain.d, v, strict=True))
        flow = np.concatenate([u, y, *v, x[-1]])
        self.maps[h] = flow
        return flow

    def _check(self, h: float, y: Array, u: Array, v: Array) -> tuple[float, bool]:
        """Return the size of what is not resolved, and whether a longer piece would be resolved, too."""
        series = chebyshev.values_to_coefficients(DEGREE) @ y
        size_y = max(self.size_y, float(np.max(np.abs(series))))
        size_u = max(self.size_u, float(np.max(np.abs(u))))
        size_v = max(size_u, float(np.max(np.abs(v))))
        if not (size_y < LARGEST and size_u < LARGEST):
            msg = f"the response grows beyond {LARGEST:g} by t = {self.breaks[-1]:g}: choose a shorter horizon"
            raise LoopError(msg)
        # times are known to rounding only: what changes fast carries that error
        blur = CLOCK * self.breaks[-1] * 2.0 / h
        order = np.arange(DEGREE + 1) ** 2
        remaining = upper = 0.0
        for row, size in [(series, size_y), (u, size_u), *((row, size_v) for row in v)]:
            if size:
                tail, floor = np.abs(row), blur * float(np.max(order * np.abs(row)))
                remaining = max(remaining, (float(np.max(tail[-2:])) - floor) / size)
                upper = max(upper, (float(np.max(tail[2 * DEGREE // 3 :])) - floor) / size)
        if remaining <= RESOLVED:
            self.size_y, self.size_u = size_y, size_u
        return remaining, upper <= SMOOTH


def _own_part(h: float, delay: float) -> Array:
    """Return the matrix that reads a piece's own polynomial one dead time ago, zero where that is before the piece."""
    x = chebyshev.nodes(DEGREE) - 2.0 * delay / h
    matrix = chebyshev.basis(np.maximum(x, -1.0), DEGREE).T @ chebyshev.values_to_coefficients(DEGREE)
    return np.where(_later(h, delay)[:, None], matrix, 0.0)


def _later(h: float, delay: float) -> NDArray[np.bool_]:
    """Return which nodes of a piece come more than a dead time after its start."""
    return np.asarray(0.5 * h * (chebyshev.nodes(DEGREE) + 1.0) > delay * (1.0 + SAME))


def _nominal(h: float) -> float:
    """Return a length without its rounding error: lengths that differ by no more share a map."""
    return float(f"{h:.13e}")
