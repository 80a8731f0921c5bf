"""The paper's fits (2) of overshoot and (3) of rise time, from their printed coefficients."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.papers.khan import paper

Array = NDArray[np.float64]
Coefficients = dict[str, Any]

CASES = ("I", "II", "III", "IV")
CASE_1 = ("offset", "a", "b", "c", "d", "e", "f")  # offset + (a + b e^(-ph/c)) (Kh - d - e e^(-ph/f))^1.5


@cache
def printed_coefficients() -> Coefficients:
    """Return the printed coefficients by case: those of case I by name, of the others by function of ph.

    In cases III and IV a function is x0 + x1 ph + x2 e^(ph/x3), in (3) the last is a rate, e^(x3 ph); in case II it is
    a polynomial, constant first.
    """
    found: Coefficients = {}
    for (row, _), number in paper.printed_numbers("refit-coefficients").items():
        case, part = row.split()
        found.setdefault(case, {}).setdefault(part, []).append(number)
    one = found["case-1"]
    return found | {"case-1": dict(zip(CASE_1, one["amplitude"] + one["shift"], strict=True))}


def case_of(ph: float, kh: float) -> str | None:
    """Return the case of (2) that covers a point; where two meet, the first. None if no case covers it."""
    if ph <= 0.5:
        if kh <= 0.7:
            return "I"
        return "II" if kh <= 1.5 else None
    if ph <= 3.0:
        return "III"
    return "IV" if ph <= 10.0 else None


def m_of_case(case: str, ph: Array | float, kh: Array | float, coefficients: Coefficients | None = None) -> Array:
    """Evaluate M(p, K, h) of one case, in per cent; ``nan`` where it is complex."""
    c = coefficients or printed_coefficients()
    ph, kh = np.asarray(ph, dtype=float), np.asarray(kh, dtype=float)
    if case == "I":
        one = c["case-1"]
        base = kh - one["d"] - one["e"] * np.exp(-ph / one["f"])
        size = one["a"] + one["b"] * np.exp(-ph / one["c"])
        return np.asarray(np.where(base >= 0.0, one["offset"] + size * np.maximum(base, 0.0) ** 1.5, np.nan))
    if case == "II":
        two = c["case-2"]
        return np.asarray(np.polyval(two["constant"][::-1], ph) + kh * np.polyval(two["slope"][::-1], ph))
    if case == "III":
        a, b, e, d = (_exponential(c["case-3"][name], ph) for name in "ABCD")
        return np.asarray(a + b * kh + e * np.exp(d * kh))
    a, b = (_exponential(c["case-4"][name], ph) for name in "AB")
    return np.asarray(a + b * kh)


def fit_of_case(case: str, ph: Array | float, kh: Array | float, coefficients: Coefficients | None = None) -> Array:
    """Return Max[0, M] of one case in per cent; 0 where M is complex."""
    return np.asarray(np.maximum(np.nan_to_num(m_of_case(case, ph, kh, coefficients)), 0.0))


def overshoot_fit(ph: float, kh: float, case: str | None = None) -> float:
    """Return Max[0, M] of (2) in per cent; 0 where M is complex, ``nan`` where no case covers the point."""
    case = case or case_of(ph, kh)
    if case is None:
        return float("nan")
    return float(fit_of_case(case, ph, kh))


def overshoot_fits(ph: Array, kh: Array) -> Array:
    """Return Max[0, M] of (2) at many points; see `overshoot_fit`."""
    cases = cases_of(ph, kh)
    found = np.full(ph.shape, np.nan)
    for case in CASES:
        mask = cases == case
        found[mask] = fit_of_case(case, ph[mask], kh[mask])
    return found


def cases_of(ph: Array, kh: Array) -> NDArray[np.str_]:
    """Return the case of (2) that covers each point, "" where none does."""
    return np.array([case_of(*point) or "" for point in zip(ph.tolist(), kh.tolist(), strict=True)])


def complex_below(ph: float) -> float:
    """Return the gain below which case I takes the power of a negative number."""
    one = printed_coefficients()["case-1"]
    return float(one["d"] + one["e"] * np.exp(-ph / one["f"]))


def positive_from(ph: float) -> float:
    """Return the gain from which case I estimates an overshoot above zero."""
    one = printed_coefficients()["case-1"]
    size = one["a"] + one["b"] * np.exp(-ph / one["c"])
    return complex_below(ph) + float((-one["offset"] / size) ** (2.0 / 3.0))


def rise_time_parts(ph: Array | float, coefficients: Coefficients | None = None) -> tuple[Array, Array, Array, Array]:
    """Return A2, B2, C2, D2 of (3)."""
    c = (coefficients or printed_coefficients())["rise-time"]
    ph = np.asarray(ph, dtype=float)
    a, b, e, d = (np.asarray(v[0] + v[1] * ph + v[2] * np.exp(v[3] * ph)) for v in (c[name] for name in "ABCD"))
    return a, b, e, d


def rise_time_fit(ph: Array | float, kh: Array | float, coefficients: Coefficients | None = None) -> Array:
    """Return t_r / h of (3)."""
    a, b, c, d = rise_time_parts(ph, coefficients)
    kh = np.asarray(kh, dtype=float)
    return np.asarray(a * np.exp(-kh / b) + c * np.exp(-kh / d))


def case_4_parts(ph: float) -> tuple[float, float]:
    """Return A1, B1 of case IV."""
    c = printed_coefficients()["case-4"]
    return float(_exponential(c["A"], ph)), float(_exponential(c["B"], ph))


def _exponential(coefficients: list[float], ph: Array | float) -> Array:
    a, b, c, d = coefficients
    return np.asarray(a + b * np.asarray(ph) + c * np.exp(np.asarray(ph) / d))
