"""III, Examples 1 and 2: the PI design with its weight, and how far another plant may be from it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from replicate.exhibits.extrema import smallest
from replicate.loops import PI, Loop, Weight, chordal_distance, gamma_norm, nu_gap, stability_margin, winding_count
from replicate.loops.frequency_domain.gamma_norm import singular_value
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.loop_shaping import (
    PRINTED,
    PROCESS,
    TRUE_PROCESS,
    M,
    design,
    favourable_weight,
    gamma_of_m,
)

if TYPE_CHECKING:
    import pandas as pd

example_1 = paper.table(
    "III-example-1",
    "PI design with the combined circle $M = 2$ and the weight $W$",
    kind="example",
    rows=(
        "k", "ki", "omega0", "Ms", "Mp", "W_min", "omega_W", "gamma", "omega_gamma", "gamma_bound", "omega_gc",
        "omega_pc",
    ),
    columns=("value",),
    labels={
        "k": "$k$",
        "ki": "$k_i$",
        "omega0": "$\\omega_0$",
        "Ms": "$M_s$",
        "Mp": "$M_p$",
        "W_min": "smallest $|W|$",
        "omega_W": "its frequency",
        "gamma": "$\\gamma$ with $W$",
        "omega_gamma": "frequency of the largest $\\sigma$",
        "gamma_bound": "$\\gamma(M)$, (14)",
        "omega_gc": "gain crossover",
        "omega_pc": "phase crossover",
    },
    caption="$G(s) = 1/(s+1)^4$. The paper prints only $k$ and $k_i$.",
)  # fmt: skip
example_1.trials = lambda: {"k": (PROCESS.notation(), PRINTED.notation())}


@example_1.reading("as-written", "Largest $k_i$ outside the combined circle")
def first_example() -> pd.DataFrame:
    """Design the controller and evaluate it unrounded."""
    found = design()
    controller = PI(found.k, found.ki)
    loop = Loop(PROCESS, controller)
    smallest, frequency = smallest_weight(controller)
    gamma = gamma_norm(PROCESS, controller, favourable_weight(controller))
    margins = loop.margins()
    values = {
        "k": found.k,
        "ki": found.ki,
        "omega0": found.frequency,
        "Ms": loop.sensitivity_peak().value,
        "Mp": loop.complementary_peak().value,
        "W_min": smallest,
        "omega_W": frequency,
        "gamma": gamma.value,
        "omega_gamma": gamma.frequency,
        "gamma_bound": float(gamma_of_m(M)),
        "omega_gc": margins.gain_crossover,
        "omega_pc": margins.phase_crossover,
    }
    return example_1.frame(values)


def smallest_weight(controller: PI = PRINTED) -> tuple[float, float]:
    """Return the smallest magnitude of the weight (8) and its frequency, where |Gc|/|G| is stationary.

    With x = w^2, log(|Gc|^2/|G|^2) = log(k^2 x + ki^2) - log x + 4 log(1 + x), whose derivative is a quadratic in x.
    """
    k2, ki2 = controller.k**2, controller.ki**2
    # k2 x (1 + x) - (k2 x + ki2)(1 + x) + 4 x (k2 x + ki2) = 0
    x = max(np.roots([4.0 * k2, 3.0 * ki2, -ki2]).real)
    frequency = float(np.sqrt(x))
    return float(favourable_weight(controller).magnitude(np.array([frequency]))[0]), frequency


class Robustness(NamedTuple):
    """Margin and gap under one weight, and the smallest difference of both, frequency by frequency."""

    b: float
    gap: float
    omega_gap: float
    smallest_difference: float


@cache
def robustness(weighting: str) -> Robustness:
    """Return margin and gap of Example 2 with the printed controller.

    ``weighting`` is one of `weights`.
    """
    weight = weights()[weighting]
    gap = nu_gap(PROCESS, TRUE_PROCESS, weight)

    def differences(log_w: NDArray[np.float64]) -> NDArray[np.float64]:
        w = np.exp(log_w)
        margin = 1.0 / singular_value(PROCESS, PRINTED, w, weight)
        return margin - chordal_distance(PROCESS, TRUE_PROCESS, w, weight)

    grid = np.log(np.geomspace(1e-4, 1e4, 401))
    _, least = smallest(lambda x: float(differences(np.array([x]))[0]), grid, differences(grid))
    return Robustness(stability_margin(PROCESS, PRINTED, weight), gap.value, gap.frequency, least)


def weights() -> dict[str, Weight | None]:
    """Return the weights that are compared."""
    full = favourable_weight()
    k, ki = PRINTED.k, PRINTED.ki
    # |Gc|: the gap is then that of the two loop transfer functions
    controller = Weight(lambda w: np.hypot(k, ki / w), lambda w: -(ki**2) / (w * (ki**2 + k**2 * w**2)))
    return {
        "none": None,
        "favourable": full,
        "smallest": Weight.constant(smallest_weight()[0]),
        "root": _power(full, 0.5),
        "square": _power(full, 2.0),
        "controller": controller,
    }


def _power(weight: Weight, exponent: float) -> Weight:
    return Weight(lambda w: weight.magnitude(w) ** exponent, lambda w: exponent * weight.log_slope(w))


example_2 = paper.table(
    "III-example-2",
    "Does the controller also stabilise $1/(2s+1)^2$?",
    kind="example",
    rows=("b", "nu_gap", "omega_gap", "winding_zeros", "winding_needed", "min_difference", "Ms_true", "pole_true"),
    columns=("value",),
    labels={
        "b": "$b_{G,G_c}$",
        "nu_gap": "$\\delta_\\nu(G,\\bar G)$",
        "omega_gap": "its frequency",
        "winding_zeros": "right half-plane zeros",
        "winding_needed": "needed, $\\deg A_2$",
        "min_difference": "$\\min_\\omega(1/\\sigma - \\delta)$",
        "Ms_true": "$M_s$ with $\\bar G$",
        "pole_true": "rightmost pole with $\\bar G$",
    },
    caption="With the controller as printed, $k = 0.76$, $k_i = 0.36$. A positive smallest difference certifies "
    "stability frequency by frequency, even where the two extremes alone do not.",
)


def _second_example(weighting: str) -> pd.DataFrame:
    found = robustness(weighting)
    winding = winding_count(PROCESS, TRUE_PROCESS)
    loop = Loop(TRUE_PROCESS, PRINTED)
    values = {
        "b": found.b,
        "nu_gap": found.gap,
        "omega_gap": found.omega_gap,
        "winding_zeros": winding.found,
        "winding_needed": winding.needed,
        "min_difference": found.smallest_difference,
        "Ms_true": loop.sensitivity_peak().value,
        "pole_true": loop.rightmost_pole().real,
    }
    return example_2.frame(values)


@example_2.reading(
    "as-written",
    "Without weight",
    note="The paper defines $b$ by the norm of (1), which has no weight, and the gap by a formula without weight.",
)
def unweighted() -> pd.DataFrame:
    """Evaluate margin and gap without weight."""
    return _second_example("none")


@example_2.reading(
    "weighted",
    "With the weight (8)",
    note="Sections 4 and 5 otherwise speak of the weighted norm (10). Then the gap must be weighted too: margin "
    "and gap are comparable only for the same weight.",
)
def weighted() -> pd.DataFrame:
    """Evaluate margin and gap with the favourable weight on both plants."""
    return _second_example("favourable")


comparison = paper.table(
    "III-weights",
    "Margin and gap of Example 2 under several weights",
    printed=False,
    rows=("none", "favourable", "controller", "smallest", "root", "square"),
    columns=("b", "nu_gap", "difference", "min_difference"),
    labels={
        "none": "no weight",
        "favourable": "$W$ of (8)",
        "smallest": "the constant $\\min|W|$",
        "root": "$\\sqrt{W}$",
        "square": "$W^2$",
        "controller": "$G_c$, the gap of $GG_c$ and $\\bar GG_c$",
        "nu_gap": "$\\delta_\\nu$",
        "difference": "$b - \\delta_\\nu$",
        "min_difference": "$\\min_\\omega(1/\\sigma - \\delta)$",
    },
    caption="The paper prints $b = 0.32$ and $\\delta_\\nu \\approx 0.25$. All rows but the "
    "first two are conjectures about how the second number may have been computed; the text supports none.",
)


@comparison.reading("as-written", "Margin and gap by weight")
def by_weight() -> pd.DataFrame:
    """Tabulate margin and gap for each weight."""
    rows = {}
    for name in comparison.rows:
        found = robustness(name)
        rows[name] = [found.b, found.gap, found.b - found.gap, found.smallest_difference]
    return comparison.frame(rows)
