"""Paper IV: water level of a steam generator. The plant is not in the paper; what can be said without it is here."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.figures.curve_labels import label_curves
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.diagrams import Diagram
from replicate.papers.panagopoulos.parts_3_to_6.reference_model import characteristics, step

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

RATIOS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0)

NO_PLANT = (
    "The plant is not in the paper: the transfer functions from feedwater and steam flow to both water levels, "
    "and the simulation model, belong to a benchmark of Électricité de France that is not public."
)


@paper.figure(
    "IV-fig-1",
    "Controller with proportional feedback, feedforward and reference model",
    kind="diagram",
    caption="The PID controller sees the difference between level and reference model. The steam flow $Q_v$ is "
    "fed forward, and at low load the second level $N_{gl}$ is fed back with the gain $K_2$.",
    alt="Block diagram. The steam flow Qv enters the plant and the reference model; the model's output is "
    "compared with the level Nge and drives the PID controller, to whose output the feedforward is added and K2 "
    "times Ngl subtracted.",
    size=(6.6, 2.9),
)
def structure(fig: Figure) -> None:
    """Draw the structure as the text describes it."""
    diagram = Diagram(fig)
    diagram.arrow((-1.2, 1.6), (0, 1.6), label="$Q_v$", at=(-0.9, 1.85))
    diagram.dot((-0.4, 1.6))
    diagram.box((1.0, 1.6), "model", width=2.0)
    diagram.arrow((2.0, 1.6), (2.8, 1.6), (2.8, 0.2))
    diagram.sum((2.8, 0), {"top": "$+$", "bottom": "$-$"})
    diagram.arrow((3.0, 0), (3.8, 0))
    diagram.box((4.6, 0), "PID")
    diagram.arrow((5.4, 0), (6.4, 0))
    diagram.sum((6.6, 0), {"left": "$+$", "top": "$+$", "bottom": "$-$"})
    diagram.arrow((-0.4, 1.6), (-0.4, 2.7), (6.6, 2.7), (6.6, 0.2), label="feedforward", at=(4.4, 2.95))
    diagram.arrow((6.8, 0), (7.8, 0), label="$Q_e$", at=(7.3, 0.3))
    diagram.box((8.7, 0), "plant", width=1.8)
    diagram.arrow((8.7, 1.6), (8.7, 0.5), label="$Q_v$", at=(9.1, 1.4))
    diagram.arrow((9.6, 0.2), (11.4, 0.2), label="$N_{ge}$", at=(11.0, 0.5))
    diagram.dot((10.4, 0.2))
    diagram.arrow((9.6, -0.3), (10.0, -0.3), (10.0, -1.6), (8.2, -1.6), label="$N_{gl}$", at=(9.5, -1.3))
    diagram.box((7.5, -1.6), "$K_2$", width=1.4)
    diagram.arrow((6.8, -1.6), (6.6, -1.6), (6.6, -0.2))
    diagram.arrow((10.4, 0.2), (10.4, -2.5), (2.8, -2.5), (2.8, -0.2))
    diagram.frame(-1.4, 11.6, -2.8, 3.2)


model = paper.table(
    "IV-reference-model",
    "The reference model, as a function of $\\tau_g/\\tau_e$",
    kind="formula",
    printed=False,
    rows=tuple(f"{ratio:g}" for ratio in RATIOS),
    columns=("peak", "peak_time", "area", "settling_time"),
    labels={"peak_time": "at $t/\\tau_e$", "area": "area$/\\tau_e$", "settling_time": "below 0.02 from $t/\\tau_e$"},
    caption="Unit step response of $2\\tau_e s/((1+2\\tau_e s)(1+2\\tau_g s))$. Rows: $\\tau_g/\\tau_e$. The "
    "paper gives no values for the time constants.",
)


@model.reading("as-written", "Closed forms")
def reference_model() -> pd.DataFrame:
    """Evaluate the closed forms of the step response."""
    rows = {f"{ratio:g}": list(characteristics(ratio)) for ratio in RATIOS}
    return model.frame(rows)


@paper.figure(
    "IV-fig-2",
    "Step response of the reference model",
    caption="Unit step of the disturbance, in units of $\\tau_e$, for several ratios of the time constants.",
    alt="Four step responses that rise at once, peak within a few time constants and return to zero; the larger "
    "the ratio the lower and later the peak.",
    size=(6.4, 3.4),
    stands_for="The paper shows the water level at low load beside the model's output. Only the model can be "
    "drawn, and only up to its two time constants, which the paper does not state.",
)
def reference_step(fig: Figure) -> None:
    """Draw the reference model's step response."""
    axes = fig.subplots()
    t = np.linspace(0.0, 20.0, 601)
    for ratio in (0.25, 0.5, 1.0, 2.0):
        axes.plot(t, step(ratio, t), label=f"$\\tau_g/\\tau_e = {ratio:g}$")
    axes.set_xlim(0.0, 20.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("time $t/\\tau_e$")
    axes.set_ylabel("output of the model")
    if not label_curves(axes):
        axes.legend(loc="upper right")


for _id, _title in (
    ("IV-fig-3", "Root loci with respect to $K_2$ at two loads"),
    ("IV-fig-4", "Nyquist plots designed for $M_s = 1.6$ in three cases"),
    ("IV-fig-5", "Water level for a step at high load"),
    ("IV-fig-6", "Water level for a step at low load, without and with sensor fault"),
    ("IV-fig-7", "Water level for a ramp at high load"),
    ("IV-fig-8", "Water level for a step from 10 % to 5 % load"),
    ("IV-fig-9", "Water level for ramps at low load, without and with sensor fault"),
    ("IV-fig-10", "Water level for a step from 5 % to 10 % load"),
):
    paper.not_computable(_id, _title, NO_PLANT)

settings = paper.table(
    "IV-table-1",
    "PID parameters at different loads",
    rows=("K", "Ti", "Td", "K2", "ki", "Tr"),
    columns=("high_load", "low_load", "fault_high_load", "fault_low_load"),
    labels={
        "K": "$K$",
        "Ti": "$T_i$ (s)",
        "Td": "$T_d$ (s)",
        "K2": "$K_2$",
        "ki": "$k_i = K/T_i$",
        "Tr": "$T_r = T_i/2$ (s)",
        "high_load": "High load",
        "low_load": "Low load",
        "fault_high_load": "$N_{gl}$ fault, high load",
        "fault_low_load": "$N_{gl}$ fault, low load",
    },
    caption="The designs cannot be repeated without the plant. What the text says about the printed numbers can be "
    "evaluated: $T_d \\approx T_i/4$, and $k_i$ and $T_r$ (not printed). The interval [45, 80] of the last "
    "column of the paper stands here as two.",
)


@settings.reading(
    "as-written",
    "Relations of the text",
    note="$T_d = T_i/4$, $k_i = K/T_i$ and $T_r = T_i/2$ from the printed $K$ and $T_i$; the rest needs the plant.",
)
def relations() -> pd.DataFrame:
    """Evaluate the relations between printed numbers."""
    printed = paper.printed_numbers("IV-table-1")
    frame = settings.blank()
    for column in settings.columns:
        ti = printed["Ti", column]
        frame.loc["Td", column] = ti / 4.0
        frame.loc["Tr", column] = ti / 2.0
        if ("K", column) in printed:
            frame.loc["ki", column] = printed["K", column] / ti
    return frame


results = paper.table(
    "IV-table-2",
    "Achieved results for the different specifications",
    rows=("time_outside_5", "settling_time", "delay_margin", "delay_margin_recommended"),
    columns=("high_step", "high_ramp", "low_step", "low_ramp", "sat_up", "sat_down", "fault_step", "fault_ramp"),
    labels={
        "time_outside_5": "time with $|N_{ge}| > 5$ (s)",
        "settling_time": "settling time (s)",
        "delay_margin": "delay margin (s)",
        "delay_margin_recommended": "recommended delay margin (s)",
        "high_step": "High load, step",
        "high_ramp": "High load, ramp",
        "low_step": "Low load, step",
        "low_ramp": "Low load, ramp",
        "sat_up": "Saturation, up",
        "sat_down": "Saturation, down",
        "fault_step": "Fault, step",
        "fault_ramp": "Fault, ramp",
    },
    caption="The paper prints the recommended delay margins in parentheses, in the column beside the achieved one.",
)


@results.reading("as-written", "Not computable", note=NO_PLANT)
def evaluation() -> pd.DataFrame:
    """Return an empty table: nothing of it can be computed."""
    return results.blank()


text = paper.table(
    "IV-text",
    "Numbers in the text and in captions",
    rows=(
        "Ms", "K2_low", "K2_high", "sampling", "settling_recommended", "limit_text", "limit_table", "limit_strict",
        "load_high", "load_low", "load_very_low", "t_fault", "t_switch",
    ),
    columns=("value",),
    labels={
        "Ms": "design parameter $M_s$",
        "K2_low": "root loci: smallest $K_2$",
        "K2_high": "root loci: largest $K_2$",
        "sampling": "sampling period (s)",
        "settling_recommended": "recommended settling time (s), caption of Table 2",
        "limit_text": "limit on the level, section 4 (±)",
        "limit_table": "limit on the level, Table 2 (±)",
        "limit_strict": "strict limit on the level, Figure 5 (±)",
        "load_high": "high load (%)",
        "load_low": "low load (%)",
        "load_very_low": "saturation tests (%)",
        "t_fault": "sensor fault at (s)",
        "t_switch": "parameters of the plant switch at (s)",
    },
    caption="What the paper sets or was given. None of it is the result of a computation that could be repeated.",
)  # fmt: skip


@text.reading("as-written", "Not computable", note=NO_PLANT)
def text_numbers() -> pd.DataFrame:
    """Return an empty table: nothing of it can be computed."""
    return text.blank()
