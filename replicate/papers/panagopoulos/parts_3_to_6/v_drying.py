"""V, section 4: the steam pressure control of a drying section."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.setpoint import COARSE_GRID
from replicate.papers.panagopoulos.parts_3_to_6.industrial import (
    DRYING,
    DRYING_PI,
    FILTER,
    beside_the_peak,
    coarse_grid_peak,
    drying_design,
    drying_pid,
    frequency_for_filter,
    setpoint_filters,
    settings,
)

if TYPE_CHECKING:
    import pandas as pd

drying = paper.table(
    "V-drying",
    "Drying section: the PID design for $M_s = 1.4$ and its set-point filter",
    kind="example",
    rows=(
        "K", "Ti", "Td", "ki", "Tf", "ts_PI", "ts_PID", "ISE_PI", "ISE_PID", "Ms", "Ms_PI", "Mp", "omega_mp",
        "ts_PI_model", "ts_PID_model", "overshoot_PI", "overshoot_PID", "overshoot_unfiltered", "IE_PI", "IE_PID",
        "IAE_PI", "IAE_PID", "ISE_load_PI", "ISE_load_PID",
    ),
    columns=("value",),
    labels={
        "K": "$K$",
        "Ti": "$T_i$ (s)",
        "Td": "$T_d$ (s)",
        "ki": "$k_i = K/T_i$",
        "Tf": "$T_f$ (s)",
        "ts_PI": "measured $t_s$, PI (s)",
        "ts_PID": "measured $t_s$, PID (s)",
        "ISE_PI": "measured ISE, PI",
        "ISE_PID": "measured ISE, PID",
        "Ms": "$M_s$ of the printed PID",
        "Ms_PI": "$M_s$ of the old PI",
        "Mp": "$M_p$ of the printed PID",
        "omega_mp": "$\\omega_{mp}$",
        "ts_PI_model": "$t_s$ of the model, PI (s)",
        "ts_PID_model": "$t_s$ of the model, PID with filter (s)",
        "overshoot_PI": "overshoot of the model, PI",
        "overshoot_PID": "overshoot of the model, PID with filter",
        "overshoot_unfiltered": "overshoot of the model, PID without filter",
        "IE_PI": "IE of a load step, PI",
        "IE_PID": "IE of a load step, PID",
        "IAE_PI": "IAE of a load step, PI",
        "IAE_PID": "IAE of a load step, PID",
        "ISE_load_PI": "ISE of a load step, PI",
        "ISE_load_PID": "ISE of a load step, PID",
    },
    caption="$P_2(s)e^{-2s} = 0.008\\,(30s+1)/(s(5s+1))\\,e^{-2s}$. $K$, $T_i$, $T_d$ and $k_i$ are the "
    "optimum; the rest evaluates the printed settings on the model.",
)  # fmt: skip
drying.trials = lambda: {
    ("K", name): (DRYING.notation(), controller.notation())
    for name, controller in (("PID", replace(drying_pid(), c=0.0)), ("PI", DRYING_PI))
}


@cache
def evaluation() -> dict[str, float]:
    """Evaluate the printed settings on the model."""
    new, plain, old = (Loop(DRYING, c) for c in (drying_pid(), drying_pid(0.0), DRYING_PI))
    peak = new.complementary_peak()
    steps = {"PI": old.step(), "PID": new.step()}
    loads = {"PI": old.load_step(), "PID": new.load_step()}
    return {
        "ts_PI": math.nan,
        "ts_PID": math.nan,
        "ISE_PI": math.nan,
        "ISE_PID": math.nan,
        "Ms": new.sensitivity_peak().value,
        "Ms_PI": old.sensitivity_peak().value,
        "Mp": peak.value,
        "omega_mp": peak.frequency,
        **{f"ts_{name}_model": step.settling_time(0.02) for name, step in steps.items()},
        **{f"overshoot_{name}": step.overshoot() for name, step in steps.items()},
        "overshoot_unfiltered": plain.step().overshoot(),
        **{f"IE_{name}": load.ie() for name, load in loads.items()},
        **{f"IAE_{name}": load.iae() for name, load in loads.items()},
        **{f"ISE_load_{name}": load.ise() for name, load in loads.items()},
    }


def _frame(setpoint_filter: float) -> pd.DataFrame:
    values = {**settings(drying_design()), "Tf": setpoint_filter, **evaluation()}
    return drying.frame(values)


@drying.reading(
    "as-written",
    "The method, and its filter formula as printed",
    note="The plant integrates, so the supplement to paper II omits the curvature constraint. Its formula for "
    "the filter with $b = 1$ has a wrong sign in our copy, which makes the filter zero here.",
)
def as_written() -> pd.DataFrame:
    """Design, and evaluate the filter formula as printed."""
    return _frame(setpoint_filters().printed_formula)


@drying.reading(
    "filter-corrected",
    "The filter formula put right",
    note="$T_{sp} = \\sqrt{(k_i^2 + k^2\\omega_{mp}^2)M_p^2 - A}\\,/(\\omega_{mp}\\sqrt A)$ follows from the "
    "condition that the formula is to satisfy, $|F_{sp}G_{sp}| = 1$ at $\\omega_{mp}$.",
)
def corrected() -> pd.DataFrame:
    """Design, and evaluate the filter from its defining condition."""
    return _frame(setpoint_filters().corrected)


@drying.reading(
    "filter-coarse-grid",
    "The same, with the peak of $|T|$ read off 50 frequencies",
    note="$M_p$ is the largest of the 50 values on `logspace(-2,2)`, the reading that also explains filters of paper "
    "II. The grid has only a dozen points in each decade, and the peak is flat: the largest value is nearly $M_p$, but "
    "its frequency is well beside $\\omega_{mp}$.",
    tried={"formula of the filter": 6},  # as the next table lists them
)
def coarse_grid() -> pd.DataFrame:
    """Design, and evaluate the mended formula at the peak on the coarse grid."""
    return _frame(setpoint_filters().coarse_grid)


filters = paper.table(
    "V-drying-filter",
    "Drying section: what the filter time constant could be",
    printed=False,
    rows=("printed_formula", "corrected", "coarse_grid", "eq_16", "eq_16_mended", "never_above_one"),
    columns=("printed_settings", "optimum"),
    labels={
        "printed_formula": "formula for $b = 1$, as printed",
        "corrected": "the same, mended",
        "coarse_grid": "corrected, peak read off 50 frequencies",
        "eq_16": "(16), for $b = 0$, as printed",
        "eq_16_mended": "(16) with $\\omega_{mp}$, not its square",
        "never_above_one": "$|G_{sp}| \\le 1$ at all frequencies",
        "printed_settings": "from printed settings",
        "optimum": "from the unrounded optimum",
    },
    units={"printed_settings": "s", "optimum": "s"},
    caption="The paper prints 5.32 s.",
)


@filters.reading("as-written", "All formulas")
def all_filters() -> pd.DataFrame:
    """Tabulate the candidates."""
    import pandas as pd

    best = drying_design()
    columns = {
        "printed_settings": setpoint_filters()._asdict(),
        "optimum": setpoint_filters((best.k, best.ki, best.kd))._asdict(),
    }
    return pd.DataFrame(columns, index=list(filters.rows), columns=list(filters.columns))


near_peak = paper.table(
    "V-drying-peak",
    "Drying section: where the peak was found",
    printed=False,
    rows=("below", "grid_peak", "needed", "exact", "above"),
    columns=("omega", "drop", "Tf"),
    labels={
        "below": "next grid point below",
        "grid_peak": "largest $|T|$ on the grid",
        "needed": "where $T_f$ is as printed",
        "exact": "true peak",
        "above": "next grid point above",
        "omega": "$\\omega$",
        "drop": "$1 - |T|/M_p$",
        "Tf": "$T_f$ (mended formula)",
    },
    units={"omega": "rad/s", "Tf": "s"},
    caption="The peak of $|T|$ is flat: a frequency well beside it has nearly the same height, but another $T_f$. The "
    "grid is `logspace(-2,2)`; the printed $T_f$ belongs to the point of it that is nearest to the peak, and to no "
    "other.",
)


@near_peak.reading("as-written", "Corrected formula at each frequency")
def peak_frequency() -> pd.DataFrame:
    """Evaluate the mended formula at the true peak, at the grid's points, and solve it for the frequency."""
    found = coarse_grid_peak()
    step = COARSE_GRID[1] / COARSE_GRID[0]
    frequencies = {
        "below": found.frequency / step,
        "grid_peak": found.frequency,
        "needed": frequency_for_filter(FILTER),
        "exact": evaluation()["omega_mp"],
        "above": found.frequency * step,
    }
    rows = {name: [w, *beside_the_peak(w)] for name, w in frequencies.items()}
    return near_peak.frame(rows)
