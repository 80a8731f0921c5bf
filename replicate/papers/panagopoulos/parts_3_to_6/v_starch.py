"""V, section 3: the temperature control of a starch boiler."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Literal

from replicate.loops import PID, Loop, design_pi
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.industrial import (
    STARCH,
    STARCH_MS,
    STARCH_PI,
    STARCH_SETTINGS,
    on_both_limits,
    settings,
    shape,
    starch_design,
    starch_pid,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

MODEL_ROWS = (
    "Ms", "Ms_filtered", "curvature", "phase_slope", "Ms_PI", "IE_PI", "IE_PID", "IAE_PI", "IAE_PID", "overshoot_PI",
    "overshoot_PID",
)  # fmt: skip

starch = paper.table(
    "V-starch",
    "Starch boiler: the PID design for $M_s = 1.6$",
    kind="example",
    rows=("K", "Ti", "Td", "ki", "ISE_PI", "ISE_PID", *MODEL_ROWS),
    columns=("value",),
    labels={
        "K": "$K$",
        "Ti": "$T_i$ (s)",
        "Td": "$T_d$ (s)",
        "ki": "$k_i = K/T_i$",
        "ISE_PI": "measured ISE, PI",
        "ISE_PID": "measured ISE, PID",
        "Ms": "$M_s$ of the printed PID",
        "Ms_filtered": "$M_s$ of the printed PID, $N = 8$",
        "curvature": "largest curvature of the printed PID",
        "phase_slope": "largest phase slope of the printed PID",
        "Ms_PI": "$M_s$ of the old PI",
        "IE_PI": "IE of a load step, PI",
        "IE_PID": "IE of a load step, PID",
        "IAE_PI": "IAE of a load step, PI",
        "IAE_PID": "IAE of a load step, PID, $N = 8$",
        "overshoot_PI": "overshoot, PI",
        "overshoot_PID": "overshoot, PID, $N = 8$",
    },
    caption="$G(s) = 1.34\\,e^{-12.9s}/(43.3s+1)^2$. $K$, $T_i$, $T_d$ and $k_i$ are the optimum; below, the "
    "printed settings and the previous PI controller are evaluated on the model. A positive curvature or "
    "phase slope violates the constraint.",
)
starch.trials = lambda: {
    ("K", name): (STARCH.notation(), controller.notation())
    for name, controller in (("PID", replace(starch_pid(filtered=False), c=0.0)), ("PI", STARCH_PI))
}


@cache
def evaluation() -> dict[str, float]:
    """Evaluate the printed settings on the model."""
    gain, ti, td = STARCH_SETTINGS
    gains = (gain, gain / ti, gain * td)
    ideal, filtered, old = (Loop(STARCH, c) for c in (starch_pid(filtered=False), starch_pid(), STARCH_PI))
    loads = {name: loop.load_step() for name, loop in (("PI", old), ("PID", filtered))}
    return {
        "Ms": ideal.sensitivity_peak().value,
        "Ms_filtered": filtered.sensitivity_peak().value,
        "curvature": shape(gains, "curvature"),
        "phase_slope": shape(gains, "phase"),
        "Ms_PI": old.sensitivity_peak().value,
        "IE_PI": loads["PI"].ie(),
        "IE_PID": loads["PID"].ie(),
        "IAE_PI": loads["PI"].iae(),
        "IAE_PID": loads["PID"].iae(),
        "overshoot_PI": old.step().overshoot(),
        "overshoot_PID": filtered.step().overshoot(),
    }


@starch.reading(
    "as-written",
    "All constraints of the method",
    note="The paper refers to the PID design of paper II; for a process without integrator its supplement, "
    "(5), asks for the sensitivity circle, negative curvature and falling phase.",
)
def all_constraints() -> pd.DataFrame:
    """Design with circle, curvature and phase."""
    best = settings(starch_design(("curvature", "phase")))
    values = {**best, "ISE_PI": math.nan, "ISE_PID": math.nan, **evaluation()}
    return starch.frame(values)


OPTIMA: dict[str, tuple[Literal["curvature", "phase"], ...]] = {
    "full": ("curvature", "phase"),
    "no_curvature": ("phase",),
    "circle_only": (),
}

optima = paper.table(
    "V-starch-optima",
    "Starch boiler: the optimum by the constraints that are kept",
    printed=False,
    rows=(*OPTIMA, "pi"),
    columns=("K", "Ti", "Td", "ki"),
    labels={
        "full": "circle, curvature and phase",
        "no_curvature": "circle and phase",
        "circle_only": "circle alone",
        "pi": "PI, circle",
        "Ti": "$T_i$ (s)",
        "Td": "$T_d$ (s)",
        "ki": "$k_i$",
    },
    caption="The paper prints $K = 1.35$, $T_i = 40$, $T_d = 19$. No set of constraints has that optimum. Last row: "
    "the best PI controller with $M_s = 1.6$; the earlier one of the mill, found without a model, is close to it.",
)


def _trial(_row: str, numbers: Mapping[str, float]) -> tuple[str, str]:
    """Return the plant and the controller of a row."""
    return STARCH.notation(), PID(numbers["K"], numbers["ki"], numbers["K"] * numbers["Td"]).notation()


optima.computed_trial = _trial


@optima.reading("as-written", "Largest $k_i$")
def by_constraints() -> pd.DataFrame:
    """Design under each set of constraints."""
    rows = {name: list(settings(starch_design(constraints)).values()) for name, constraints in OPTIMA.items()}
    pi = design_pi(STARCH, ms=STARCH_MS)
    rows["pi"] = [pi.k, pi.k / pi.ki, 0.0, pi.ki]
    return optima.frame(rows)


GAINS = (1.2, 1.35, 1.5, 2.0, 2.4)

ridge = paper.table(
    "V-starch-ridge",
    "Starch boiler: controllers on both limits",
    printed=False,
    rows=(*(f"{gain:g}" for gain in GAINS), "optimum"),
    columns=("K", "Ti", "Td", "ki", "Ms"),
    labels={"Ti": "$T_i$ (s)", "Td": "$T_d$ (s)", "ki": "$k_i$", "Ms": "$M_s$"},
    caption="For each $K$ the controller with $M_s = 1.6$ whose phase is just level somewhere. $T_i$ and "
    "$T_d$ change little, and at the printed $K$ they round to the printed values; $k_i$ grows all the way to the "
    "optimum without curvature constraint.",
)


ridge.computed_trial = _trial


@ridge.reading("as-written", "Along the two limits")
def along_the_ridge() -> pd.DataFrame:
    """Follow the curve on which both constraints are active."""
    rows = {}
    for gain in GAINS:
        found = on_both_limits(gain)
        loop = Loop(STARCH, PID(gain, found["ki"], gain * found["Td"]))
        rows[f"{gain:g}"] = [gain, found["Ti"], found["Td"], found["ki"], loop.sensitivity_peak().value]
    best = settings(starch_design(("phase",)))
    rows["optimum"] = [best["K"], best["Ti"], best["Td"], best["ki"], STARCH_MS]
    return ridge.frame(rows)
