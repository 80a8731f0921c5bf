"""The checkable sentences about Tables 1 and 2 and the cubic (11), section 2."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.exhibits.matching import meets
from replicate.loops import Loop
from replicate.papers.ali import paper
from replicate.papers.ali.claims import TABLE_1, WORST, claims, true_peak
from replicate.papers.ali.eq_11 import ROWS, printed_coefficients, printed_integral_times
from replicate.papers.ali.sensitivities import designed, exact_peak
from replicate.papers.ali.stability import DESIGNS, robustness
from replicate.papers.ali.structures import plant, series
from replicate.papers.ali.table_1 import table_1
from replicate.papers.ali.table_2 import table_2
from replicate.papers.ali.tuning import (
    INCREMENT,
    cubic,
    integral_time,
    specified_sensitivity,
)


@claims.claim(
    "true-ms",
    "The printed $M_s$ is the true maximum sensitivity of the controller (2) with the obtained settings.",
    where="section 2, Tables 1 and 2",
)
def true_ms() -> Finding:
    deviations, equal = [], 0
    for table in (table_1, table_2):
        texts = paper.printed_cells(table.id)
        for row in table.rows:
            peak = true_peak(table.id, Fraction(row))
            deviations.append(float(texts[row, "Ms"]) / peak - 1.0)
            equal += meets(texts[row, "Ms"], peak)
    return Finding(
        "holds" if equal == len(deviations) else "fails",
        max(deviations),
        f"{equal} of {len(deviations)} agree; the print is {100.0 * min(deviations):.1f} % to "
        f"{100.0 * max(deviations):.1f} % too high, so that the loops are more robust than printed. All agree if the "
        "derivative filter acts on the derivative term alone, the dead time is a third-order Padé model, and the peak "
        "comes from a norm routine with a tolerance of 1 %.",
    )


@claims.claim("ms-grows", "$M_s$ increases with $\\theta/T$.", where="section 2, below Table 1")
def ms_grows() -> Finding:
    peaks = [true_peak("table-1", x) for x in TABLE_1]
    steps = [later / earlier for earlier, later in pairwise(peaks)]
    return Finding(
        "holds" if min(steps) > 1.0 else "fails",
        min(steps),
        f"From {number(peaks[0])} to {number(peaks[-1])} with (2); each row is at least {number(min(steps))} "
        "times the one before.",
    )


@claims.claim(
    "ms-drastic",
    "For $\\theta/T > 0.5$, $M_s$ increases drastically and the step response becomes quite oscillatory.",
    where="section 2, below Table 1",
)
def ms_drastic() -> Finding:
    def damping(x: Fraction) -> float:
        """Return the damping ratio of the rightmost poles."""
        pole = Loop(plant(float(x)), series(designed("table-1", str(float(x))))).rightmost_pole()
        return -pole.real / abs(pole)

    middle = Fraction(1, 2)
    growth = {x + INCREMENT: true_peak("table-1", x + INCREMENT) / true_peak("table-1", x) for x in TABLE_1[:-1]}
    below = max(ratio for x, ratio in growth.items() if x <= middle)
    return Finding(
        "holds" if growth[WORST] > below and damping(WORST) < damping(middle) else "fails",
        growth[WORST],
        f"Up to 0.5 a row has at most {number(below)} times the $M_s$ of the one before, at 0.9 "
        f"{number(growth[WORST])} times, and the damping ratio of the dominant poles falls from "
        f"{number(damping(middle))} at 0.5 to {number(damping(WORST))} at 0.9. "
        "The growth is gradual: nothing special happens at 0.5.",
    )


@claims.claim(
    "reduced-gain",
    "The reduced gain of Table 2 lowers $M_s$ for $\\theta/T > 0.5$.",
    where="section 2, Table 2",
)
def reduced_gain() -> Finding:
    both = [Fraction(row) for row in table_2.rows if Fraction(row) in TABLE_1]
    ratios = [true_peak("table-2", x) / true_peak("table-1", x) for x in both]
    before, after = (robustness(WORST, designed(table, "0.9"), series) for table in ("table-1", "table-2"))
    return Finding(
        "holds" if max(ratios) < 1.0 else "fails",
        max(ratios),
        f"By a factor of {number(min(ratios))} to {number(max(ratios))}. At 0.9 the gain may rise by "
        f"{number(after['gain_up'])} % instead of {number(before['gain_up'])} % before the loop is unstable.",
    )


@claims.claim("ti-from-table-1", "The $T_i$ of Table 2 are those of Table 1.", where="section 2, below Table 2")
def ti_from_table_1() -> Finding:
    missing = [row for row in table_2.rows if row not in table_1.rows]
    x = Fraction(missing[0])
    return Finding(
        "holds-partly" if missing else "holds",
        integral_time(x),
        f"For {len(table_2.rows) - len(missing)} of {len(table_2.rows)} rows. Row {', '.join(missing)} is "
        f"not in Table 1; its $T_i$ is what the same search gives there, with $KK_p = \\sqrt{{2T/\\theta}}$ "
        f"and $M_s^* = {float(specified_sensitivity(x))}$.",
    )


@claims.claim("cubic", "(11) governs the relationship between $T_i$ and $\\theta/T$.", where="section 2, (11)")
def cubic_claim() -> Finding:
    data = printed_integral_times()
    errors = {row: cubic(float(row), printed_coefficients()) / data[row] - 1.0 for row in ROWS}
    worst = max(errors, key=lambda row: abs(errors[row]))
    peaks = [
        exact_peak(float(x), series(settings)) / true_peak("table-1" if x <= Fraction(1, 2) else "table-2", x) - 1.0
        for id, (x, settings) in DESIGNS.items()
        if id.startswith("eq-11")
    ]
    return Finding(
        "holds-partly" if abs(errors[worst]) > 0.05 else "holds",
        errors[worst],
        f"Its coefficients are the least-squares fit to the ten printed $T_i$, but it is off by "
        f"{100.0 * errors[worst]:+.1f} % at $\\theta/T = {worst}$, where the tables have a step. This does "
        f"little harm: $M_s$ changes by {100.0 * min(peaks):+.1f} % to {100.0 * max(peaks):+.1f} %.",
    )
