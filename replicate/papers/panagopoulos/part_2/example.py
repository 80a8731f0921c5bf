"""The example of section 1 of the supplement: two controllers for 1/(s+1)^4, and where the vertex loci mislead."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import minimize_scalar

from replicate.exhibits.exclusion import Box
from replicate.loops import PID, Loop, Plant
from replicate.loops.bounds.gain_boxes import GainBox
from replicate.papers.panagopoulos import certain, paper
from replicate.papers.panagopoulos.part_2 import feasible
from replicate.papers.panagopoulos.part_2.example_controllers import CONTROLLERS, pole_numbers
from replicate.papers.panagopoulos.part_2.processes import G4

if TYPE_CHECKING:
    import pandas as pd

ROW_LABELS = {key: f"$k_d = {key[3:]}$" for key in ("kd=1", "kd=2", "kd=3", "kd=4")}


example = paper.table(
    "IIs-example",
    "Two controllers for four equal lags",
    kind="example",
    rows=tuple(CONTROLLERS),
    columns=("k", "ki", "kd", "IAE", "p", "zeta1", "omega1", "zeta2", "omega2"),
    caption=r"$G = 1/(s+1)^4$ with $(k, k_i, k_d) = (1.00, 0.50, 1.00)$ and $(1.00, 0.98, 3.00)$: integrated absolute "
    "error after a unit load step, the real closed-loop pole, and relative damping and frequency of the two pairs.",
    shared_labels=ROW_LABELS,
    labels={
        "k": "$k$",
        "ki": "$k_i$",
        "kd": "$k_d$",
        "p": "real pole",
        "zeta1": r"$\zeta_1$",
        "omega1": r"$\omega_1$",
        "zeta2": r"$\zeta_2$",
        "omega2": r"$\omega_2$",
    },
)
example.trials = lambda: {row: (G4.notation(), controller.notation()) for row, controller in CONTROLLERS.items()}


def _loops(_: str, box: Box) -> tuple[Plant, GainBox]:
    return G4, GainBox(certain.side(box, "k"), certain.side(box, "ki"), certain.side(box, "kd"))


@example.reading(
    "as-written",
    "Exact, with the printed gains",
    "The error over the whole response, the poles as roots. The gains are read off Figure 3.",
    inputs=("k", "ki", "kd"),
    rules_out=certain.rules(_loops, "IAE"),
)
def numbers(_: str, given: Mapping[str, float]) -> dict[str, float]:
    """Return error and poles for printed gains."""
    controller = PID(given["k"], given["ki"], given["kd"])
    return {"IAE": Loop(G4, controller).load_step().iae()} | pole_numbers(controller)


def bottom_maximum(kd: float) -> float:
    """Return the largest ki on the locus of the bottom vertices, the first maximum over frequency."""
    w = np.geomspace(0.05, 4.0, 4000)
    _, ki = feasible.vertices("B", w, kd)
    i = int(np.nonzero((ki[1:-1] >= ki[:-2]) & (ki[1:-1] >= ki[2:]))[0][0]) + 1
    found = minimize_scalar(
        lambda x: -float(feasible.vertices("B", np.array([x]), kd)[1][0]),
        bounds=(w[i - 1], w[i + 1]),
        method="bounded",
        options={"xatol": 1e-12},
    )
    return -float(found.fun)


envelope = paper.table(
    "IIs-envelope",
    "The vertex loci and the true region",
    printed=False,
    rows=("kd=1", "kd=2", "kd=3", "kd=4"),
    columns=("ki", "k", "touches", "vertices", "k_example", "ki_example", "Ms"),
    caption="For each $k_d$: the largest feasible $k_i$ and its $k$, at how many frequencies the Nyquist curve "
    "touches the circle there (one: smooth; two: an edge), the largest $k_i$ on the locus of the bottom vertices; and "
    "the supplement's own choice with its true $M_s$ (1.4 is asked for). No number: no controller with this $k_d$ "
    "satisfies the constraint.",
    shared_labels=ROW_LABELS,
    labels={
        "ki": "largest $k_i$",
        "k": "at $k$",
        "vertices": "vertex locus",
        "k_example": "chosen $k$",
        "ki_example": "chosen $k_i$",
        "Ms": "its $M_s$",
    },
)


envelope.computed_trial = lambda row, numbers: (
    G4.notation(),
    PID(numbers["k"], numbers["ki"], float(row.removeprefix("kd="))).notation(),
)


@envelope.reading("as-written", "Exact")
def envelopes() -> pd.DataFrame:
    """Compare the true largest ki with what the vertices suggest."""
    rows = {}
    for key in envelope.rows:
        kd = float(key[3:])
        found = feasible.best(kd)
        row = {"vertices": bottom_maximum(kd)}
        if found is not None:
            row |= {"ki": found.ki, "k": found.k, "touches": float(len(found.frequencies))}
        if key in CONTROLLERS:
            controller = CONTROLLERS[key]
            row |= {
                "k_example": controller.k,
                "ki_example": controller.ki,
                "Ms": float(Loop(G4, controller).sensitivity_peak()),
            }
        rows[key] = row
    return envelope.frame(rows)
