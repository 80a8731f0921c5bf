"""Table 1: margins of PI control by the SIMC rules, with the closed-loop time constant equal to the dead time."""

import numpy as np
import pandas as pd

from replicate.loops import PI, Loop, Plant
from skogestad2003 import paper

DEAD_TIME = 1.0  # all margins are those of the loop in units of its dead time
TIME_CONSTANT = 4.0  # any value up to 8 dead times cancels: L = exp(-s)/(2 s)

table_1 = paper.table(
    "table-1",
    r"Robustness margins with $\tau_c = \theta$",
    rows=("GM", "PM", "Ms", "Mt", "delay"),
    columns=("first-order", "integrating"),
    labels={
        "GM": "gain margin",
        "PM": "phase margin, degrees",
        "Ms": "sensitivity peak $M_s$",
        "Mt": "complementary peak $M_t$",
        "delay": r"delay margin, in $\theta$",
    },
)


def first_order(plant: Plant) -> Loop:
    """Close the loop around a first-order process with Kc = tau/(2 k theta), tau_I = tau."""
    return Loop(plant, PI(k=TIME_CONSTANT / (2.0 * DEAD_TIME), ki=1.0 / (2.0 * DEAD_TIME)))


def integrating(plant: Plant) -> Loop:
    """Close the loop around an integrating process with Kc = 1/(2 k' theta), tau_I = 8 theta."""
    gain = 1.0 / (2.0 * DEAD_TIME)
    return Loop(plant, PI(k=gain, ki=gain / (8.0 * DEAD_TIME)))


def exact_loops() -> dict[str, Loop]:
    """Return both loops with the dead time exact."""
    return {
        "first-order": first_order(Plant.foptd(gain=1.0, time_constant=TIME_CONSTANT, dead_time=DEAD_TIME)),
        "integrating": integrating(Plant([1.0], [1.0, 0.0], dead_time=DEAD_TIME)),
    }


@table_1.reading("as-written", "the dead time exact")
def as_written() -> pd.DataFrame:
    """Compute the margins of both loops."""
    return _margins(exact_loops())


@table_1.reading(
    "pade-1",
    "first-order Padé approximation of the dead time",
    note="What a tool without dead times would have computed.",
)
def pade_1() -> pd.DataFrame:
    """Replace exp(-theta s) by (1 - s theta/2)/(1 + s theta/2)."""
    zeros, poles = [-DEAD_TIME / 2.0, 1.0], [DEAD_TIME / 2.0, 1.0]
    lag = np.polymul([TIME_CONSTANT, 1.0], poles)
    return _margins(
        {
            "first-order": first_order(Plant(zeros, lag)),
            "integrating": integrating(Plant(zeros, np.polymul([1.0, 0.0], poles))),
        }
    )


def _margins(loops: dict[str, Loop]) -> pd.DataFrame:
    columns = {}
    for name, loop in loops.items():
        margins = loop.margins()
        columns[name] = {
            "GM": margins.gain,
            "PM": margins.phase,
            "Ms": loop.sensitivity_peak().value,
            "Mt": loop.complementary_peak().value,
            "delay": margins.delay / DEAD_TIME,
        }
    return pd.DataFrame(columns)
