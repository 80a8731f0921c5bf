"""Section V: what the text says of the PT326 set, on the identified model."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import islice

import numpy as np

from replicate.exhibits import Finding
from replicate.exhibits.evidence import listed, number, share
from replicate.exhibits.extrema import smallest
from replicate.papers.bayhan.claims import ascending, claims
from replicate.papers.bayhan.processes import PT326, RULES, controllers, exact_step, specifications


@claims.claim(
    "pt326-a", "Among the values of $a$, 1.3 is a good choice for the PT326 set.", where="section V, Figure 4"
)
def pt326_a() -> Finding:
    def time(a: float) -> float:
        found = specifications(PT326, PT326.pole_assignment(a))
        return found["settling_time"] if found["overshoot"] < 0.0005 else math.inf

    best, shortest = smallest(time, np.linspace(0.4, 2.0, 81))
    own = specifications(PT326, PT326.pole_assignment())["settling_time"]
    return Finding(
        "holds" if own <= 1.1 * shortest else "fails",
        own,
        f"On the identified model the shortest settling time without overshoot is {number(shortest)}, "
        f"at $a$ = {number(best)}; $a = {PT326.a}$ settles in {number(own)}.",
    )


def _first(values: Mapping[str, float], count: int) -> dict[str, float]:
    return dict(islice(values.items(), count))


@claims.claim(
    "pt326-ranking",
    "On the PT326 set the pole assignment settles best, together with ITAESPC and IMC.",
    where="section V, Figure 5",
)
def pt326_ranking() -> Finding:
    orders = {}
    for convention in ("Kp/Ti", "1/Ti"):
        found = controllers(PT326, convention)
        times = {
            rule: specifications(PT326, found[rule])["settling_time"]
            for rule in RULES
            if exact_step(PT326, found[rule].k, found[rule].ki) is not None
        }
        orders[convention] = ascending(times)
    first = [list(order)[:3] for order in orders.values()]
    good = [set(names) == {"PA", "ITAESPC", "IMC"} for names in first]
    text, other = orders.values()
    return Finding(
        share(good).verdict,
        text["PA"],
        f"On the identified model, by equation (3), the order is {listed(_first(text, 4))}; with $K_i = 1/T_i$ it "
        f"is {listed(_first(other, 4))}.",
    )
