"""Section 6: the worst case over a box of process parameters, and which of its corners it is."""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.normalised_loop import crossover, end_frequency, phase_margin, point
from replicate.papers.krajewski.points import TAU, named_points
from replicate.papers.krajewski.table_1 import MARGINS

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]

SPREADS = (10, 20, 30)  # percent by which K, L and T may be off, independently
VERTICES = {f"K{k}-L{ell}-T{t}": (k, ell, t) for k, ell, t in product("Mm", "Mm", "mM")}
INWARD = 1e-7  # step from a vertex by which its slopes are judged
PAPERS_VERTEX = "KM-LM-Tm"  # "the worst case usually corresponds to the vertex [K_M, L_M, T_m]"
FRACTIONS = tuple(k / 10 for k in range(1, 10))  # of the highest compatible crossover frequency

LABELS = {name: f"$[K_{k}, L_{ell}, T_{t}]$" for name, (k, ell, t) in VERTICES.items()}


class Changed(NamedTuple):
    """Phase margin (degrees) and actual crossover frequency, as a multiple of 1/T, of changed processes."""

    phase_margin: Array
    crossover: Array


def changed(design: ArrayLike, K: ArrayLike, L: ArrayLike, T: ArrayLike) -> Changed:
    """Return what becomes of a design when the process changes and the controller does not.

    Parameters
    ----------
    design
        a, b and τ of the nominal loop.
    K, L, T
        The changed parameters as multiples of the nominal ones; they broadcast.

    Notes
    -----
    A negative phase margin means that the loop has become unstable.
    """
    a, b, tau = np.asarray(design, dtype=float)
    K, L, T = np.asarray(K, dtype=float), np.asarray(L, dtype=float), np.asarray(T, dtype=float)
    a_new, b_new, tau_new = a * K * T, b * K, tau * L / T  # (24)
    w = crossover(a_new, b_new)
    return Changed(phase_margin(a_new, b_new, tau_new, w), w / T)


def at_vertices(design: ArrayLike, spread: float) -> Changed:
    """Return phase margins and crossovers at the eight vertices, in the order of `VERTICES`."""
    factor = {"m": 1.0 - spread / 100.0, "M": 1.0 + spread / 100.0}
    K, L, T = np.array([[factor[x] for x in vertex] for vertex in VERTICES.values()]).T
    return changed(design, K, L, T)


def worst_in_box(design: ArrayLike, spread: float) -> float:
    """Return the smallest phase margin over the whole box.

    It falls with L at every (K, T), so only the face L = L_M is searched: a grid, and a refinement of its best point.
    """
    from scipy.optimize import minimize

    h = spread / 100.0
    side = np.linspace(1.0 - h, 1.0 + h, 41)
    K, T = np.meshgrid(side, side, indexing="ij")
    margins = changed(design, K, 1.0 + h, T).phase_margin
    i, j = np.unravel_index(np.argmin(margins), margins.shape)

    def margin(x: Array) -> float:
        return float(changed(design, x[0], 1.0 + h, x[1]).phase_margin)

    start = np.array([K[i, j], T[i, j]])
    if {i, j} <= {0, side.size - 1}:  # at a vertex: there is nothing to refine where the margin rises into the face
        inside = start + np.diag(INWARD * np.sign(1.0 - start))
        if np.all(changed(design, inside[:, 0], 1.0 + h, inside[:, 1]).phase_margin > margins[i, j]):
            return float(margins[i, j])

    found = minimize(margin, start, method="L-BFGS-B", bounds=[(1.0 - h, 1.0 + h)] * 2)
    return float(min(margins.min(), found.fun))


@cache
def designs() -> tuple[tuple[float, float, float], ...]:
    """Return (a, b, τ) of the designs that are counted: every chart, every margin of Table 1, nine crossovers each."""
    found = []
    for tau, margin, fraction in product(TAUS, MARGINS, FRACTIONS):
        a, b = point(tau, fraction * end_frequency(tau, float(margin)), float(margin))
        found.append((float(a), float(b), tau))
    return tuple(found)


