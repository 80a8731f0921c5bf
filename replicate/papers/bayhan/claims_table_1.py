"""Table 1: the rule “ITSE for load disturbance” against the optima of the criteria."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math
from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.loops import PI, Loop
from replicate.papers.bayhan.claims import claims
from replicate.papers.bayhan.processes import Process, competing_rules


@cache
def _best_load(criterion: Literal["ise", "itse"]) -> tuple[float, float, float]:
    """Return k and Ti that minimise a load criterion for K = tau = 1, L = 0.5, and the minimum."""

    def cost(logarithms: NDArray[np.float64]) -> float:
        k, ti = np.exp(logarithms)
        return _load_cost(criterion, float(k), float(ti))

    start = np.array([math.log(2.4), 0.0])
    result = optimize.minimize(cost, start, method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-12})
    k, ti = np.exp(result.x)
    return float(k), float(ti), float(result.fun)


def _load_cost(criterion: Literal["ise", "itse"], k: float, ti: float) -> float:
    """Return an integral criterion of the unit load response, K = tau = 1, L = 0.5; infinite if unstable."""
    loop = Loop(Process("", 1.0, 1.0, 0.5, 1.0, 1.0).plant, PI(k=k, ki=k / ti))
    if not loop.is_stable():
        return math.inf
    response = loop.load_step()
    return response.ise() if criterion == "ise" else response.itse()


@claims.claim(
    "itse-exponent",
    "The exponent in $T_i$ of the rule “ITSE for load disturbance” is $-0.586$.",
    where="Table 1",
    consequence="formula",
)
def itse_exponent() -> Finding:
    symbols = {"K": 1.0, "tau": 1.0, "L": 0.5}
    printed, mended = (float(competing_rules(v)["ITSE"].evaluate(**symbols).ti) for v in ("printed", "corrected"))
    _, ise, _ = _best_load("ise")
    _, itse, _ = _best_load("itse")
    return Finding(
        "fails" if abs(mended - ise) < abs(printed - ise) and abs(mended - itse) < abs(printed - itse) else "holds",
        printed,
        f"For $L/\\tau = 0.5$ the printed rule gives $T_i/\\tau$ = {number(printed)}, with the sign "
        f"changed {number(mended)}. The controllers that minimise ISE and ITSE of the load response have "
        f"{number(ise)} and {number(itse)}. Example 4.1 has $L/\\tau = 1$ where the sign does not matter; "
        "that ITSE is unstable in Example 4.2 depends on it.",
    )


@claims.claim(
    "cohen-coon-factor",
    "The integral time of the Cohen-Coon rule has the factor $1/K$.",
    where="Table 1",
)
def cohen_coon_factor() -> Finding:
    def stretched(variant: Literal["printed", "corrected"]) -> float:
        slow, fast = (
            float(competing_rules(variant)["CC"].evaluate(K=1.0, tau=unit, L=unit).ti) for unit in (10.0, 1.0)
        )
        return slow / fast

    printed, mended = stretched("printed"), stretched("corrected")
    return Finding(
        "holds" if math.isclose(printed, 10.0) else "undecided" if math.isclose(mended, 10.0) else "fails",
        printed,
        "A time must grow tenfold when all times of the process do: with the factor $1/K$ it grows by "
        f"{number(printed)}, with $\\tau$ in its place by {number(mended)}. One symbol, in the paper or in the copy at "
        "hand; Example 4.1 has $K = \\tau = 1$, where the two are the same.",
    )


@claims.claim(
    "itse-label",
    "The rule “ITSE for load disturbance” minimises the time-weighted squared error.",
    where="section I, Table 1",
)
def itse_label() -> Finding:
    gains = competing_rules("corrected")["ITSE"].evaluate(K=1.0, tau=1.0, L=0.5)
    k, ti = float(gains.kp), float(gains.ti)
    excess: dict[Literal["ise", "itse"], float] = {
        name: _load_cost(name, k, ti) / _best_load(name)[2] - 1.0 for name in ("ise", "itse")
    }
    return Finding(
        "fails" if excess["ise"] < 0.2 * excess["itse"] else "holds",
        excess["itse"],
        "For $L/\\tau = 0.5$, with the sign of its exponent corrected, the rule exceeds the smallest possible "
        f"ITSE by {excess['itse']:.2%} but the smallest possible ISE by only {excess['ise']:.3%}: its "
        "coefficients minimise ISE.",
    )
