"""The paper's own tuning rule: a double pole at -a/tau of the loop with a second-order Padé dead time.

All functions are plain arithmetic, so that they are exact when called with `fractions.Fraction`. Symbols are
the paper's: ``K``, ``tau``, ``L`` gain, time constant and dead time of the process, ``a`` the free parameter.
"""

from __future__ import annotations

from typing import NamedTuple

from replicate.loops.tune import Number, first_order_rules


class Assignment(NamedTuple):
    """Gains and residue polynomial s^2 + c1 s + c0 of the pole assignment."""

    Kp: Number
    Ki: Number
    c0: Number
    c1: Number


RULE = first_order_rules()["pole-assignment"]


def delta(L: Number, tau: Number, a: Number) -> Number:
    """Return the common denominator of (21) to (24)."""
    return RULE.where["delta"]({"L": L, "tau": tau, "a": a})  # (25)


def kp(K: Number, L: Number, tau: Number, a: Number) -> Number:
    """Return the proportional gain; the "=" that opens each continuation line of the scan is a "+"."""
    return RULE.gain({"K": K, "L": L, "tau": tau, "a": a, "delta": delta(L, tau, a)})  # (21)


def ki(K: Number, L: Number, tau: Number, a: Number) -> Number:
    """Return the integral gain."""
    assert RULE.integral_gain is not None  # noqa: S101  -- the rule gives ki, no integral time
    return RULE.integral_gain({"K": K, "L": L, "tau": tau, "a": a, "delta": delta(L, tau, a)})  # (22)


def c0(L: Number, tau: Number, a: Number) -> Number:
    """Return the constant coefficient of the residue polynomial."""
    return (  # (23)
        12 * (a**4 * L**4 + 12 * a**3 * tau * L**3 - 12 * a**2 * tau * (L + tau) * L**2)
        + 12 * (-144 * a * tau**3 * L + 144 * tau**3 * (L + tau))
    ) / (L**2 * delta(L, tau, a))  # fmt: skip


def c1_in_copy(L: Number, tau: Number, a: Number) -> Number:
    """Return what the copy at hand has of (24): a sum that ends with a "+" and an empty numerator."""
    return (  # (24)
        -6 * a**4 * L**4 - 72 * (a - 1) * a**2 * tau * L**3 - 72 * (a - 4) * a * tau**2 * L**2
    ) / (L * delta(L, tau, a))  # fmt: skip


def c1(L: Number, tau: Number, a: Number) -> Number:
    """Return (24) with its lost last line restored."""
    return c1_in_copy(L, tau, a) + 864 * tau**3 * (a * L + tau) / (L * delta(L, tau, a))


def assign(K: Number, L: Number, tau: Number, a: Number) -> Assignment:
    """Return gains and residue polynomial by the paper's formulas (21) to (25)."""
    return Assignment(kp(K, L, tau, a), ki(K, L, tau, a), c0(L, tau, a), c1(L, tau, a))


def characteristic(K: Number, L: Number, tau: Number, gains: tuple[Number, Number]) -> tuple[Number, ...]:
    """Return the coefficients of the monic characteristic polynomial, lowest power first."""
    Kp, Ki = gains
    return (  # (14)
        12 * K * Ki / (L**2 * tau),
        (12 + 12 * K * Kp - 6 * K * Ki * L) / (L**2 * tau),
        (6 * L - 6 * K * Kp * L + K * Ki * L**2 + 12 * tau) / (L**2 * tau),
        (L**2 + K * Kp * L**2 + 6 * L * tau) / (L**2 * tau),
        1,
    )


def assigned(tau: Number, a: Number, residue: tuple[Number, Number]) -> tuple[Number, ...]:
    """Return the coefficients of (s + a/tau)^2 (s^2 + c1 s + c0), lowest power first.

    The paper prints 2a/tau^2 + c1 for the coefficient of s^3; it is 2a/tau + c1.
    """
    low, high = residue
    sigma = a / tau
    return (  # (20)
        sigma**2 * low,
        2 * sigma * low + sigma**2 * high,
        sigma**2 + low + 2 * sigma * high,
        2 * sigma + high,
        1,
    )


def match_coefficients(K: Number, L: Number, tau: Number, a: Number) -> Assignment:
    """Solve the four linear equations (14) = (20) directly, by elimination: what (21) to (24) must give."""
    sigma = a / tau
    # Unknowns Kp, Ki, c0, c1; each row is one power of s: coefficients, then the right-hand side.
    d = L**2 * tau
    rows: list[list[Number]] = [
        [0, 12 * K / d, -(sigma**2), 0, 0],
        [12 * K / d, -6 * K * L / d, -2 * sigma, -(sigma**2), -12 / d],
        [-6 * K * L / d, K * L**2 / d, -1, -2 * sigma, sigma**2 - (6 * L + 12 * tau) / d],
        [K * L**2 / d, 0, 0, -1, 2 * sigma - (L**2 + 6 * L * tau) / d],
    ]
    size = len(rows)
    for i in range(size):
        pivot = max(range(i, size), key=lambda r: abs(float(rows[r][i])))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for r in range(size):
            if r != i:
                rows[r] = [x - rows[r][i] * y for x, y in zip(rows[r], rows[i], strict=True)]
    return Assignment(*(row[-1] for row in rows))


class Dominance(NamedTuple):
    """The two margins of condition (27); both must be positive for the double pole to be dominant."""

    linear: Number
    constant: Number

    @property
    def holds(self) -> bool:
        """Whether both margins are positive."""
        return self.linear > 0 and self.constant > 0


def dominance_of(found: Assignment, tau: Number, a: Number) -> Dominance:
    """Return the coefficients of the residue polynomial shifted to -a/tau (26); (27) is their signs."""
    sigma = a / tau
    return Dominance(found.c1 - 2 * sigma, found.c0 - found.c1 * sigma + sigma**2)  # (27)


def dominance(K: Number, L: Number, tau: Number, a: Number) -> Dominance:
    """Return the margins of condition (27) for the paper's formulas."""
    return dominance_of(assign(K, L, tau, a), tau, a)
