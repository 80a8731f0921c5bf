"""The checkable sentences about Example 1, section 3, and what both examples take from the design."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number, share
from replicate.loops import Signal
from replicate.papers.ali.claims import claims
from replicate.papers.ali.comparisons import padma_sree
from replicate.papers.ali.examples import (
    EXAMPLE_1,
    EXAMPLE_2,
    example_1,
    example_2,
    loop,
    setpoint_response,
)
from replicate.papers.ali.pairs import KINDS, Pair, by_form, pairs
from replicate.papers.ali.structures import NAMES, STRUCTURES

FORMS = {"series": "both in the form (2)", "ideal": "Padma Sree in the parallel form"}
ENOUGH = 60.0  # the largest peak comes in the first oscillations, long before


def _peak(structure: str, settings: str) -> float:
    """Return the peak of a set-point response of Example 1."""
    controlled = loop(EXAMPLE_1, structure, example_1()[settings])
    return controlled.respond(until=ENOUGH).output.peak().value


@claims.claim("ti-from-11", "The design takes $T_i$ from (11).", where="section 2, step 4; section 3")
def ti_from_11() -> Finding:
    found = {}
    for name, theta, settings in (("1", EXAMPLE_1, example_1()), ("2", EXAMPLE_2, example_2())):
        used, by_rule = (
            setpoint_response(theta, "series", settings[row]).output for row in ("proposed", "proposed-eq-11")
        )
        change = 100.0 * (by_rule.peak().value / used.peak().value - 1.0)
        found[name] = (settings["proposed"].Ti, settings["proposed-eq-11"].Ti, change)
    return Finding(
        "holds" if all(used == rule for used, rule, _ in found.values()) else "holds-partly",
        found["2"][1],
        "So does the summary of the rules; the examples take it from the tables, as the text says of Example 1: "
        + "; ".join(
            f"Example {name}, {used:g} where (11) gives {number(rule)} (the set-point peak would change by "
            f"{change:+.1f} %)"
            for name, (used, rule, change) in found.items()
        )
        + ".",
    )


@claims.claim(
    "larger-overshoot-setpoint",
    "Example 1: the overshoot of the proposed method is larger than Padma Sree's for the set point.",
    where="section 3, Example 1",
    consequence="comparison",
)
def larger_overshoot_setpoint() -> Finding:
    proposed = {structure: _peak(structure, "proposed") for structure in STRUCTURES}
    competitor = {structure: _peak(structure, "padma-sree") for structure in STRUCTURES}
    same = {s: Pair(proposed[s], competitor[s]) for s in STRUCTURES}
    mixed = [(a, b) for a in STRUCTURES for b in STRUCTURES if a != b and proposed[a] > competitor[b]]
    partners = " or ".join(sorted({NAMES[b] for _, b in mixed}))
    kept = share(pair.proposed > pair.competitor for pair in same.values())
    return Finding(
        "undecided" if mixed and not kept.kept else kept.verdict,
        same["series"].proposed - same["series"].competitor,
        "With both controllers in one form the peak of the proposed response is the smaller one: "
        + by_form(same, NAMES, ", ")
        + f". Of the {len(STRUCTURES) * (len(STRUCTURES) - 1)} combinations of two different structures, "
        f"{len(mixed)} would make the sentence true, with Padma Sree's controller in: {partners}. The paper "
        "does not say in which form it simulated that controller.",
    )


@claims.claim(
    "larger-overshoot-load",
    "Example 1: the overshoot of the proposed method is larger than Padma Sree's for the load.",
    where="section 3, Example 1",
)
def larger_overshoot_load() -> Finding:
    found = pairs(padma_sree("load"), lambda y: y.peak().value)
    return Finding(
        "holds" if all(p.proposed > p.competitor for p in found.values()) else "fails",
        found["series"].proposed - found["series"].competitor,
        f"Peak of the load response: {by_form(found, FORMS)}.",
    )


@claims.claim(
    "shorter-settling",
    "Example 1: the proposed method settles faster than Padma Sree's, for set point and load.",
    where="section 3, Example 1",
)
def shorter_settling() -> Finding:
    setpoint = pairs(padma_sree("setpoint"), Signal.settling_time)
    load = pairs(padma_sree("load"), Signal.settling_time)
    return Finding(
        "holds" if all(p.proposed < p.competitor for p in (*setpoint.values(), *load.values())) else "fails",
        setpoint["series"].competitor / setpoint["series"].proposed,
        "Settling to 2 %: "
        + "; ".join(
            f"{KINDS[kind]}, {p} ({FORMS[s]})"
            for kind, found in (("setpoint", setpoint), ("load", load))
            for s, p in found.items()
        )
        + ".",
    )


@claims.claim(
    "padma-sree-oscillates",
    "Example 1: Padma Sree's controller gives an oscillatory response.",
    where="section 3, Example 1",
)
def padma_sree_oscillates() -> Finding:
    settings = example_1()["padma-sree"]
    found = {}
    for structure in ("series", "d-filter", "ideal"):
        controlled = loop(EXAMPLE_1, structure, settings)
        pole = controlled.rightmost_pole()
        found[structure] = (-pole.real / abs(pole), controlled.sensitivity_peak().value)
    return Finding(
        "holds" if max(ratio for ratio, _ in found.values()) < 0.1 else "fails",
        found["series"][0],
        "Damping ratio of its dominant poles and $M_s$: "
        + "; ".join(f"{number(ratio)} and {number(peak)} ({NAMES[s]})" for s, (ratio, peak) in found.items())
        + ". The loop is close to instability in every structure.",
    )
