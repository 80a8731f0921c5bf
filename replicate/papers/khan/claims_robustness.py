"""The checkable sentences of Section III-A on robustness, and two on the loops of Section III-B and the Appendix."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math

import numpy as np

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.loops import PI, Loop
from replicate.papers.khan.appendix import POINTS, integral
from replicate.papers.khan.claims import claims
from replicate.papers.khan.example_3_1 import TAU, H
from replicate.papers.khan.processes import RESTORED, gains, plant

PH = (0.01, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0)
STEP = 1e-6  # relative; on either side of a stability limit


def _proposed(ph: float, factor: float = 1.0, delay: float | None = None) -> Loop:
    """Return a loop of rule (7), p = 1, with its gains multiplied by a factor, or with another dead time."""
    kp, ki = gains("Proposed", 1.0, ph, RESTORED)
    return Loop(plant(1.0, ph if delay is None else delay), PI(factor * kp, factor * ki))


@claims.claim(
    "delay-bound",
    "A loop with phase margin $\\phi_m$ at $\\omega_c$ stays stable for $\\Delta h < \\phi_m/\\omega_c$.",
    where="Section III-A",
    consequence="safety",
)
def delay_bound() -> Finding:
    stable = sharp = 0
    relative = {}
    for ph in PH:
        margins = _proposed(ph).margins()
        bound = math.radians(margins.phase) / margins.gain_crossover
        stable += _proposed(ph, delay=ph + bound * (1.0 - STEP)).is_stable()
        sharp += not _proposed(ph, delay=ph + bound * (1.0 + STEP)).is_stable()
        relative[ph] = bound / ph
    return Finding(
        "holds" if stable == len(PH) else "fails",
        min(relative.values()),
        f"For rule (7) at {len(PH)} values of $ph$ from 0.01 to 20 the loop is stable just below the bound in "
        f"{stable} cases "
        f"and unstable just above it in {sharp}: it is the limit itself. At least {number(min(relative.values()), 3)} "
        "dead "
        "times may be added. (These loops have one crossover frequency; with several, the smallest bound counts.)",
    )


@claims.claim(
    "sector",
    "With $M_s$ the loop stays stable with any $f(x)$ between $xM_s/(M_s+1)$ and $xM_s/(M_s-1)$ in it.",
    where="Section III-A",
    consequence="safety",
)
def sector() -> Finding:
    off, unstable, tried = 0.0, 0, 0
    for ph in PH:
        ms = _proposed(ph).sensitivity_peak().value
        low, high = ms / (ms + 1.0), ms / (ms - 1.0)
        # the circle of the criterion has its diameter from -1/low to -1/high
        off = max(off, abs((1.0 / low + 1.0 / high) / 2.0 - 1.0), abs((1.0 / low - 1.0 / high) / 2.0 * ms - 1.0))
        stable = [_proposed(ph, factor).is_stable() for factor in np.linspace(low, high, 9)]
        tried, unstable = tried + len(stable), unstable + stable.count(False)
    return Finding(
        "holds" if off < 1e-12 and not unstable else "fails",
        unstable,
        "It is the circle criterion: the circle with the diameter between $-1/\\mathrm{slope}$ of both ends has its "
        "centre "
        f"at $-1$ and the radius $1/M_s$. Of {tried} loops of rule (7) with a constant gain in the range "
        f"{unstable} are unstable.",
    )


@claims.claim("scaling-of-j", "$J(p, K_P, K_I, h) = h\\,J(ph, K_Ph, K_Ih^2, 1)$.", where="Appendix")
def scaling_of_j() -> Finding:
    off = 0.0
    for h in (0.4, 1.82):
        for ph, kp, ki in POINTS:
            direct = Loop(plant(ph / h, h), PI(kp / h, ki / h**2)).step().ise()
            off = max(off, abs(direct / (h * integral(ph, kp, ki)) - 1.0))
    return Finding(
        "holds" if off < 1e-9 else "fails",
        round(off, 9),
        f"The integrals of the exact responses for two dead times and {len(POINTS)} settings agree to nine digits.",
    )


@claims.claim(
    "bryant-no-overshoot",
    "Bryant's gains give no overshoot in Example 3.1.",
    where="Section III-B, Example 3.1",
    printed="0",
)
def bryant_no_overshoot() -> Finding:
    gain = 0.368
    overshoot = 100.0 * Loop(plant(0.0, H), PI(gain / H)).step().overshoot()
    return Finding(
        "holds" if overshoot < 1e-9 else "fails",
        round(overshoot, 9),
        f"For $\\tau = {TAU}$, $h = {H}$ it is zero to nine decimals. Strictly, {gain} is a little above $1/e$ = "
        f"{number(math.exp(-1.0), 6)}, so that the dominant poles are complex and there is an overshoot, too small "
        "for any "
        "simulation.",
    )
