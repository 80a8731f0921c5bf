"""Section IV: what the text says of Examples 4.1 and 4.2, and of the Padé approximation in them."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math

import numpy as np

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, number, share
from replicate.exhibits.extrema import smallest
from replicate.loops import PI, Loop, sweep
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.claims import PROCESSES, Source, ascending, claims, column, stable_rules
from replicate.papers.bayhan.processes import (
    EXAMPLE_41,
    EXAMPLE_42,
    RULES,
    Convention,
    competing_rules,
    controllers,
    specifications,
)
from replicate.papers.bayhan.readings import AUTHORS
from replicate.papers.bayhan.table_3 import ROWS as TABLE_3_ROWS
from replicate.papers.bayhan.toolchain import sampled_specifications


@claims.claim("no-overshoot", "The pole assignment gives no overshoot.", where="abstract, Tables 2 and 3, section V")
def no_overshoot() -> Finding:
    values = {process.title: column(process, "text", "overshoot")["PA"] for process in PROCESSES}
    worst = max(values.values())
    return Finding(
        "holds" if worst < 0.0005 else "fails",
        worst,
        f"With the exact dead time the overshoot is, as a fraction, {listed(values)}: too little to be visible.",
    )


@claims.claim(
    "others-overshoot",
    "In Example 4.1 all rules except PA and ZN overshoot considerably.",
    where="Example 4.1, text above Table 2",
    consequence="comparison",
)
def others_overshoot() -> Finding:
    text, authors = (column(EXAMPLE_41, which, "overshoot") for which in ("text", "authors"))
    others = [rule for rule in RULES if rule not in {"PA", "ZN"}]
    smallest = min(others, key=lambda rule: text[rule])
    small = {rule: text[rule] for rule in others if text[rule] < 0.05}
    printed = min(paper.printed_numbers("table-2")[rule, "overshoot"] for rule in others)
    return Finding(
        share([not small, printed >= 0.05]).verdict,
        text[smallest],
        f"{'True' if printed >= 0.05 else 'False'} of Table 2 as printed, where the smallest of these overshoots is "
        f"{number(printed)} (recomputed with its gains, $K_i = 1/T_i$: "
        f"{number(min(authors[rule] for rule in others))}), {'but false' if small else 'and true'} of the rules "
        f"themselves: with the gains of equation (3) these overshoot by less than 5 %: "
        f"{listed(ascending(small)) or 'none'}.",
    )


@claims.claim(
    "settles-third",
    "In Example 4.1 the pole assignment settles third, after IAE and ITAE.",
    where="Example 4.1, text above Table 2",
    consequence="comparison",
)
def settles_third() -> Finding:
    text, authors = (ascending(column(EXAMPLE_41, which, "settling_time")) for which in ("text", "authors"))
    rank = list(text).index("PA") + 1
    faster = {rule: text[rule] for rule in list(text)[: rank - 1]}
    cells = paper.printed_numbers("table-2")
    printed = ascending({rule: cells[rule, "settling_time"] for rule in RULES})
    good = [list(order)[:3] == ["IAE", "ITAE", "PA"] for order in (printed, text)]
    return Finding(
        share(good).verdict,
        rank,
        f"{'True' if good[0] else 'False'} of Table 2 as printed, whose order begins {', '.join(list(printed)[:4])} "
        f"(recomputed with its gains, $K_i = 1/T_i$: {', '.join(list(authors)[:4])}), "
        f"{'and true' if good[1] else 'but false'} of the rules themselves: with the gains of equation (3) PA "
        f"({number(text['PA'])}) is number {rank}, after {listed(faster)}.",
    )


@claims.claim(
    "slow-rise",
    "In Example 4.1 delay and rise time of the pole assignment are long.",
    where="Example 4.1, text above Table 2; section VI",
)
def slow_rise() -> Finding:
    delay, rise = (column(EXAMPLE_41, "text", name) for name in ("delay_time", "rise_time"))
    ranks = [sorted(column.values(), reverse=True).index(column["PA"]) + 1 for column in (delay, rise)]
    return Finding(
        "holds" if max(ranks) <= 2 else "fails",
        delay["PA"],
        f"Delay time {number(delay['PA'])} and rise time {number(rise['PA'])} are number {ranks[0]} and "
        f"{ranks[1]} from the top among {len(delay)} rules (equation (3), exact dead time).",
    )


@claims.claim(
    "near-optimal-tau-cl",
    "In Example 4.1 $\\tau_{cl} = 0.06$ gives the IMC rule near optimal results.",
    where="Example 4.1",
)
def near_optimal_tau_cl() -> Finding:
    def best(which: Source) -> tuple[float, float]:
        def controller(tau_cl: float) -> PI:
            kp = float(competing_rules()["IMC"].evaluate(**{**EXAMPLE_41.symbols, "tau_cl": tau_cl}).kp)
            return PI(k=kp, ki=kp / EXAMPLE_41.tau if which == "text" else 1.0 / EXAMPLE_41.tau)

        def time(tau_cl: float) -> float:
            method = specifications if which == "text" else sampled_specifications
            found = method(EXAMPLE_41, controller(tau_cl))["settling_time"]
            return math.inf if math.isnan(found) else found

        grid = np.linspace(0.01, 1.0, 100)
        if which == "text":
            times = sweep(EXAMPLE_41.plant, [controller(x) for x in grid], "settling_time")["settling_time"][0]
        else:
            times = np.array([time(x) for x in grid])
        return smallest(time, grid, np.nan_to_num(times, nan=math.inf))

    (text, fastest), (authors, _) = best("text"), best("authors")
    paper_time = column(EXAMPLE_41, "text", "settling_time")["IMC"]
    return Finding(
        share([paper_time <= 1.1 * fastest, abs(authors - 0.06) < 0.005]).verdict,
        text,
        f"For $\\tau_{{cl}}$ up to 1 the settling time is shortest at {number(text, 3)} by equation "
        f"(3) ({number(fastest)}, against {number(paper_time)} at 0.06), but at {number(authors, 2)} in the "
        "authors' computation, where $K_i = 1/T_i$ does not change with $\\tau_{cl}$. Their optimum, like "
        "their table, belongs to that gain.",
    )


@claims.claim(
    "imc-cancels",
    "The zero of the IMC controller cancels the pole of the process.",
    where="section I",
)
def imc_cancels() -> Finding:
    zeros: dict[Convention, float] = {}
    for convention in ("Kp/Ti", "1/Ti"):
        imc = controllers(EXAMPLE_41, convention)["IMC"]
        zeros[convention] = -imc.ki / imc.k
    pole = -1.0 / EXAMPLE_41.tau
    return Finding(
        "holds" if math.isclose(zeros["Kp/Ti"], pole) else "fails",
        zeros["Kp/Ti"],
        f"By equation (3) the zero is at {number(zeros['Kp/Ti'])}, on the pole at {number(pole)}. With "
        f"$K_i = 1/T_i$, as in the tables, it is at {number(zeros['1/Ti'])} and cancels nothing.",
    )


UNSTABLE = ("CC", "IMC", "IAESPC", "ITSE", "ITSESPC")  # as the text says


def _unstable(convention: Convention, variant: str) -> list[str]:
    found = controllers(EXAMPLE_42, convention, variant)
    return [rule for rule in RULES if not Loop(EXAMPLE_42.plant, found[rule]).is_stable()]


@claims.claim(
    "unstable-4-2",
    "In Example 4.2 CC, IMC, IAESPC, ITSE and ITSESPC are unstable, and only they.",
    where="Example 4.2",
)
def unstable_42() -> Finding:
    text, corrected, authors = (
        _unstable("Kp/Ti", "printed"),
        _unstable("Kp/Ti", "corrected"),
        _unstable("1/Ti", "authors"),
    )
    agree = len(set(text) & set(UNSTABLE))
    return Finding(
        "holds" if set(text) == set(UNSTABLE) else "holds-partly" if agree else "fails",
        agree,
        f"By equation (3) these are unstable: {', '.join(text)}; with the printing errors of Table 1 corrected, "
        f"{', '.join(corrected)}. With the gains used for the tables: {', '.join(authors)}. (The paper gives no "
        "$\\tau_{cl}$; that of Example 4.1 is used. By equation (3) the IMC loop is stable for every positive one.)",
    )


@claims.claim(
    "most-acceptable-4-2",
    "In Example 4.2 the pole assignment is the most acceptable of the stable rules if no overshoot is wanted.",
    where="Example 4.2, text below Table 3",
)
def most_acceptable() -> Finding:
    rows = {rule: stable_rules(EXAMPLE_42, "text")[rule] for rule in TABLE_3_ROWS}
    without = {rule: row["settling_time"] for rule, row in rows.items() if row["overshoot"] < 0.005}
    order = list(ascending(without))
    return Finding(
        "holds" if order[0] == "PA" else "fails",
        without["PA"],
        "Of the rules of Table 3 that overshoot by less than 0.5 % (equation (3), exact dead time) it "
        f"settles first: {listed(ascending(without))}.",
    )


@claims.claim(
    "pade-is-enough",
    "A second-order Padé approximation is accurate enough for most practical applications.",
    where="section II, below (7)",
)
def pade_is_enough() -> Finding:
    gaps: dict[str, float] = {}
    for label, process, rows in (("4.1", EXAMPLE_41, RULES), ("4.2", EXAMPLE_42, TABLE_3_ROWS)):
        found = controllers(process, AUTHORS.convention, AUTHORS.variant)
        for rule in rows:
            exactly, sampled = (
                specifications(process, found[rule]),
                sampled_specifications(process, found[rule]),
            )
            for name, value in exactly.items():
                if name != "overshoot":
                    gaps[f"{rule} {name.replace('_', ' ')} ({label})"] = abs(sampled[name] / value - 1.0)
    worst = max(gaps, key=lambda key: gaps[key])
    own = max(gap for key, gap in gaps.items() if key.startswith("PA "))
    return Finding(
        "holds-partly",
        gaps[worst],
        f"For the pole assignment the times from the Padé model and the grid are within {own:.2%} of the "
        "exact ones. Over both tables, with the same gains, half of the times are within "
        f"{float(np.median(list(gaps.values()))):.2%}, but the largest difference is {gaps[worst]:.1%} "
        f"({worst}): a ripple that just reaches the 2 % band decides when the loop has settled.",
    )
