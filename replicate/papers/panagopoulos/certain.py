"""What is certain of the loops whose gains round to printed ones: where their printed quantities are not."""

from __future__ import annotations

from collections.abc import Callable

from replicate.exhibits.exclusion import Box, Ends, Rule
from replicate.loops import Plant
from replicate.loops.gain_boxes import GainBox, iae_bounds, no_peak_between
from replicate.loops.intervals import Interval, exactly

Loops = Callable[[str, Box], tuple[Plant, GainBox]]
"""From a case and a box of its printed inputs to the plant and a box that holds its controllers."""


def rules(loops: Loops, *quantities: str) -> dict[str, Rule]:
    """Return the rules for some of IE, w0, IE/IAE and IAE, the quick ones first."""

    def ie(case: str, box: Box, ends: Ends) -> bool:
        _, gains = loops(case, box)
        return not (exactly(1.0) / gains.ki).meets(*ends)

    def w0(case: str, box: Box, ends: Ends) -> bool:
        plant, gains = loops(case, box)
        return plant.dead_time == 0.0 and no_peak_between(plant, gains, *ends)

    def quotient(case: str, box: Box, ends: Ends) -> bool:
        plant, gains = loops(case, box)
        return not (exactly(1.0) / gains.ki / iae_bounds(plant, gains)).meets(*ends)

    def iae(case: str, box: Box, ends: Ends) -> bool:
        return not iae_bounds(*loops(case, box)).meets(*ends)

    known: dict[str, Rule] = {"IE": ie, "w0": w0, "IE/IAE": quotient, "IAE": iae}
    return {quantity: rule for quantity, rule in known.items() if quantity in quantities}


def side(box: Box, name: str) -> Interval:
    """Return the interval of an input."""
    return Interval(*box[name])
