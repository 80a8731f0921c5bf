"""The settling time of a load response, in the two ways that matter here.

The text speaks of "the settling time at load disturbances" and defines neither a band nor its sides. The printed
numbers come closest to the last time at which the response to a unit load is *above* +5 %: what happens below zero does
not count, and the time counts from the moment at which the load is felt, not from the load itself.
"""

from __future__ import annotations

from replicate.loops import Signal

BAND = 0.05


def two_sided(response: Signal, band: float = BAND) -> float:
    """Return the last time at which a response that ends at zero is outside a band, dead time included."""
    return response.settling_time(band=band)


def one_sided(response: Signal, dead_time: float = 0.0, level: float = BAND) -> float:
    """Return the last time at which a response that ends at zero is above a level, from the end of the dead time."""
    return since_dead_time(response.last_crossing(level), dead_time)


def since_dead_time(last: float, dead_time: float) -> float:
    """Return the last time above a level, from the end of the dead time; 0 where the response never was above."""
    return last - dead_time if last else 0.0
