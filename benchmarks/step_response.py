"""Speed and error of one unit-step response, against python-control's usual way in the same process.

The loop is (0.6 + 0.5/s) e^{-s}/(s + 1), the grid 4001 points of [0, 40]. The reference is the closed-form method
of steps in 50-digit arithmetic, which shares no code with either.
"""

from __future__ import annotations

import time

import control
import mpmath as mp
import numpy as np

from replicate.loops import PI, Loop, Plant

K, KI, UNTIL = 0.6, 0.5, 40.0
TIMES = np.linspace(0.0, UNTIL, 4001)
CHECKED = TIMES[::40]


def exact(t: float) -> float:
    """Return the response by the method of steps in closed form, path by path, as residues at s = 0 and s = -1."""
    total = mp.mpf(0)
    for n in range(int(t)):
        total += (-1) ** n * path(n, mp.mpf(t) - (n + 1))
    return float(total)


def path(n: int, t: mp.mpf) -> mp.mpf:
    """Return the inverse of (k s + ki)^(n+1) / (s^(n+2) (s+1)^(n+1)) at t, from its Taylor coefficients."""

    def top(s: mp.mpf) -> mp.mpf:
        return (mp.mpf(K) * s + mp.mpf(KI)) ** (n + 1) * mp.exp(s * t)

    at_zero = mp.taylor(lambda s: top(s) / (s + 1) ** (n + 1), 0, n + 1)[n + 1]
    at_lag = mp.taylor(lambda s: top(s) / s ** (n + 2), -1, n)[n]
    return at_zero + at_lag


def best_of(function: object, repeats: int) -> float:
    """Return the shortest time of several calls, in seconds: the machine's noise only ever adds."""
    shortest = float("inf")
    for _ in range(repeats):
        start = time.perf_counter()
        function()  # type: ignore[operator]
        shortest = min(shortest, time.perf_counter() - start)
    return shortest


def main() -> None:
    """Print the table."""
    mp.mp.dps = 50
    reference = np.array([exact(float(t)) for t in CHECKED])

    def ours() -> np.ndarray:
        return Loop(Plant.foptd(1.0, 1.0, 1.0), PI(K, KI)).step(until=UNTIL)(TIMES)

    delay = control.tf(*control.pade(1.0, 10))

    def theirs() -> np.ndarray:
        loop = control.feedback(control.tf([K, KI], [1.0, 0.0]) * control.tf([1.0], [1.0, 1.0]) * delay)
        return np.asarray(control.step_response(loop, TIMES).outputs)

    rows = [
        ("replicate.loops", best_of(ours, 50), np.max(np.abs(ours()[::40] - reference))),
        ("python-control, Pade 10", best_of(theirs, 5), np.max(np.abs(theirs()[::40] - reference))),
    ]
    print(f"{'step response, 4001 points':28}{'ms':>10}{'error':>12}{'times as fast':>16}")
    for name, seconds, error in rows:
        print(f"{name:28}{1e3 * seconds:10.3f}{error:12.1e}{rows[1][1] / seconds:16.1f}")


if __name__ == "__main__":
    main()
