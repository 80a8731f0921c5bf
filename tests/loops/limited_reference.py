"""Limited loops by another way: `scipy.integrate.solve_ivp` with events, on a method of steps of its own.

The controller is u = sat(v), v = k (b r - y) + I + kd (c r - y - z)/Tf, z' = (c r - y - z)/Tf; the plant a state-space
model behind a dead time. Each integration ends at an event, or where a jump or kink of the control signal arrives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.signal
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Function = Callable[[float], float]

BEHIND = 1e-12  # distance behind a boundary at which it counts as crossed


@dataclass
class Reference:
    """A limited loop; ``run`` fills ``segments`` with (start, end, output, control, command)."""

    num: list[float]
    den: list[float]
    delay: float
    k: float
    ki: float
    limits: tuple[float, float]
    scheme: str
    tracking: float = 1.0
    b: float = 1.0
    kd: float = 0.0
    lag: float = 1.0
    c: float = 0.0
    setpoint: float = 1.0
    load: float = 0.0
    load_at: float = 0.0
    segments: list[tuple[float, float, Function, Function]] = field(default_factory=list)

    def __post_init__(self) -> None:
        a, b, c, _ = scipy.signal.tf2ss(self.num, self.den)
        self.a, self.input, self.out = a, b[:, 0], c[0]
        self.n = len(a)

    def rest(self, x: Array) -> float:
        """The command without its integral part."""
        y = float(self.out @ x[: self.n])
        derivative = self.kd * (self.c * self.setpoint - y - x[-1]) / self.lag
        return float(self.k * (self.b * self.setpoint - y) + derivative)

    def plant_input(self, t: float) -> float:
        """What reaches the plant at a time."""
        past = t - self.delay
        value = self.load if past >= self.load_at else 0.0
        if past < 0.0:
            return value
        for start, end, _, control in reversed(self.segments):
            if start <= past:
                return value + control(min(past, end))
        return value

    def slope(self, x: Array, mode: str, w: float) -> Array:
        """The right-hand side; w is the plant's input."""
        y = float(self.out @ x[: self.n])
        plant = self.a @ x[: self.n] + self.input * w
        lagged = (self.c * self.setpoint - y - x[-1]) / self.lag
        integral = self.ki * (self.setpoint - y)
        if mode in {"hold high", "hold low"}:
            integral = 0.0
        if mode in {"slide high", "slide low"}:
            dy = float(self.out @ plant)
            integral = self.k * dy + self.kd * (dy + lagged) / self.lag
        if self.scheme == "back-calculation" and mode in {"high", "low"}:
            limit = self.limits[1] if mode == "high" else self.limits[0]
            integral += (limit - self.rest(x) - x[self.n]) / self.tracking
        return np.concatenate([plant, [integral, lagged]])

    def run(self, end: float) -> None:
        """March to the horizon."""
        low, high = self.limits
        x = np.zeros(self.n + 2)
        t, mode = 0.0, "free"
        breaks = [self.delay, self.load_at + self.delay]
        while t < end - 1e-12:
            v = self.rest(x) + x[self.n]
            now = self.plant_input(t + 1e-9 * self.delay)
            rate = self.slope(x, "free", now)
            self_rate = self.ki * (self.setpoint - float(self.out @ x[: self.n]))
            moving = self.rate_of_rest(rate)
            mode = self.choose(v, moving, self_rate)
            later = [s for s in breaks if s > t + 1e-12]
            stop = min([end, t + self.delay, *later])
            limit = high if "high" in mode else low
            sign = 1.0 if "high" in mode else -1.0

            def command(_: float, z: Array) -> float:
                return self.rest(z) + float(z[self.n])

            events: list[Any] = []
            if mode == "free":
                events = [lambda s, z: command(s, z) - high, lambda s, z: low - command(s, z)]
            elif "slide" in mode:

                def first(s: float, z: Array, sign: float = sign) -> float:
                    return sign * self.rate_of_rest(self.slope(z, "free", self.plant_input(s)))

                def second(s: float, z: Array, sign: float = sign) -> float:
                    running = self.ki * (self.setpoint - float(self.out @ z[: self.n]))
                    return -sign * (self.rate_of_rest(self.slope(z, "free", self.plant_input(s))) + running)

                events = [first, second]
            else:
                # behind the boundary, so that a start on it is no event
                events = [lambda s, z, sign=sign, limit=limit: sign * (limit - command(s, z)) - BEHIND]
                if self.scheme == "clamping":
                    turn = -sign if "hold" in mode else sign
                    events.append(
                        lambda _, z, turn=turn: (
                            turn * self.ki * (self.setpoint - float(self.out @ z[: self.n])) - BEHIND
                        )
                    )
            for event in events:
                event.terminal, event.direction = True, 1.0
            found: Any = solve_ivp(  # type: ignore[call-overload]
                lambda s, z, mode=mode: self.slope(z, mode, self.plant_input(s)), (t, stop), x,
                method="DOP853", rtol=1e-13, atol=1e-14, events=events, dense_output=True,
                max_step=0.25 * (stop - t),
            )  # fmt: skip
            reached = float(found.t[-1])
            dense = found.sol

            def output(s: float, dense: Any = dense) -> float:
                return float(self.out @ dense(s)[: self.n])

            def control(s: float, dense: Any = dense) -> float:
                z = dense(s)
                return float(np.clip(self.rest(z) + z[self.n], low, high))

            def at_limit(_: float, limit: float = limit) -> float:
                return limit

            self.segments.append((t, reached, output, control if mode == "free" else at_limit))
            breaks += [reached + self.delay]
            t, x = reached, found.y[:, -1]
            assert len(self.segments) < 400, f"the reference does not get beyond t = {t} in mode {mode}"

    def rate_of_rest(self, rate: Array) -> float:
        """The slope of the command without its integral part."""
        dy = float(self.out @ rate[: self.n])
        return -self.k * dy - self.kd * (dy + float(rate[-1])) / self.lag

    def choose(self, v: float, moving: float, integral: float) -> str:
        """The mode in which the next segment begins."""
        low, high = self.limits
        for sign, limit, name in ((1.0, high, "high"), (-1.0, low, "low")):
            off = sign * (v - limit)
            if off < -1e-10:
                continue
            if self.scheme != "clamping":
                rate = moving + integral
                if off > 1e-10 or sign * rate > 0.0:
                    return name
                continue
            pushes = sign * integral > 0.0
            if off > 1e-10 or sign * moving > -1e-11:
                if off > 1e-10 or pushes or sign * (moving + integral) > 0.0:
                    return f"hold {name}" if pushes else name
                continue
            if pushes and sign * (moving + integral) > 1e-11:
                return f"slide {name}"
        return "free"

    def output(self, t: float) -> float:
        """The output at a time inside the horizon."""
        return next(y(t) for start, end, y, _ in self.segments if start <= t <= end)

    def control(self, t: float) -> float:
        """The control signal at a time inside the horizon."""
        return next(u(t) for start, end, _, u in self.segments if start <= t <= end)
