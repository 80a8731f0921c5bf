"""Example 6: a conditionally stable plant with two solutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import WeightRule, design, weight
from replicate.papers.panagopoulos.part_1.phase import frequencies_of_lag
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    import pandas as pd

PLANT = "G13"

# name: Ms and place among the solutions, which are ordered by falling ki
SOLUTIONS = {"slow": (2.0, 1), "fast": (2.0, 0), "only": (1.4, 0)}
_SYMBOLS = {"k": "k", "ki": "k_i", "b": "b", "w0": "\\omega_0"}
_TITLES = {"slow": "slow, $M_s = 2$", "fast": "fast, $M_s = 2$", "only": "$M_s = 1.4$"}

example_6 = paper.table(
    "I-example-6",
    "A conditionally stable plant, $G_{13}$",
    kind="example",
    rows=(
        "w90",
        "w180_1",
        "w180_2",
        "crossing_1",
        "crossing_2",
        "k_low",
        "k_high",
        "solutions_2.0",
        "solutions_1.4",
        *(f"{symbol}_{name}" for name in SOLUTIONS for symbol in _SYMBOLS),
    ),
    columns=("value",),
    caption="Where the plant lags by 90 and 180 degrees, where its Nyquist curve crosses the negative real "
    "axis, and the gains between which proportional feedback is unstable; then the two solutions for $M_s = "
    "2$ and the one for $M_s = 1.4$.",
    labels={
        "w90": "$\\omega_{90}$",
        "w180_1": "$\\omega_{180}$, first",
        "w180_2": "$\\omega_{180}$, second",
        "crossing_1": "crossing, nearer to 0",
        "crossing_2": "crossing, farther out",
        "k_low": "stable below $k$",
        "k_high": "stable above $k$",
        "solutions_2.0": "solutions, $M_s = 2$",
        "solutions_1.4": "solutions, $M_s = 1.4$",
        **{f"{key}_{name}": f"${tex}$, {_TITLES[name]}" for name in SOLUTIONS for key, tex in _SYMBOLS.items()},
        "value": "Value",
    },
)


def _values(rule: WeightRule) -> dict[str, float]:
    plant = PLANTS[PLANT]
    first, second = frequencies_of_lag(plant, 180.0)
    outer, inner = (float(complex(plant(1j * w)).real) for w in (first, second))
    values = {
        "w90": frequencies_of_lag(plant, 90.0)[0],
        "w180_1": first,
        "w180_2": second,
        "crossing_1": inner,
        "crossing_2": outer,
        "k_low": -1.0 / outer,
        "k_high": -1.0 / inner,
        **{f"solutions_{ms}": float(len(design(PLANT, ms).solutions)) for ms in (2.0, 1.4)},
    }
    for name, (ms, place) in SOLUTIONS.items():
        found = design(PLANT, ms).solutions[place]
        values |= {f"k_{name}": found.k, f"ki_{name}": found.ki, f"w0_{name}": found.frequency}
        values[f"b_{name}"] = weight(PLANT, ms, rule, place)
    return values


@example_6.reading("as-written", "As written", note="$b$ by (25) at the peak of $|L/(1+L)|$, as (24) says.")
def as_written() -> pd.DataFrame:
    """Compute the limits and the solutions."""
    return example_6.frame(_values("w_mp"))


@example_6.reading(
    "authors",
    "$b$ at $\\omega_0$; a crossing from the rounded limit",
    note="Equation (25) at $\\omega_0$; the farther crossing as the inverse of the limit as it is printed.",
    tried={"frequency for $b$": 2, "the farther crossing": 2},
)
def authors() -> pd.DataFrame:
    """Compute the example as the numbers were made."""
    k_low = paper.printed_numbers("I-example-6")["k_low", "value"]
    return example_6.frame({**_values("w_0"), "crossing_2": -1.0 / k_low})
