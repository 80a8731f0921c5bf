"""The checkable sentences about Example 2, section 3."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from dataclasses import replace

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number, share
from replicate.loops import Signal
from replicate.papers.ali.claims import claims
from replicate.papers.ali.comparisons import visioli
from replicate.papers.ali.examples import (
    EXAMPLE_1,
    EXAMPLE_2,
    example_1,
    example_2,
    load_response,
    loop,
    setpoint_response,
)
from replicate.papers.ali.pairs import KINDS, Pair, by_form, outputs, pairs

VISIOLI = {"series": "all in the form (2)", "ideal": "Visioli in the parallel form"}


@claims.claim(
    "same-speed", "Example 2: both methods give the same speed of response.", where="section 3, Example 2, Fig. 5"
)
def same_speed() -> Finding:
    half, rise = (pairs(visioli("setpoint"), measure) for measure in (Signal.delay_time, Signal.rise_time))
    ratio = rise["ideal"].proposed / rise["ideal"].competitor
    return Finding(
        "holds" if 0.8 < ratio < 1.25 else "holds-partly",
        ratio,
        "Only to the eye, because the dead time dominates: half the step is reached after "
        + by_form(half, VISIOLI, " and ")
        + ", dead time included; but the rise from 10 % to 90 % takes "
        + " and ".join(f"{p}" for p in rise.values())
        + ".",
    )


@claims.claim(
    "less-overshoot", "Example 2: the proposed method has less overshoot.", where="section 3, Example 2, Fig. 5"
)
def less_overshoot() -> Finding:
    found = pairs(visioli("setpoint"), lambda y: 100.0 * y.overshoot())
    return Finding(
        "holds" if all(p.proposed < p.competitor for p in found.values()) else "fails",
        found["ideal"].competitor - found["ideal"].proposed,
        f"Overshoot in per cent: {by_form(found, VISIOLI)}.",
    )


@claims.claim(
    "slightly-longer-settling",
    "Example 2: the settling time of the proposed method is slightly longer.",
    where="section 3, Example 2, Fig. 5",
)
def slightly_longer_settling() -> Finding:
    found = pairs(visioli("setpoint"), Signal.settling_time)
    return Finding(
        share(p.proposed > p.competitor for p in found.values()).verdict,
        found["ideal"].proposed / found["ideal"].competitor,
        f"The structure decides the settling time of the set-point response: {by_form(found, VISIOLI)}. "
        "The sentence is evidence that Visioli's controller was simulated in the parallel form.",
    )


@claims.claim(
    "visioli-better-load",
    "Example 2: Visioli's method rejects the load better, but the proposed one rejects it as well.",
    where="section 3, Example 2, Fig. 6",
)
def visioli_better_load() -> Finding:
    proposed, competitor = outputs(visioli("load"), "ideal")
    better = competitor.iae() < proposed.iae() and competitor.peak().value < proposed.peak().value
    return Finding(
        "holds" if better else "fails",
        proposed.iae() / competitor.iae(),
        f"In the parallel form its IAE is {number(competitor.iae())} against {number(proposed.iae())} and "
        f"its peak {number(competitor.peak().value)} against {number(proposed.peak().value)}; both settle, "
        f"after {number(competitor.settling_time())} and {number(proposed.settling_time())}. In the form (2) "
        "the sentence is false, since Visioli's loop is unstable.",
    )


@claims.claim(
    "two-settings",
    "Example 2: Visioli needs two settings, the proposed method one.",
    where="section 3, Example 2",
)
def two_settings() -> Finding:
    proposed, own = outputs(visioli("load"), "ideal")
    _, other = outputs(replace(visioli("load"), competitor=example_2()["visioli-setpoint"]), "ideal")
    settings = example_2()
    return Finding(
        "holds" if settings["visioli-setpoint"] != settings["visioli-load"] else "fails",
        other.iae() / own.iae(),
        "Two are quoted. One would do, though: with Visioli's set-point setting the IAE of the load response is "
        f"{number(other.iae())}, below the {number(own.iae())} of the load setting and the {number(proposed.iae())} of "
        "the proposed one (parallel form).",
    )


@claims.claim(
    "visioli-control-oscillates",
    "Example 2: Visioli's control signals oscillate significantly before they reach their final value.",
    where="section 3, Example 2, Figs. 7 and 8",
)
def visioli_control_oscillates() -> Finding:
    settings = example_2()
    variation = {
        kind: Pair(
            response(EXAMPLE_2, "series", settings["proposed"]).control.total_variation(),
            response(EXAMPLE_2, "ideal", settings[f"visioli-{kind}"]).control.total_variation(),
        )
        for kind, response in (("setpoint", setpoint_response), ("load", load_response))
    }
    ratios = [p.competitor / p.proposed for p in variation.values()]
    return Finding(
        "holds" if min(ratios) > 2.0 else "fails",
        min(ratios),
        "Total variation of $u$ (Visioli in the parallel form): "
        + "; ".join(f"{p} ({KINDS[kind]})" for kind, p in variation.items())
        + ".",
    )


@claims.claim(
    "satisfactory",
    "The proposed method performs satisfactorily for both set point and load.",
    where="sections 1 and 3",
)
def satisfactory() -> Finding:
    found = {}
    for name, theta, settings in (("1", EXAMPLE_1, example_1()), ("2", EXAMPLE_2, example_2())):
        controlled = loop(theta, "series", settings["proposed"])
        overshoot = setpoint_response(theta, "series", settings["proposed"]).output.overshoot()
        found[name] = (100.0 * overshoot, controlled.sensitivity_peak().value, controlled.margins().gain)
    return Finding(
        "undecided",
        found["1"][0],
        "The paper does not say what is satisfactory. Both loops are stable and settle. "
        + " ".join(
            f"Example {name}: overshoot {over:.0f} %, $M_s$ {number(peak)}, and the gain may rise by "
            f"{100 * (gain - 1):.0f} %."
            for name, (over, peak, gain) in found.items()
        )
        + " A weighted or filtered set point, which the paper does not use, would be needed against the "
        "overshoot.",
    )
