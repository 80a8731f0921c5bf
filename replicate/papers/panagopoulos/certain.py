"""What is certain of the loops whose gains round to printed ones: where their printed quantities are not."""

from __future__ import annotations

from collections.abc import Callable

from replicate.exhibits.exclusion import Box, Ends, Rule
from replicate.loops import Loop, Plant
from replicate.loops.bounds.gain_boxes import GainBox, complementary_at_least, iae_bounds, no_peak_between
from replicate.loops.bounds.intervals import Interval, exactly
from replicate.loops.bounds.response_boxes import load_responses

Loops = Callable[[str, Box], tuple[Plant, GainBox]]
"""From a case and a box of its printed inputs to the plant and a box that holds its controllers."""


def rules(loops: Loops, *quantities: str) -> dict[str, Rule]:
    """Return the rules for some of IE, w0, Mp, IE/IAE and IAE, the quick ones first."""

    def ie(case: str, box: Box, ends: Ends) -> bool:
        _, gains = loops(case, box)
        return not (exactly(1.0) / gains.ki).meets(*ends)

    def w0(case: str, box: Box, ends: Ends) -> bool:
        plant, gains = loops(case, box)
        return no_peak_between(plant, gains, *ends)

    def quotient(case: str, box: Box, ends: Ends) -> bool:
        plant, gains = loops(case, box)
        return not (exactly(1.0) / gains.ki / iae_bounds(plant, gains)).meets(*ends)

    def iae(case: str, box: Box, ends: Ends) -> bool:
        return not iae_bounds(*loops(case, box)).meets(*ends)

    def mp(case: str, box: Box, ends: Ends) -> bool:
        plant, gains = loops(case, box)
        peak = Loop(plant, gains.middle).complementary_peak()
        return complementary_at_least(plant, gains, peak.frequency) > ends[1]

    known: dict[str, Rule] = {"IE": ie, "w0": w0, "Mp": mp, "IE/IAE": quotient, "IAE": iae}
    return {quantity: rule for quantity, rule in known.items() if quantity in quantities}


def settling(loops: Loops, level: float, *, one_sided: bool = False, from_dead_time: bool = False) -> dict[str, Rule]:
    """Return the rule for the settling time of a load response.

    Parameters
    ----------
    level
        Of the unit step: what the response stays below.
    one_sided
        Whether what happens below zero counts.
    from_dead_time
        Whether the time counts from the end of the dead time.
    """

    def ts(case: str, box: Box, ends: Ends) -> bool:
        plant, gains = loops(case, box)
        found, start = load_responses(plant, gains), plant.dead_time if from_dead_time else 0.0
        return found is not None and found.never_settles_between(
            ends[0] + start, ends[1] + start, level, one_sided=one_sided
        )

    return {"ts": ts}


def side(box: Box, name: str) -> Interval:
    """Return the interval of an input."""
    return Interval(*box[name])
