"""The coefficients of (7) against the rest of the paper: which decimal points of (7a) are in the wrong place."""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import TYPE_CHECKING

from replicate.papers.khan import paper
from replicate.papers.khan.processes import case_gains

if TYPE_CHECKING:
    import pandas as pd

# (7a): K_P = a p^2 h + b p + c/h, K_I = a p^2 + b p/h + c/h^2; (7b): a/h + b p + c sqrt(p/h), and K_I alike
ROWS = tuple(f"{case}_{gain}_{letter}" for case in ("7a", "7b") for gain in ("KP", "KI") for letter in "abc")
SHIFTS = (0.1, 1.0, 10.0)  # a decimal point one place off, or right
MEETING = 0.2  # ph at which the two cases meet

coefficients = paper.table(
    "rule-coefficients",
    "The coefficients of (7), as the rest of the paper implies them",
    kind="formula",
    rows=ROWS,
    columns=("value",),
    caption="(7a): $K_P = a\\,p^2h + b\\,p + c/h$, $K_I = a\\,p^2 + b\\,p/h + c/h^2$. (7b): $K_P = a/h + b\\,p + "
    "c\\sqrt{p/h}$, $K_I = a/h^2 + b\\,p/h + c\\sqrt{p/h^3}$.",
    labels={
        f"{case}_{gain}_{letter}": f"({case}), $K_{gain[1]}$: ${letter}$"
        for case in ("7a", "7b")
        for gain in ("KP", "KI")
        for letter in "abc"
    },
)
search = paper.table(
    "lost-zeros",
    "Where the decimal points of (7a) belong",
    printed=False,
    columns=("a", "b", "c", "jump"),
    caption="Every coefficient of (7a) with its decimal point as printed, one place to the left or one to the right, "
    "27 combinations for each gain: the three that jump least at $ph = 0.2$ against (7b), and the print. The best one "
    "of each gain makes the gain continuous to a few hundredths of a per cent.",
    labels={"jump": "jump at $ph = 0.2$ (%)"},
)


@cache
def _combinations(gain: str) -> tuple[tuple[float, tuple[float, ...]], ...]:
    """Return (jump in per cent, coefficients) of all combinations of shifts, the smallest jump first."""
    printed = paper.printed_cells("rule-coefficients")
    own = [float(printed[f"7a_{gain}_{letter}", "value"]) for letter in "abc"]
    target = case_gains("7b", MEETING, 1.0)[0 if gain == "KP" else 1]
    found = []
    for shifts in product(SHIFTS, repeat=3):
        a, b, c = (x * shift for x, shift in zip(own, shifts, strict=True))
        value = a * MEETING**2 + b * MEETING + c  # h = 1
        found.append((100.0 * (value / target - 1.0), (a, b, c)))
    return tuple(sorted(found, key=lambda item: abs(item[0])))


@coefficients.reading(
    "as-written",
    "As the rest of the paper implies",
    "A formula's coefficients cannot be recomputed from the formula. The rest of the paper provides the evidence. "
    "(7a): of all ways to shift decimal points by one place, the one that agrees with (7b) at $ph = 0.2$; it also "
    "gives the Table II row for $ph = 0.1$. (7b): one half of $K_{Popt}$ and 0.85 of $K_{Iopt}$ of the Appendix, case "
    "II.",
)
def implied() -> pd.DataFrame:
    """Take (7a) from continuity and (7b) from the Appendix."""
    values: list[float] = []
    for gain in ("KP", "KI"):
        values += [float(f"{x:.12g}") for x in _combinations(gain)[0][1]]
    for gain, factor in (("KP", 0.5), ("KI", 0.85)):
        values += [factor * x for x in _appendix(gain)]
    return coefficients.frame(dict(zip(ROWS, values, strict=True)))


def _appendix(gain: str) -> tuple[float, float, float]:
    """Return the three coefficients of the Appendix' case II, read off the rule itself at h = 1."""
    import numpy as np

    points = np.array([0.25, 1.0, 4.0])
    right = [case_gains("ISE-II", float(p), 1.0)[0 if gain == "KP" else 1] for p in points]
    a, b, c = np.linalg.solve(np.stack([np.ones(3), points, np.sqrt(points)], axis=1), right)
    return float(a), float(b), float(c)


@search.reading("as-written", "Smallest jumps")
def lost_zeros() -> pd.DataFrame:
    """List the best combinations and the print."""
    rows = {}
    for gain in ("KP", "KI"):
        found = _combinations(gain)
        for number, (jump, values) in enumerate(found[:3], 1):
            rows[f"{gain}, no. {number}"] = [*(float(f"{x:.12g}") for x in values), jump]
        printed = paper.printed_cells("rule-coefficients")
        own = tuple(float(printed[f"7a_{gain}_{letter}", "value"]) for letter in "abc")
        jump = next(jump for jump, values in found if max(abs(x - y) for x, y in zip(values, own, strict=True)) < 1e-12)
        rows[f"{gain}, printed"] = [*own, jump]
    return search.frame(rows)
