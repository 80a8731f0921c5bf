"""The checkable sentences of sections 3 and 4: the optimisation problem and the design procedure."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import fsolve

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, number
from replicate.exhibits.extrema import largest
from replicate.loops import PI, Circle, Loop, Plant
from replicate.loops.design.pi_tangency import smooth_gains
from replicate.papers.panagopoulos.part_1 import theorem_1
from replicate.papers.panagopoulos.part_1.claims_specifications import claims
from replicate.papers.panagopoulos.part_1.designs import (
    BOUNDS,
    SIX,
    design,
    setpoint_peak,
    weight,
)
from replicate.papers.panagopoulos.part_1.plants import PLANTS, filtered_dead_time
from replicate.papers.panagopoulos.part_1.table_4 import filtered

NINE = tuple(f"G{number}" for number in range(1, 10))
ROUNDING = 1e-9


# ------------------------------------------------------------------------------------------------------------
# section 3


@claims.claim(
    "ellipse-centers",
    "The centers of the ellipses (9) generate the boundary of the stability region.",
    where="section 3.1",
)
def ellipse_centers() -> Finding:
    circle = Circle.of(mp=1.5)
    return Finding(
        "holds-partly",
        circle.center,
        "The center of an ellipse is $C$ times the point (11) of the stability limit. So it is true for a "
        "bound on $M_s$, where $C = 1$, and not for one on $M_p$ or on both ($M_p = 1.5$: $C$ = "
        f"{number(circle.center, 3)}).",
    )


@claims.claim(
    "theorem-1", "$h$ has a root between $\\omega_{90}$ and $\\omega_\\dagger$.", where="section 3.3, theorem 1"
)
def theorem() -> Finding:
    single, total, stable = 0, 0, 0
    for plant, ms in theorem_1.ROWS.values():
        low, high = theorem_1.interval(plant, ms)
        found = theorem_1.gains_at_roots(plant, ms)
        inside = [w for w, *_ in found if low < w < high]
        single += len(inside) == 1 and abs(inside[0] / design(plant, ms).frequency - 1.0) < ROUNDING
        total += len(found)
        stable += sum(is_stable for *_, is_stable in found)
    count = len(theorem_1.ROWS)
    return Finding(
        "holds" if single == count else "fails",
        single,
        f"In all {count} cases ($G_1$ to $G_{{11}}$, $M_s = 1.4$ and 2) $h$ has exactly one root in the "
        f"interval, and it is the design ({single} of {count}). Of {total} roots up to a lag of two turns "
        f"{stable} give a stable loop: the same ones.",
    )


@claims.claim(
    "monotone",
    "$G_1$ to $G_9$ satisfy the monotonicity condition (20), $G_6$ included.",
    where="sections 5.1 and 5.2",
)
def monotone() -> Finding:
    slopes, rising = {}, 0
    for plant in NINE:
        low, high = (theorem_1.interval(plant, 1.4)[0], theorem_1.interval(plant, 2.0)[1])
        grid = np.log(np.geomspace(max(low, 1e-3 * high) * 1e-3, high, 301))

        def slope(log_w: NDArray[np.float64], g: Plant = PLANTS[plant]) -> NDArray[np.complex128]:
            s = 1j * np.exp(log_w)
            return np.asarray(s * g.log_derivative(s))

        known = slope(grid)
        slopes[plant] = largest(lambda x, of=slope: of(x).real, grid, known.real)[1] + 0.0  # type: ignore[misc]
        rising += largest(lambda x, of=slope: of(x).imag, grid, known.imag)[1] > 1e-9  # type: ignore[misc]
    steepest = max(slopes, key=lambda key: slopes[key])
    return Finding(
        "holds" if slopes[steepest] < 1.0 and not rising else "fails",
        slopes[steepest],
        f"Up to the upper end of the interval the phase falls in {len(slopes) - rising} of {len(slopes)} "
        f"cases, and the largest slope of the amplitude is {number(slopes[steepest], 3)} ({steepest}), below "
        "1.",
    )


@claims.claim("positive-gains", "In the interval (21) both $k$ and $k_i$ are positive.", where="section 3.3, remark 2")
def positive_gains() -> Finding:
    smallest = math.inf
    for plant, ms in theorem_1.ROWS.values():
        low, high = theorem_1.interval(plant, ms)
        for share in (0.01, 0.25, 0.5, 0.75, 0.99):
            k, ki = smooth_gains(PLANTS[plant], Circle.of(ms), low + share * (high - low))
            smallest = min(smallest, k, ki)
    return Finding(
        "holds" if smallest > 0.0 else "fails",
        smallest,
        f"At five points of each of the {len(theorem_1.ROWS)} intervals the smallest of all gains is "
        f"{number(smallest, 3)}.",
    )


@claims.claim("upper-vertex", "The upper vertex of the ellipse gives an unstable loop.", where="section 3.4")
def upper_vertex() -> Finding:
    stable = 0
    for plant, ms in theorem_1.ROWS.values():
        w = design(plant, ms).frequency
        value = complex(PLANTS[plant](1j * w))
        k, lower = smooth_gains(PLANTS[plant], Circle.of(ms), w)
        upper = lower + 2.0 * w * Circle.of(ms).radius / abs(value)
        stable += Loop(PLANTS[plant], PI(k, upper)).is_stable()
    return Finding(
        "holds" if stable == 0 else "fails",
        stable,
        f"At $\\omega_0$ of the {len(theorem_1.ROWS)} designs the upper vertex is stable in {stable} cases.",
    )


@claims.claim(
    "corner-start",
    "The intersection of the vertex loci (22) overestimates the corner's $k_i$.",
    where="section 3.4",
)
def corner_start() -> Finding:
    excess = {}
    circle = Circle.of(2.0)
    for a in (0.0, 0.1, 0.2, 0.5, 1.0):
        plant, found = PLANTS[f"G12 a={a}"], design(f"G12 a={a}", 2.0)

        def vertices(w: float, sign: float, g: object = plant) -> tuple[float, float]:
            value = complex(g(1j * w))  # type: ignore[operator]
            r = abs(value)
            k = -circle.center * value.real / r**2 + sign * circle.radius / r
            return k, -circle.center * w * value.imag / r**2  # (22)

        def gap(x: np.ndarray) -> np.ndarray:
            return np.subtract(vertices(x[0], 1.0), vertices(x[1], -1.0))

        start = fsolve(gap, found.frequencies, xtol=1e-12)
        excess[f"a = {a}"] = vertices(start[0], 1.0)[1] / found.ki - 1.0
    return Finding(
        "holds" if min(excess.values()) > 0.0 else "fails",
        min(excess.values()),
        "Overestimated by "
        + ", ".join(f"{value:.0%} (${key}$)" for key, value in excess.items())
        + " for the corners of Table 3.",
    )


# ------------------------------------------------------------------------------------------------------------
# section 4


@claims.claim(
    "msp-one", "With $b$ by (25) the peak $M_{sp}$ is close to 1, unless $b = 0$.", where="sections 4.1 and 5.1"
)
def msp_one() -> Finding:
    peaks: dict[str, dict[str, float]] = {"w_mp": {}, "w_0": {}}
    for rule, found in peaks.items():
        for plant in SIX:
            for ms in BOUNDS:
                b = weight(plant, ms, "w_mp" if rule == "w_mp" else "w_0")
                if b > 0.0:
                    found[f"{plant}, $M_s = {ms}$"] = setpoint_peak(plant, ms, b)
    worst = {rule: max(found, key=lambda key, found=found: found[key]) for rule, found in peaks.items()}  # type: ignore[misc]
    stated, used = peaks["w_mp"][worst["w_mp"]], peaks["w_0"][worst["w_0"]]
    return Finding(
        "holds-partly",
        stated,
        f"With $b$ at $\\omega_{{mp}}$, as the text says, $M_{{sp}}$ is at most {number(stated)} "
        f"({worst['w_mp']}) in Table 1 where $b > 0$. With the printed $b$, which belong to $\\omega_0$, it "
        f"reaches {number(used)} ({worst['w_0']}).",
    )


@claims.claim("b-zero", "Where $b = 0$, $M_{sp} = 1$ is not reached.", where="section 5.1")
def b_zero() -> Finding:
    peaks = {
        f"{plant}, $M_s = {ms}$": setpoint_peak(plant, ms, 0.0)
        for plant in SIX
        for ms in BOUNDS
        if weight(plant, ms, "w_0") == 0.0
    }
    return Finding(
        "holds" if min(peaks.values()) > 1.0 else "fails",
        min(peaks.values()),
        f"$M_{{sp}}$ with $b = 0$: {listed(peaks)}.",
    )


@claims.claim(
    "minor-changes",
    "A filter with $m = 5$ to 10 gives only minor changes, so that the design need not be repeated.",
    where="section 4.2",
)
def minor_changes() -> Finding:
    peaks = {}
    for m in (5, 10):
        found = design("G7", 2.0)
        filtered_plant = filtered_dead_time(filtered(float(m)).filter_time)
        peaks[f"m = {m}"] = Loop(filtered_plant, PI(found.k, found.ki)).sensitivity_peak().value
    return Finding(
        "holds" if max(peaks.values()) < 2.2 else "holds-partly",
        max(peaks.values()),
        "The pure dead time $G_7$ with the controller for $M_s = 2$ and a filter added afterwards has $M_s$ = "
        + ", ".join(f"{number(value)} (${key}$)" for key, value in peaks.items())
        + ".",
    )
