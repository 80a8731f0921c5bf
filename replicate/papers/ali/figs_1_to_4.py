"""Figures 1 to 4: the responses of Example 1."""

from __future__ import annotations

from functools import partial

from replicate.papers.ali.comparisons import padma_sree
from replicate.papers.ali.response_figures import ResponseFigure, add_figures
from replicate.papers.ali.responses import draw_load_controls, draw_outputs, draw_setpoint_controls

FIGURES = (
    ResponseFigure(
        "fig-1",
        "Set-point responses, Example 1",
        partial(draw_outputs, comparison=padma_sree("setpoint"), limits=(-0.3, 4.4)),
        caption="Unit step of the set point, exact dead time. Proposed controller in the form (2); Padma Sree's "
        "in the form (2) on the left and in the parallel form on the right. In both it rings for far longer than "
        "the time shown; contrary to the text, its overshoot is the larger one.",
        alt="Two panels of set-point responses over 30 time units. The proposed response peaks above 3 and "
        "settles in about 11; Padma Sree's peaks higher still and oscillates around the set point to the end.",
    ),
    ResponseFigure(
        "fig-2",
        "Load responses, Example 1",
        partial(draw_outputs, comparison=padma_sree("load"), limits=(-0.4, 2.1)),
        caption="Unit step of a load at the plant input, exact dead time; structures as in Figure 1. The "
        "proposed controller has the larger peak and settles; Padma Sree's keeps oscillating.",
        alt="Two panels of load responses over 30 time units. The proposed response peaks at about 1.8 and "
        "returns to zero without oscillation; Padma Sree's peaks lower and oscillates to the end.",
    ),
    ResponseFigure(
        "fig-3",
        "Control signals for the set-point step, Example 1",
        partial(
            draw_setpoint_controls,
            comparison=padma_sree("setpoint"),
            limits=(-9.5, 9.0),
            kick_until=0.15,
            kick_top=24.0,
        ),
        caption="Unit step of the set point; structures as in Figure 1. The derivative of the step makes the "
        "control signal start at ten $K_p$ in the form (2), at eleven in the parallel form: narrow panels on "
        "the left. The wide panels are cut off and show the rest.",
        alt="Four panels. On the left the initial kick of the control signals, decaying within a tenth of a time "
        "unit; on the right the control signals over 30 time units, where Padma Sree's oscillates to the end and "
        "the proposed one does not.",
        size=(7.4, 5.2),
    ),
    ResponseFigure(
        "fig-4",
        "Control signals for the load step, Example 1",
        partial(draw_load_controls, comparison=padma_sree("load"), limits=(-4.2, 1.8)),
        caption="Unit step of a load at the plant input; structures as in Figure 1. A load step makes no kick; "
        "the control signal ends at $-1$, where it cancels the load.",
        alt="Two panels of control signals over 30 time units. The proposed signal dips to about minus 3.3 and "
        "returns smoothly to minus 1; Padma Sree's dips deeper and oscillates to the end.",
    ),
)

add_figures(FIGURES)
