"""Closed forms for control loops with dead time, in mpmath; they share nothing with `references`.

Sums of binomials and Kummer's functions for PI control of first-order, integrating and pure dead-time
plants, the branch-cut integral for ``e^{-sqrt(s)}``, Lambert W for poles, delay Lyapunov matrices for
squared errors.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import mpmath as mp

from loops.references import DIGITS

# ------------------------------------------------------------------------------------------------------------
# the dead-time series term by term, from tables of transforms; PI control with b = 1


def pi_foptd(gain: float, time_constant: float, dead_time: float, *, k: float, ki: float, t: float) -> mp.mpf:
    """Set-point step of ``gain e^{-sL}/(T s + 1)`` under ``k + ki/s``.

    Every term is a sum of ``s^{-a} (s + 1/T)^{-c}``, which is the transform of
    ``t^{a+c-1} 1F1(c; a+c; -t/T)/Gamma(a+c)``. Negative ``time_constant`` and ``gain`` together are the
    unstable plant ``|gain|/(|T| s - 1)``.
    """

    def term(n: int, x: mp.mpf) -> mp.mpf:
        c = n + 1
        return (mp.mpf(gain) / time_constant) ** c * mp.fsum(
            mp.binomial(c, j)
            * mp.mpf(k) ** j
            * mp.mpf(ki) ** (c - j)
            * x ** (2 * c - j)
            / mp.factorial(2 * c - j)
            * mp.hyp1f1(c, 2 * c + 1 - j, -x / time_constant)
            for j in range(c + 1)
        )

    return _delayed_sum(term, dead_time, t)


def p_foptd(gain: float, time_constant: float, dead_time: float, k: float, t: float) -> mp.mpf:
    """Set-point step of ``gain e^{-sL}/(T s + 1)`` under proportional control: incomplete gamma functions."""
    return _delayed_sum(
        lambda n, x: (mp.mpf(k) * gain) ** (n + 1) * mp.gammainc(n + 1, 0, x / time_constant, regularized=True),
        dead_time,
        t,
    )


def pi_integrator(gain: float, dead_time: float, k: float, ki: float, t: float) -> mp.mpf:
    """Set-point step of ``gain e^{-sL}/s`` under ``k + ki/s``: a polynomial in ``t`` on each interval."""

    def term(n: int, x: mp.mpf) -> mp.mpf:
        c = n + 1
        return mp.mpf(gain) ** c * mp.fsum(
            mp.binomial(c, j) * mp.mpf(k) ** j * mp.mpf(ki) ** (c - j) * x ** (2 * c - j) / mp.factorial(2 * c - j)
            for j in range(c + 1)
        )

    return _delayed_sum(term, dead_time, t)


def pi_dead_time(dead_time: float, k: float, ki: float, t: float) -> mp.mpf:
    """Set-point step of ``e^{-sL}`` under ``k + ki/s``; jumps by ``(-1)^{n-1} k^n`` at ``t = n L``."""

    def term(n: int, x: mp.mpf) -> mp.mpf:
        c = n + 1
        return mp.fsum(
            mp.binomial(c, j) * mp.mpf(k) ** j * mp.mpf(ki) ** (c - j) * x ** (c - j) / mp.factorial(c - j)
            for j in range(c + 1)
        )

    return _delayed_sum(term, dead_time, t)


def _delayed_sum(term: Callable[[int, mp.mpf], mp.mpf], dead_time: float, t: float) -> mp.mpf:
    with mp.workdps(DIGITS + 20 + int(t / dead_time)):  # an alternating sum: digits cancel
        t, dead_time = mp.mpf(t), mp.mpf(dead_time)
        count = int(mp.floor(t / dead_time))
        return mp.fsum((-1) ** n * term(n, t - (n + 1) * dead_time) for n in range(count))


def rational_step(num: Sequence[float], den: Sequence[float], t: float) -> mp.mpf:
    """Step response of the strictly proper ``num/den`` from the exponential of its companion matrix."""
    with mp.workdps(DIGITS):
        order = len(den) - 1
        companion = mp.zeros(order + 1)
        for j in range(order - 1):
            companion[j, j + 1] = 1
        for j in range(order):
            companion[order - 1, j] = -mp.mpf(den[order - j]) / den[0]
        companion[order - 1, order] = 1  # the last state is the constant input
        x = mp.expm(companion * mp.mpf(t))[:, order]
        padded = [0.0] * (order - len(num)) + list(num)
        return mp.fsum(mp.mpf(padded[order - 1 - j]) / den[0] * x[j] for j in range(order))


# ------------------------------------------------------------------------------------------------------------
# transforms that are not rational times a dead time


def root_plant(s: mp.mpc) -> mp.mpc:
    """``e^{-sqrt(s)}``: heat conduction into a half-space, seen at distance 1."""
    return mp.exp(-mp.sqrt(s))


def root_plant_first_wave(k: float, ki: float, t: float) -> mp.mpf:
    """Inverse transform of ``e^{-sqrt(s)} (k + ki/s)/s``: what the step sends through the plant at first.

    Complementary error functions (H. S. Carslaw and J. C. Jaeger, Conduction of Heat in Solids, appendix V).
    """
    with mp.workdps(DIGITS):
        t = mp.mpf(t)
        z = 1 / (2 * mp.sqrt(t))
        once = mp.erfc(z)
        twice = t * ((1 + 2 * z**2) * mp.erfc(z) - 2 * z * mp.exp(-z * z) / mp.sqrt(mp.pi))
        return k * once + ki * twice


def root_plant_pi(signal: str, k: float, ki: float, t: float, *, guesses: Sequence[complex], b: float = 1.0) -> mp.mpf:
    """Step responses of PI control of ``e^{-sqrt(s)}``, the Bromwich line folded onto the branch cut.

    What is left is the pole at 0, the closed-loop poles in the cut plane, and the integral along both sides of
    the negative axis. The poles are infinitely many; ``guesses`` has one of each conjugate pair that still matters
    at time ``t``.
    """
    with mp.workdps(DIGITS):
        t, k, ki, b = mp.mpf(t), mp.mpf(k), mp.mpf(ki), mp.mpf(b)

        def closed_loop(s: mp.mpc, root: mp.mpc) -> tuple[mp.mpc, mp.mpc]:
            # both fractions multiplied by s: numerator and characteristic function, with root = sqrt(s)
            plant = mp.exp(-root)
            numerator = {
                "y": lambda: plant * (b * k * s + ki) / s,
                "u": lambda: (b * k * s + ki) / s,
                "load_y": lambda: plant,
                "load_u": lambda: -plant * (k * s + ki) / s,
            }[signal]()
            return numerator, s + (k * s + ki) * plant

        def characteristic_function(s: mp.mpc) -> mp.mpc:
            return s + (k * s + ki) * mp.exp(-mp.sqrt(s))

        value = mp.mpf({"y": 1, "u": 1, "load_y": 0, "load_u": -1}[signal])
        for guess in guesses:
            pole = mp.findroot(characteristic_function, guess)
            numerator, _ = closed_loop(pole, mp.sqrt(pole))
            value += 2 * mp.re(numerator * mp.exp(pole * t) / mp.diff(characteristic_function, pole))

        def along_cut(v: mp.mpf) -> mp.mpf:
            # s = -v^2 on the upper side, where sqrt(s) = i v; the lower side is its conjugate
            if v == 0:
                return mp.mpf(0)
            s = -v * v
            numerator, denominator = closed_loop(s, mp.mpc(0, v))
            return mp.im(numerator / denominator) * mp.exp(s * t) * 2 * v

        end = mp.sqrt(100 / t)
        return value - mp.quad(along_cut, mp.linspace(0, end, 9)) / mp.pi


# ------------------------------------------------------------------------------------------------------------
# rightmost poles under proportional control


def integrator_p_pole(gain: float, dead_time: float, k: float) -> mp.mpc:
    """Rightmost root of ``s + k gain e^{-sL}``."""
    with mp.workdps(DIGITS):
        return mp.lambertw(-mp.mpf(k) * gain * dead_time) / dead_time


def foptd_p_pole(gain: float, time_constant: float, dead_time: float, k: float) -> mp.mpc:
    """Rightmost root of ``T s + 1 + k gain e^{-sL}``."""
    with mp.workdps(DIGITS):
        ratio = mp.mpf(dead_time) / time_constant
        return mp.lambertw(-mp.mpf(k) * gain * ratio * mp.exp(ratio)) / dead_time - 1 / mp.mpf(time_constant)


# ------------------------------------------------------------------------------------------------------------
# integrals over all time


def squared_integral(A0: mp.matrix, A1: mp.matrix, delay: float, c: mp.matrix, x0: mp.matrix) -> mp.mpf:
    """Integral of ``(c x)^2`` along ``x' = A0 x + A1 x(t - delay)``, ``x = 0`` before ``x(0) = x0``.

    It is ``x0' U(0) x0`` with the delay Lyapunov matrix ``U``, which solves a linear boundary value problem
    (V. L. Kharitonov, Time-Delay Systems: Lyapunov Functionals and Matrices, 2013, section 2.5). The loop
    must be stable.
    """
    n = A0.rows
    with mp.workdps(DIGITS):
        size = n * n

        def columns(operator: Callable[[mp.matrix], mp.matrix]) -> mp.matrix:
            # the matrix of a linear operator on n x n matrices, stacked row by row
            result = mp.zeros(size)
            for j in range(size):
                unit = mp.zeros(n)
                unit[j // n, j % n] = 1
                image = operator(unit)
                for i in range(size):
                    result[i, j] = image[i // n, i % n]
            return result

        # U' = U A0 + V A1 and V' = -A1' U - A0' V with V(t) = U(t - delay)
        blocks = [
            [columns(lambda X: X * A0), columns(lambda X: X * A1)],
            [columns(lambda X: -A1.T * X), columns(lambda X: -A0.T * X)],
        ]
        generator = mp.zeros(2 * size)
        for i in range(2 * size):
            for j in range(2 * size):
                generator[i, j] = blocks[i // size][j // size][i % size, j % size]
        end = mp.expm(generator * mp.mpf(delay))
        # V(delay) = U(0), and the jump of U' at 0: U(0) A0 + V(0) A1 + A0' U(0) + A1' U(delay) = -c'c
        system, right = mp.zeros(2 * size), mp.zeros(2 * size, 1)
        first = columns(lambda X: X * A0 + A0.T * X)
        second = columns(lambda X: X * A1)
        last = columns(lambda X: A1.T * X)
        weight = c.T * c
        for i in range(size):
            for j in range(2 * size):
                system[i, j] = end[size + i, j] - (1 if i == j else 0)
                system[size + i, j] = mp.fsum(last[i, m] * end[m, j] for m in range(size))
                system[size + i, j] += first[i, j] if j < size else second[i, j - size]
            right[size + i] = -weight[i // n, i % n]
        solution = mp.lu_solve(system, right)
        U = mp.matrix(n)
        for i in range(size):
            U[i // n, i % n] = solution[i]
        return (x0.T * U * x0)[0]


def foptd_load_ise(gain: float, time_constant: float, dead_time: float, k: float, ki: float) -> mp.mpf:
    """Integral of the squared output after a unit load step, PI control of ``gain e^{-sL}/(T s + 1)``.

    The states are the output and ``1 - ki`` times its integral.
    """
    with mp.workdps(DIGITS):
        T = mp.mpf(time_constant)
        A0 = mp.matrix([[-1 / T, 0], [-mp.mpf(ki), 0]])
        A1 = mp.matrix([[-mp.mpf(gain) * k / T, gain / T], [0, 0]])
        return squared_integral(A0, A1, dead_time, mp.matrix([[1, 0]]), mp.matrix([0, 1]))


def integrator_p_ise(gain: float, dead_time: float, k: float) -> mp.mpf:
    """Integral of the squared control error after a set-point step, P control of ``gain e^{-sL}/s``.

    Closed form of the integral of ``1/|i w + q e^{-i w L}|^2`` with ``q = k gain``.
    """
    with mp.workdps(DIGITS):
        q = mp.mpf(k) * gain
        return mp.cos(q * dead_time) / (2 * q * (1 - mp.sin(q * dead_time)))