@cache
def worst_vertices(spread: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return for every design the vertex with the least phase margin, and that with the largest |Δω_A| (26)."""
    names = np.array(list(VERTICES))
    every = np.array(designs()).T[:, :, None]  # a row of vertices for each design
    there, nominal = at_vertices(every, spread), changed(every, 1.0, 1.0, 1.0)
    by_crossover = np.argmax(np.abs(there.crossover - nominal.crossover), axis=1)
    return tuple(names[np.argmin(there.phase_margin, axis=1)].tolist()), tuple(names[by_crossover].tolist())


robustness = paper.table(
    "robustness",
    "Which vertex of the parameter box is the worst",
    printed=False,
    rows=(*VERTICES, "designs", "inside"),
    columns=(*(f"m_phi_{spread}" for spread in SPREADS), *(f"omega_A_{spread}" for spread in SPREADS)),
    caption="Share of designs for which a vertex has the least phase margin, and the largest change of "
    "crossover frequency, if $K$, $L$ and $T$ may each be off by 10, 20 or 30 %. The designs: every "
    "$\\tau$ of the charts, every phase margin of Table 1, and crossover frequencies of 0.1 to 0.9 times "
    "the highest compatible one. The paper expects $[K_M, L_M, T_m]$ for the phase margin. Last row: "
    "share of designs for which a point that is not a vertex is worse than all vertices, by more than a "
    "thousandth of a degree. $L$ does not change the crossover frequency; ties are counted for $L_M$.",
    labels={
        **LABELS,
        "designs": "designs",
        "inside": "worst not at a vertex",
        **{f"m_phi_{spread}": f"$m_\\varphi$, ±{spread} %" for spread in SPREADS},
        **{f"omega_A_{spread}": f"$\\hat\\omega_A$, ±{spread} %" for spread in SPREADS},
    },
)


@robustness.reading("as-written", "Vertices of the box")
def shares() -> pd.DataFrame:
    """Count the worst vertices."""
    import pandas as pd

    columns = {}
    for spread in SPREADS:
        by_margin, by_crossover = worst_vertices(spread)
        inside = sum(
            worst_in_box(design, spread) < at_vertices(design, spread).phase_margin.min() - 1e-3 for design in designs()
        )
        for name, worst, elsewhere in (("m_phi", by_margin, inside), ("omega_A", by_crossover, np.nan)):
            counted = [worst.count(vertex) / len(worst) for vertex in VERTICES]
            columns[f"{name}_{spread}"] = [*counted, len(worst), elsewhere / len(worst)]
    return pd.DataFrame(columns, index=list(robustness.rows))[list(robustness.columns)]


FIGURES = ("fig-8", "fig-9", "fig-10", "fig-11", "fig-12")
POINTS = {f"{figure}-{row}": (named.a, named.b) for figure in FIGURES for row, named in named_points(figure).items()}
SPREAD_OF_POINTS = 20

robust_points = paper.table(
    "robustness-points",
    "The worst case at the paper's own points",
    printed=False,
    rows=tuple(POINTS),
    columns=("nominal", "paper_vertex", "other_vertex", "worst", "too_high", "paper_is_worst", "tau_omega_squared"),
    caption="Phase margins in degrees, $\\tau = 0.5$, parameters off by up to ±20 %: at $[K_M, L_M, "
    "T_m]$, at $[K_M, L_M, T_M]$, the worst in the whole box, and by how much the paper's vertex is above "
    "the worst. For $b = a$ and small deviations a shorter $T$ is worse exactly if $\\tau\\omega_A^2 > 1$ "
    "(last column).",
    labels={
        **{key: f"Fig. {key.split('-', 2)[1]} ({key.split('-', 2)[2]})" for key in POINTS},
        "paper_vertex": LABELS[PAPERS_VERTEX],
        "other_vertex": LABELS["KM-LM-TM"],
        "too_high": "paper's minus worst",
        "paper_is_worst": "paper's vertex is the worst",
        "tau_omega_squared": "$\\tau\\omega_A^2$",
    },
)


@robust_points.reading("as-written", "±20 %")
def points_table() -> pd.DataFrame:
    """Compare the paper's vertex with the worst case."""
    rows = {}
    names = list(VERTICES)
    for key, (a, b) in POINTS.items():
        design = (a, b, TAU)
        margins = at_vertices(design, SPREAD_OF_POINTS).phase_margin
        paper_vertex = float(margins[names.index(PAPERS_VERTEX)])
        worst = worst_in_box(design, SPREAD_OF_POINTS)
        rows[key] = [
            float(phase_margin(a, b, TAU)),
            paper_vertex,
            float(margins[names.index("KM-LM-TM")]),
            worst,
            paper_vertex - worst,
            float(names[int(np.argmin(margins))] == PAPERS_VERTEX),
            TAU * float(crossover(a, b)) ** 2,
        ]
    return robust_points.frame(rows)
