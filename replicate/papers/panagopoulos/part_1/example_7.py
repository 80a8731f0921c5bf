"""Example 7: an unstable plant."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

from scipy.optimize import brentq

from replicate.loops import Circle
from replicate.loops.design.pi_tangency import smooth_gains
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import WeightRule, complementary_peak, design, weight
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    import pandas as pd

MS = 2.0
PARAMETERS = (4, 8)
_SYMBOLS = {"k": "k", "ki": "k_i", "b": "b", "w0": "\\omega_0", "Mp": "M_p"}

example_7 = paper.table(
    "I-example-7",
    "An unstable plant, $G_{14}$",
    kind="example",
    rows=(
        "a_min",
        *(f"{symbol}_a{a}" for a in PARAMETERS for symbol in _SYMBOLS),
        *(f"{symbol}_a{a}" for a in PARAMETERS for symbol in ("lag", "w_lag")),
        "k_a8_printed_w0",
        "ki_a8_printed_w0",
    ),
    columns=("value",),
    caption="The smallest $a$ for which the circle of $M_s = 2$ can be avoided, the designs for $a = 4$ and "
    "8, and the smallest phase lag (degrees) of the plant with its frequency, where the phase is stationary.",
    labels={
        "a_min": "smallest $a$",
        **{f"{key}_a{a}": f"${tex}$, $a = {a}$" for a in PARAMETERS for key, tex in _SYMBOLS.items()},
        **{f"lag_a{a}": f"smallest lag, $a = {a}$" for a in PARAMETERS},
        **{f"w_lag_a{a}": f"its $\\omega$, $a = {a}$" for a in PARAMETERS},
        "k_a8_printed_w0": "$k$ (17) at the printed $\\omega_0$, $a = 8$",
        "ki_a8_printed_w0": "$k_i$ (17) there",
        "value": "Value",
    },
)


def smallest_a(ms: float) -> float:
    """Return the smallest a for which the Nyquist curve can stay outside the circle of Ms."""
    circle = Circle.of(ms)
    return (circle.center + circle.radius) ** 2 / (circle.center**2 - circle.radius**2)


def smallest_lag(a: float) -> tuple[float, float]:
    """Return (lag in degrees, frequency) where the plant lags least: the root of the phase's slope."""
    plant = PLANTS[f"G14 a={a:g}"]

    def slope(w: float) -> float:  # d arg G / dw
        return float(complex(plant.log_derivative(1j * w)).real)

    w = float(brentq(slope, 1e-2, 1e2, xtol=1e-14))
    return -math.degrees(cmath.phase(complex(plant(1j * w)))), w


def _values(rule: WeightRule) -> pd.DataFrame:
    values = {"a_min": smallest_a(MS)}
    for a in PARAMETERS:
        plant = f"G14 a={a}"
        found = design(plant, MS)
        values |= {f"k_a{a}": found.k, f"ki_a{a}": found.ki, f"b_a{a}": weight(plant, MS, rule)}
        values |= {f"w0_a{a}": found.frequency, f"Mp_a{a}": complementary_peak(plant, MS).value}
        values[f"lag_a{a}"], values[f"w_lag_a{a}"] = smallest_lag(a)
    at_printed = smooth_gains(PLANTS["G14 a=8"], Circle.of(MS), paper.printed_numbers("I-example-7")["w0_a8", "value"])
    return example_7.frame(values | dict(zip(example_7.rows[-2:], at_printed, strict=True)))


@example_7.reading("as-written", "As written", note="$b$ by (25) at the peak of $|L/(1+L)|$, as (24) says.")
def as_written() -> pd.DataFrame:
    """Compute the limit and the designs."""
    return _values("w_mp")


@example_7.reading("authors", "$b$ at $\\omega_0$", note="Equation (25) at $\\omega_0$, the peak of the sensitivity.")
def authors() -> pd.DataFrame:
    """Compute the example with the set-point weight's other frequency."""
    return _values("w_0")
