r"""What is certain of set-point weights and filters whose controllers round to printed ones: where they are not.

With the excess Q at the peak of :math:`|T|` (`replicate.loops.bounds.resonance_boxes`), (13) and (16) are

.. math::

    b = \sqrt{Q} / T_i, \qquad T_{sp} = \sqrt{-Q / (1 + w_{mp}^2 Q)}, \qquad
    \text{so that} \quad -Q = T_{sp}^2 / (1 + w_{mp}^2 T_{sp}^2) .

Where the peak is at rest there is no filter, and b is at its limit (15), which is never below one half.
"""

from __future__ import annotations

from typing import Literal

from replicate.exhibits.exclusion import Box, Ends, Rule
from replicate.loops.bounds.intervals import Interval, exactly
from replicate.loops.bounds.resonance_boxes import Excludes, ResonanceBox
from replicate.papers.panagopoulos.certain import side
from replicate.papers.panagopoulos.part_2.processes import PLANTS, split
from replicate.papers.panagopoulos.part_2.setpoint import COARSE_GRID

Filter = Literal["as printed", "corrected", "coarse grid"]

_ONE = exactly(1.0)
_LEAST_LIMIT = 0.5  # of (15): (1 + sqrt(1 - 4 r))/2 or sqrt(r) for the ratio r = Td/Ti below or above 1/4


def resonances(row: str, box: Box) -> ResonanceBox:
    """Return a box that holds the controllers; where Td is lost, b of (15) gives it back."""
    integral = side(box, "Ti")
    derivative = side(box, "Td") if "Td" in box else side(box, "b").square() * integral
    return ResonanceBox(PLANTS[split(row)[0]], side(box, "k"), integral, derivative)


def rules(filter_: Filter) -> dict[str, Rule]:
    """Return the rules for b and Tsp, for one of the ways to compute the filter."""

    def weight(row: str, box: Box, ends: Ends) -> bool:
        if not 0.0 < ends[0] <= ends[1] < _LEAST_LIMIT:
            return False
        found = resonances(row, box)
        wanted = (Interval(*ends) * found.integral).square()
        return found.no_resonance_where(lambda _, excess: not excess.meets(wanted.low, wanted.high))

    def time(row: str, box: Box, ends: Ends) -> bool:
        if ends[0] <= 0.0:
            return False
        found, excludes = resonances(row, box), _other_filter(Interval(*ends), over_square=filter_ == "as printed")
        if filter_ == "coarse grid":
            return found.none_largest_where(excludes, COARSE_GRID)
        return found.no_resonance_where(excludes)

    return {"b": weight, "Tsp": time}


def _other_filter(time: Interval, *, over_square: bool) -> Excludes:
    """Say of frequency and excess that they give another filter time than one of some; (16) as printed or corrected."""

    def excludes(w: Interval, excess: Interval) -> bool:
        size = (time * w if over_square else time).square()
        wanted = -(size / (_ONE + w.square() * size))
        return not excess.meets(wanted.low, wanted.high)

    return excludes
