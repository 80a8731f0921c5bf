"""What both examples share: the controllers compared, their responses, and the numbers read from them."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING

from replicate.exhibits import AS_WRITTEN, Table
from replicate.loops import Loop, Response
from replicate.papers.ali import paper
from replicate.papers.ali.stability import summarised
from replicate.papers.ali.structures import (
    STRUCTURES,
    Settings,
    plant,
    printed_settings,
    series,
    trial,
)

if TYPE_CHECKING:
    import pandas as pd

DECAYED = 26.0  # time constants of the slowest mode, exp(-26) = 5e-12

EXAMPLE_1 = Fraction(7, 10)  # theta; T = K = 1
EXAMPLE_2 = Fraction(1, 5)

QUANTITIES = (
    "Kp", "Ti", "Td", "pole_re", "Ms", "y_max", "ts", "iae", "u0", "u_min", "tv",
    "load_max", "load_ts", "load_iae", "load_tv",
)  # fmt: skip

LABELS = {
    "proposed": "proposed",
    "proposed-eq-11": "$T_i$ by (11)",
    "padma-sree": "Padma Sree",
    "visioli-setpoint": "Visioli, s.p.",
    "visioli-load": "Visioli, load",
    "Kp": "$K_p$",
    "Ti": "$T_i$",
    "Td": "$T_d$",
    "pole_re": "Re $p$",
    "Ms": "$M_s$",
    "y_max": "set point: peak of $y$",
    "ts": "set point: settling time",
    "iae": "set point: IAE",
    "u0": "set point: $u(0^+)$",
    "u_min": "set point: min $u$",
    "tv": "set point: TV of $u$",
    "load_max": "load: peak of $y$",
    "load_ts": "load: settling time",
    "load_iae": "load: IAE",
    "load_tv": "load: TV of $u$",
}


def example_1() -> dict[str, Settings]:
    """Return the settings simulated in Example 1; the proposed ones are those printed in Table 2."""
    texts = paper.printed_cells("table-2")
    proposed = Settings(float(texts["0.7", "KKp"]), float(texts["0.7", "Ti"]), float(EXAMPLE_1 / 2))
    return {
        "proposed": proposed,
        "proposed-eq-11": summarised(EXAMPLE_1),
        "padma-sree": printed_settings("quoted-settings", "padma-sree"),
    }


def example_2() -> dict[str, Settings]:
    """Return the settings simulated in Example 2, all as printed."""
    return {
        "proposed": printed_settings("example-2", "proposed"),
        "proposed-eq-11": summarised(EXAMPLE_2),
        "visioli-setpoint": printed_settings("quoted-settings", "visioli-setpoint"),
        "visioli-load": printed_settings("quoted-settings", "visioli-load"),
    }


@cache
def loop(theta: Fraction, structure: str, settings: Settings) -> Loop:
    """Return the loop of one controller in one of `STRUCTURES`, dead time exact."""
    return Loop(plant(float(theta)), STRUCTURES[structure](settings))


def horizon(controlled: Loop) -> float:
    """Return the time after which what remains of a response is below 1e-11 of it.

    Shorter than the loop's own default, which waits for the rounding level: one competitor rings for thousands of time
    constants of the plant.
    """
    return DECAYED / abs(controlled.rightmost_pole().real) + 4.0 * controlled.plant.dead_time


@cache
def setpoint_response(theta: Fraction, structure: str, settings: Settings) -> Response:
    """Return output and control signal after a unit step of the set point, until every mode has died out."""
    controlled = loop(theta, structure, settings)
    return controlled.respond(until=horizon(controlled))


@cache
def load_response(theta: Fraction, structure: str, settings: Settings) -> Response:
    """Return output and control signal after a unit load step at the plant input, before the dead time."""
    controlled = loop(theta, structure, settings)
    return controlled.respond(setpoint=0.0, load=1.0, until=horizon(controlled))


def performance(theta: Fraction, structure: str, settings: Settings) -> dict[str, float]:
    """Return the numbers of one column but the settings; an unstable loop has its rightmost pole and nothing else."""
    found = dict.fromkeys(QUANTITIES[3:], math.nan)
    controlled = loop(theta, structure, settings)
    found["pole_re"] = controlled.rightmost_pole().real
    if not controlled.is_stable():
        return found
    setpoint = setpoint_response(theta, structure, settings)
    load = load_response(theta, structure, settings)
    return found | {
        "Ms": controlled.sensitivity_peak().value,
        "y_max": setpoint.output.peak().value,
        "ts": setpoint.output.settling_time(),
        "iae": setpoint.output.iae(),
        "u0": float(setpoint.control(0.0)),
        "u_min": setpoint.control.trough().value,
        "tv": setpoint.control.total_variation(),
        "load_max": load.output.peak().value,
        "load_ts": load.output.settling_time(),
        "load_iae": load.output.iae(),
        "load_tv": load.control.total_variation(),
    }


READINGS = {
    AS_WRITTEN: (
        "series",
        "All controllers in the printed form (2)",
        ("Every setting read as $K_p(1+1/sT_i)(1+sT_d)/(1+s\\alpha T_d)$ with $\\alpha = 0.1$, acting on the error."),
    ),
    "filter-on-d": (
        "d-filter",
        "Filter on D only, $K_p(1+1/sT_i)(1+sT_d/(1+s\\alpha T_d))$",
        "The structure with which the printed $M_s$ of the tables were computed.",
    ),
    "ideal": (
        "ideal",
        "Parallel form, $K_p(1+1/sT_i+sT_d/(1+s\\alpha T_d))$",
        "The form that the competing settings were most probably made for, all of it acting on the error.",
    ),
    "ideal-on-output": (
        "ideal-on-output",
        "Parallel form, derivative on the output",
        (
            "As *ideal*, but the derivative does not see the set point: the same loop and the same load "
            "response, without derivative kick."
        ),
    ),
}


def add_readings(table: Table, theta: Fraction, settings: dict[str, Settings], rules: dict[str, Settings]) -> None:
    """Register one reading per structure.

    Parameters
    ----------
    settings
        What is simulated, by column.
    rules
        Columns whose settings are compared with the print: what the paper's own rules give, unrounded. The others show
        the settings that are simulated.
    """
    for id, (structure, title, note) in READINGS.items():

        def compute(structure: str = structure) -> pd.DataFrame:
            import pandas as pd

            columns = {}
            for name, simulated in settings.items():
                shown = rules.get(name, simulated)
                found = performance(theta, structure, simulated)
                columns[name] = [shown.Kp, shown.Ti, shown.Td, *found.values()]
            return pd.DataFrame(columns, index=list(QUANTITIES))

        table.reading(id, title, note)(compute)
    # A controller is a column here: its link stands in the first row, that of the gains.
    table.trials = lambda: {
        (QUANTITIES[0], name): trial(float(theta), series(simulated)) for name, simulated in settings.items()
    }


CAPTION = (
    "Exact dead time, unit steps of the set point and of a load at the plant input (before the dead time); "
    "times count from the step; settling to 2 % of the step. $p$ is the rightmost pole, TV the total "
    "variation of the control signal with its jump at the step. An unstable loop has its pole and nothing "
    "else. "
)
