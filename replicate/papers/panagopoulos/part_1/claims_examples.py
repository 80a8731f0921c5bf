"""The checkable sentences of section 5.2: the eight examples."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import Bounds, differential_evolution

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.exhibits.extrema import largest
from replicate.loops import Loop, design_pi
from replicate.loops.sweep.stability_counts import polynomial_roots
from replicate.papers.panagopoulos.part_1.claims_specifications import claims
from replicate.papers.panagopoulos.part_1.corner import corner_limit, slope_limit
from replicate.papers.panagopoulos.part_1.designs import (
    controller,
    design,
    loop,
)
from replicate.papers.panagopoulos.part_1.example_7 import smallest_a, smallest_lag
from replicate.papers.panagopoulos.part_1.example_8 import FINITE, true_sigma
from replicate.papers.panagopoulos.part_1.phase import frequencies_of_lag
from replicate.papers.panagopoulos.part_1.plants import PLANTS, unstable
from replicate.papers.panagopoulos.part_1.table_4 import FACTORS, filtered

LOW, HIGH = 1.4, 2.0


def _lags(plant: str, low: float, high: float) -> Finding:
    """Compare the frequencies at which a plant lags by 90 and 180 degrees with those of the text."""
    found = [frequencies_of_lag(PLANTS[plant], degrees)[0] for degrees in (90.0, 180.0)]
    off = max(abs(found[0] - low), abs(found[1] - high))
    return Finding(
        "holds" if off < 1e-12 else "fails",
        found[1],
        f"The first frequencies at which it lags by 90 and 180 degrees are {number(found[0], 6)} and "
        f"{number(found[1], 6)}: as stated, to rounding.",
    )


@claims.claim("lags-g7", "$e^{-s}$ has $\\omega_{90} = \\pi/2$ and $\\omega_{180} = \\pi$.", where="example 1")
def lags_of_g7() -> Finding:
    return _lags("G7", math.pi / 2.0, math.pi)


@claims.claim("lags-g8", "$e^{-s}/s$ has $\\omega_{90} = 0$ and $\\omega_{180} = \\pi/2$.", where="example 2")
def lags_of_g8() -> Finding:
    return _lags("G8", 0.0, math.pi / 2.0)


@claims.claim(
    "slow-mode",
    "The parameters for $G_{11}$ are close to those for $G_{10}$: the slow mode is disregarded.",
    where="example 4",
)
def slow_mode() -> Finding:
    k = max(abs(design("G11", ms).k / design("G10", ms).k - 1.0) for ms in (LOW, HIGH))
    ki = max(abs(design("G11", ms).ki / design("G10", ms).ki - 1.0) for ms in (LOW, HIGH))
    return Finding(
        "holds" if max(k, ki) < 0.1 else "holds-partly",
        ki,
        f"$k$ differs by at most {k:.0%}, $k_i$ by up to {ki:.0%}. The steady-state gains differ by a factor of "
        f"{number(PLANTS['G10'].gain / PLANTS['G11'].gain, 3)}.",
    )


@claims.claim(
    "curves-coincide",
    "The Nyquist curves for $G_{10}$ and $G_{11}$ coincide above $\\omega_0$.",
    where="example 4, Figure 5",
)
def curves_coincide() -> Finding:
    apart = 0.0
    for ms in (LOW, HIGH):

        def gap(log_w: float, ms: float = ms) -> float:
            s = 1j * np.exp(log_w)
            return float(abs(loop("G10", ms)(s) - loop("G11", ms)(s)))

        apart = max(apart, largest(gap, np.log(design("G10", ms).frequency * np.geomspace(1.0, 100.0, 201)))[1])
    return Finding(
        "holds" if apart < 0.05 else "holds-partly",
        apart,
        f"From $\\omega_0$ on they are at most {number(apart, 2)} apart, little more than the width of a line.",
    )


@claims.claim(
    "corner-limit",
    "The envelope of $G_{12}$ has a continuous derivative for $a \\geq 1.0653$ and a corner below.",
    where="example 5",
    printed="1.0653",
)
def corner_limit_claim() -> Finding:
    return Finding(
        "holds" if round(corner_limit(HIGH), 4) == 1.0653 else "fails",
        corner_limit(HIGH),
        f"For $M_s = 2$ the optimum is a corner up to $a$ = {number(corner_limit(HIGH), 7)}; the limit depends "
        f"on $M_s$ ({', '.join(f'{number(corner_limit(ms))} for {ms}' for ms in (1.8, 1.6, 1.4))}). The "
        f"printed number is where the amplitude of $G_{{12}}$ no longer rises faster than with slope 1, $a$ = "
        f"{number(slope_limit(), 7)}: the limit of condition (20), which is sufficient for theorem 1 only.",
    )


@claims.claim(
    "negative-gain",
    "A negative $k$ is the only way to increase the damping of the oscillatory poles with a PI controller.",
    where="example 5",
)
def negative_gain() -> Finding:
    name, a = "G12 a=0.1", 0.1
    plant = PLANTS[name]

    def lost(gains: Any) -> Any:  # of pairs in columns; scipy's types know no vectorized functions
        characteristic = np.repeat(np.append(plant.den, 0.0)[:, None], gains.shape[1], axis=1)
        characteristic[-2:] += 9.0 * gains
        return -_damping(characteristic)

    # k and ki between nothing and three, far beyond the stability limit
    searched = differential_evolution(
        lost, Bounds([0.0, 0.0], [3.0, 3.0]), seed=1, tol=1e-10, polish=False, vectorized=True, updating="deferred"
    )
    best = -float(searched.fun)
    found = design(name, HIGH)
    own = -float(lost(np.array([[found.k], [found.ki]]))[0])
    return Finding(
        "holds" if best <= a / 6.0 * (1.0 + 1e-6) < own else "fails",
        own,
        f"For $a = 0.1$ the poles have a relative damping of {number(a / 6.0)}; a search over non-negative $k$ and "
        f"$k_i$ finds no more than {number(best)}, and with the design's negative $k$ it is {number(own)}.",
    )


def _damping(characteristic: np.ndarray) -> np.ndarray:
    """Return the relative damping of the complex pairs of highest frequency, negative if unstable, one if none.

    The polynomials stand in columns.
    """
    poles, _ = polynomial_roots(characteristic)
    size = np.where(poles.imag > 1e-9, np.abs(poles), 0.0)
    fastest = np.argmax(size, axis=0)[None]
    highest, real = (np.take_along_axis(x, fastest, axis=0)[0] for x in (size, poles.real))
    return np.asarray(np.divide(-real, highest, out=np.ones_like(highest), where=highest > 0.0))


@claims.claim(
    "undamped",
    "For $a = 0$ the PI controller is unable to damp the oscillatory modes.",
    where="example 5, Figure 7",
)
def undamped() -> Finding:
    pole = loop("G12 a=0.0", LOW).rightmost_pole()
    return Finding(
        "holds" if -pole.real / abs(pole) < 0.1 else "fails",
        -pole.real / abs(pole),
        f"Their relative damping, zero without control, becomes {number(-pole.real / abs(pole), 3)} (poles at "
        f"{number(pole.real, 3)} $\\pm$ {number(pole.imag, 4)}i).",
    )


@claims.claim(
    "no-fast-solution",
    "For the conditionally stable plant there is only one solution for $M_s = 1.4$; the method indicates that no other "
    "controller satisfies the specification.",
    where="example 6",
    printed="1",
)
def no_fast_solution() -> Finding:
    found = design("G13", LOW)
    return Finding(
        "holds" if len(found.solutions) == 1 else "fails",
        len(found.solutions),
        f"The search over all gains finds {len(found.solutions)} stable local solution for $M_s = 1.4$ (k = "
        f"{number(found.k)}) and {len(design('G13', HIGH).solutions)} for $M_s = 2$. The text says “no "
        "controller”; it can only mean none with high gain.",
    )


@claims.claim("a-at-least-3", "For $M_s = 2$ the unstable plant needs $a \\geq 3$.", where="example 7", printed="3")
def a_at_least_3() -> Finding:
    below, above = (design_pi(unstable(a), ms=HIGH).status for a in (2.99, 3.01))
    return Finding(
        "holds" if (below, above) == ("no-controller", "optimal") else "fails",
        smallest_a(HIGH),
        f"The formula gives {number(smallest_a(HIGH))}. The design reports “{below}” for $a = 2.99$ and "
        f"“{above}” for 3.01.",
    )


@claims.claim(
    "smallest-lag",
    "The smallest phase lag of $G_{14}$ is $\\pi - \\arctan((a-1)\\sqrt{a}/2a)$, at $\\omega = \\sqrt{a}$.",
    where="example 7",
)
def smallest_lag_claim() -> Finding:
    off = 0.0
    for a in (4.0, 8.0):
        lag, w = smallest_lag(a)
        formula = 180.0 - math.degrees(math.atan((a - 1.0) * math.sqrt(a) / (2.0 * a)))
        off = max(off, abs(lag - formula), abs(w - math.sqrt(a)))
    return Finding(
        "holds" if off < 1e-9 else "fails",
        round(off, 9),
        "For $a = 4$ and 8 the root of the slope of the phase gives the same lag and frequency.",
    )


@claims.claim(
    "acceptable-overshoot",
    "Despite the large $M_p$ the overshoot is acceptable, because of $b$.",
    where="example 7, Figure 9",
)
def acceptable_overshoot() -> Finding:
    with_b, without = {}, {}
    for a in ("4", "8"):
        plant = f"G14 a={a}"
        with_b[a] = Loop(PLANTS[plant], controller(plant, HIGH, "w_0")).step().overshoot()
        without[a] = loop(plant, HIGH).step().overshoot()
    return Finding(
        "holds" if max(with_b.values()) < 0.1 else "fails",
        max(with_b.values()),
        "Overshoot "
        + ", ".join(f"{with_b[a]:.1%} instead of {without[a]:.0%} with $b = 1$ ($a = {a}$)" for a in with_b)
        + ".",
    )


@claims.claim(
    "noise-tradeoff",
    "A smaller $m$ makes the loop less sensitive to noise and more sensitive to loads.",
    where="example 8",
)
def noise_tradeoff() -> Finding:
    cases = [filtered(m) for m in FACTORS.values() if math.isfinite(m)]
    noise = [case.sigma for case in cases]
    load = [1.0 / case.found.ki for case in cases]
    ordered = noise == sorted(noise) and load == sorted(load, reverse=True)
    return Finding(
        "holds" if ordered else "fails",
        noise[-1] / noise[0],
        f"From $m = 2$ to 20, $\\sigma$ grows by a factor of {number(noise[-1] / noise[0], 3)} and IE falls by "
        f"{1.0 - load[-1] / load[0]:.0%}.",
    )


@claims.claim(
    "overestimate",
    "Replacing $|S|$ by $M_s$ overestimates the control signal by at most a factor $M_s$.",
    where="example 8",
)
def overestimate() -> Finding:
    ratio = {f"m = {name}": filtered(m).sigma / true_sigma(filtered(m)) for name, m in FINITE.items()}
    return Finding(
        "holds" if max(ratio.values()) <= HIGH else "fails",
        max(ratio.values()),
        "Its standard deviation is overestimated by factors of "
        + ", ".join(f"{number(value, 3)} (${key}$)" for key, value in ratio.items())
        + ".",
    )
