"""The checkable sentences of the supplement on geometry, the example, filters and set point."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, number, share
from replicate.exhibits.extrema import smallest
from replicate.exhibits.matching import meets
from replicate.loops import Loop
from replicate.loops.bounds.gain_boxes import GainBox, sensitivity_at_least
from replicate.loops.bounds.intervals import Interval
from replicate.papers.panagopoulos.part_2 import feasible, filters
from replicate.papers.panagopoulos.part_2.claims import claims
from replicate.papers.panagopoulos.part_2.example import bottom_maximum
from replicate.papers.panagopoulos.part_2.example_controllers import CONTROLLERS, pole_numbers
from replicate.papers.panagopoulos.part_2.noise_figures import NOISE_FREQUENCY, filtered
from replicate.papers.panagopoulos.part_2.processes import G4
from replicate.papers.panagopoulos.part_2.shape import largest_over

Array = NDArray[np.float64]

LOG_W = np.log(np.geomspace(0.01, 100.0, 401))
STEP = LOG_W[1] - LOG_W[0]


@claims.claim(
    "smooth-then-edge",
    "Small $k_d$ give a smooth optimum of $k_i$, large $k_d$ an edge.",
    where="IIs, section 1",
)
def smooth_then_edge() -> Finding:
    kinds = {kd: found.smooth for kd in np.arange(0.0, 3.3, 0.1) if (found := feasible.best(float(kd))) is not None}
    changes = [kd for kd, after in zip(list(kinds), list(kinds)[1:], strict=False) if kinds[kd] != kinds[after]]
    return Finding(
        "holds" if len(changes) == 1 and kinds[min(kinds)] else "fails",
        float(changes[0]) if changes else float("nan"),
        f"For $1/(s+1)^4$ and $M_s = 1.4$ one frequency touches the circle up to $k_d = {number(changes[0], 2)}$, two "
        f"beyond $k_d = {number(changes[0] + 0.1, 2)}$.",
    )


@claims.claim("lower-surface-zero", "For small $k_d$ the lower surface has $k_i = 0$.", where="IIs, section 1")
def lower_surface() -> Finding:
    lifted = {}
    for kd in (0.5, 1.0, 1.5, 2.0, 3.0):
        _, lower, upper = feasible.region(kd)
        lifted[f"$k_d={kd:g}$"] = float(np.mean(lower[~np.isnan(upper)] > 0.0))
    small = [value for key, value in lifted.items() if key in ("$k_d=0.5$", "$k_d=1$")]
    return Finding(
        "holds" if max(small) == 0.0 else "holds-partly",
        max(small),
        f"Share of the feasible $k$ for which the smallest feasible $k_i$ is positive: {listed(lifted, 2)}.",
    )


@claims.claim("envelope-of-vertices", "The envelope of the vertices shows the region.", where="IIs, section 1, Fig. 3")
def envelope() -> Finding:
    excess = {}
    for kd in (1.0, 2.0, 3.0):
        found = feasible.best(kd)
        assert found is not None  # noqa: S101  -- shown in the table of the example
        excess[f"$k_d={kd:g}$"] = bottom_maximum(kd) / found.ki
    return Finding(
        "holds-partly",
        excess["$k_d=3$"],
        f"The highest bottom vertex exceeds the largest feasible $k_i$ by the factors {listed(excess, 3)}; for $k_d = "
        f"4$ nothing is feasible, and the locus still reaches {number(bottom_maximum(4.0), 3)}.",
    )


@claims.claim(
    "example-ms",
    "The two controllers of the example satisfy $M_s = 1.4$.",
    where="IIs, section 1",
    printed="1.4",
)
def example_ms() -> Finding:
    found = {key: float(Loop(G4, c).sensitivity_peak()) for key, c in CONTROLLERS.items()}
    half = 0.005  # of the last printed digit of all gains
    least = {
        key: sensitivity_at_least(
            G4,
            GainBox(
                Interval(c.k - half, c.k + half),
                Interval(c.ki - half, c.ki + half),
                Interval(c.kd - half, c.kd + half),
            ),
            Loop(G4, c).sensitivity_peak().frequency,
        )
        for key, c in CONTROLLERS.items()
    }
    inside = all(value <= 1.4 for value in least.values())
    rounded = all(meets("1.4", value) for value in found.values())
    return Finding(
        "holds" if inside else "holds-partly" if rounded else "fails",
        max(found.values()),
        f"To the printed digits. $M_s$ is {listed(found, 4)}, and for all gains that round to the printed ones "
        "certainly at least "
        f"{listed(least, 4)}: both points lie a little outside the region they are read from, which the loci of the "
        "vertices only approximate.",
    )


@claims.claim("iae-degrades", "With $k_d = 3$ the peak is reduced and the IAE is larger.", where="IIs, section 1")
def iae_degrades() -> Finding:
    load = {key: Loop(G4, c).load_step() for key, c in CONTROLLERS.items()}
    iae = {key: y.iae() for key, y in load.items()}
    peak = {key: float(y.peak()) for key, y in load.items()}
    holds = iae["kd=3"] > iae["kd=1"] and peak["kd=3"] < peak["kd=1"]
    return Finding("holds" if holds else "fails", iae["kd=3"], f"IAE {listed(iae, 4)}; peaks {listed(peak, 3)}.")


@claims.claim(
    "faster-less-damped",
    "With $k_d = 3$ the poles are in general a bit faster, but less damped.",
    where="IIs, section 1",
)
def faster_less_damped() -> Finding:
    one, three = (pole_numbers(c) for c in CONTROLLERS.values())
    damped = [three[key] < one[key] for key in ("zeta1", "zeta2")]
    faster = [abs(three[key]) > abs(one[key]) for key in ("p", "omega1", "omega2")]
    _, kept, total = share([*damped, *faster])
    return Finding(
        "holds" if all(damped) and sum(faster) > len(faster) / 2 else "holds-partly",
        three["omega2"],
        f"{kept} of {total} comparisons agree: both pairs lose damping ({number(one['zeta1'], 3)} to "
        f"{number(three['zeta1'], 3)}, {number(one['zeta2'], 3)} to {number(three['zeta2'], 3)}), but the slow pair, "
        f"which dominates, becomes slower ({number(one['omega2'], 3)} to {number(three['omega2'], 3)}).",
    )


@claims.claim(
    "gain-greater",
    "The gain curve for $k_d = 3$ is greater than or equal to that for $k_d = 1$.",
    where="IIs, section 1, Fig. 5",
)
def gain_greater() -> Finding:
    one, three = (Loop(G4, c) for c in CONTROLLERS.values())

    def ratio(log_w: Array | float) -> Array:
        s = 1j * np.exp(log_w)
        return np.asarray(np.abs(three(s)) / np.abs(one(s)))

    ratios = ratio(LOG_W)
    at, least = smallest(ratio, LOG_W, ratios)
    below = LOG_W[ratios < 1.0]
    ends = [
        float(np.exp(brentq(lambda x: float(ratio(x)) - 1.0, *bracket)))
        for bracket in ((below.min() - STEP, at), (at, below.max() + STEP))
    ]
    return Finding(
        "holds" if least >= 1.0 else "holds-partly",
        least,
        f"Except between {number(ends[0], 3)} and {number(ends[1], 3)} rad/s, where it falls to {number(least, 3)} of "
        "it "
        f"(at {number(float(np.exp(at)), 3)} rad/s).",
    )


@claims.claim(
    "phase-lag-and-lead",
    "For $k_d = 1$ gain and phase fall; for $k_d = 3$ the phase has a lag and a lead.",
    where="IIs, section 1, Fig. 5",
)
def lag_and_lead() -> Finding:
    slopes = {key: largest_over("phase", G4, c, (0.01, 10.0)) for key, c in CONTROLLERS.items()}
    holds = slopes["kd=1"] < 0.0 < slopes["kd=3"]
    return Finding(
        "holds" if holds else "fails", slopes["kd=3"], f"Largest $d\\arg L/d\\ln\\omega$: {listed(slopes, 3)} rad."
    )


@claims.claim("cusp", "The Nyquist curve for $k_d = 3$ has a cusp.", where="IIs, section 1, Fig. 6")
def cusp() -> Finding:
    c = CONTROLLERS["kd=3"]
    loop = Loop(G4, c)

    def speed(log_w: Array | float) -> Array:
        s = 1j * np.exp(log_w)
        turn = s * G4.log_derivative(s) + s * (c.kd - c.ki / s**2) / (c.k + c.ki / s + c.kd * s)
        return np.asarray(np.abs(loop(s) * turn))

    grid = np.log(np.geomspace(0.1, 5.0, 401))
    _, slowest = smallest(speed, grid, speed(grid))
    curvature = largest_over("curvature", G4, c, (0.1, 5.0))
    return Finding(
        "holds-partly",
        curvature,
        "Not in the strict sense: the curve never stands still ($|dL/d\\ln\\omega| \\geq "
        f"{number(slowest, 3)}$). It turns back in a narrow loop, clockwise throughout (largest curvature "
        f"{number(curvature, 2)}): of the two constraints added to prevent it, only the one on the phase does.",
    )


@claims.claim("filter-trade-off", "A smaller $N$ costs performance and filters more.", where="IIs, section 2")
def trade_off() -> Finding:
    iae, noise = {}, {}
    for column in filters.HEADED:
        values = filters.numbers(*filters.by_the_text(column))
        iae[column], noise[column] = values["IAE"], values["Mn"]
    ordered = [
        iae[f"n{n}_N2"] > iae[f"n{n}_N5"] > iae[f"n{n}_N10"]
        and noise[f"n{n}_N2"] < noise[f"n{n}_N5"] < noise[f"n{n}_N10"]
        for n in (1, 2)
    ]
    verdict, _, _ = share(ordered)
    return Finding(
        verdict,
        iae["n1_N2"],
        f"IAE {listed(iae, 3)}; $M_n$ {listed(noise, 3)}; without filter IAE is "
        f"{number(filters.numbers(None, filters.unfiltered().controller)['IAE'], 3)}.",
    )


@claims.claim(
    "orders-alike",
    "First- and second-order filters with $T_f$ of (8) change the loop alike at $\\omega_0$.",
    where="IIs, section 2",
)
def orders_alike() -> Finding:
    gap = {}
    for n in (2, 5, 10):
        one, two = (np.exp(1j * filters.Filter(order, n, 1.0).phase) for order in (1, 2))
        sizes = (1.0 / np.sqrt(1.0 + 1.0 / n**2), 1.0 / (1.0 + 1.0 / (4.0 * n**2)))
        gap[f"$N={n}$"] = float(abs(one * sizes[0] - two * sizes[1]))
    return Finding(
        "holds",
        max(gap.values()),
        f"$F_y(i\\omega_0)$ of the two orders differs by {listed(gap, 2)}, against a change of "
        f"{number(float(abs(1.0 - 1.0 / (1.0 + 0.5j))), 3)} by the filter itself for $N = 2$.",
    )


@claims.claim(
    "filtering-alike",
    "First- and second-order filters filter almost alike; the second order is obviously more efficient.",
    where="IIs, section 2",
)
def filtering_alike() -> Finding:
    at_noise = {}
    for column in filters.HEADED:
        c = filtered(column)
        s = np.array([1j * NOISE_FREQUENCY])
        at_noise[column] = float(np.abs(c.feedback(s) / (1.0 + c.feedback(s) * G4(s)))[0])
    ratio = {f"$N={n}$": at_noise[f"n1_N{n}"] / at_noise[f"n2_N{n}"] for n in (2, 5, 10)}
    return Finding(
        "holds-partly",
        ratio["$N=2$"],
        "The text says both. With the filters of (8), $M_n$ and IAE are close indeed; at 40 rad/s the first-order "
        f"filter lets through {listed(ratio, 3)} times as much. In the printed table the second-order columns look "
        "more efficient because their filters are slower than (8) says.",
    )
