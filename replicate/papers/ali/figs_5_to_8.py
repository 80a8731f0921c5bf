"""Figures 5 to 8: the responses of Example 2."""

from __future__ import annotations

from functools import partial

from replicate.papers.ali.comparisons import visioli
from replicate.papers.ali.response_figures import ResponseFigure, add_figures
from replicate.papers.ali.responses import draw_load_controls, draw_outputs, draw_setpoint_controls

FIGURES = (
    ResponseFigure(
        "fig-5",
        "Set-point responses, Example 2",
        partial(draw_outputs, comparison=visioli("setpoint"), limits=(-0.2, 2.7)),
        caption="Unit step of the set point, exact dead time. Proposed controller in the form (2); Visioli's "
        "set-point setting in the form (2) on the left and in the parallel form on the right. Which of the two "
        "settles first depends on that choice.",
        alt="Two panels of set-point responses. Visioli's response rises first, overshoots by more than 100 per "
        "cent and oscillates; the proposed one overshoots by about 54 per cent without oscillation.",
    ),
    ResponseFigure(
        "fig-6",
        "Load responses, Example 2",
        partial(draw_outputs, comparison=visioli("load"), limits=(-0.45, 0.75)),
        caption="Unit step of a load at the plant input, exact dead time; Visioli's load setting. Read in the "
        "printed form (2) it is unstable (left); in the parallel form (right) it rejects the load with the "
        "smaller peak.",
        alt="Two panels of load responses. Left, Visioli's response oscillates with growing amplitude; right, it "
        "decays and has a smaller peak than the proposed one, which is smooth in both panels.",
    ),
    ResponseFigure(
        "fig-7",
        "Control signals for the set-point step, Example 2",
        partial(
            draw_setpoint_controls,
            comparison=visioli("setpoint"),
            limits=(-16.0, 24.0),
            kick_until=0.045,
            kick_top=76.0,
        ),
        caption="Unit step of the set point; Visioli's set-point setting, structures as in Figure 5. Narrow "
        "panels: the initial kick of ten $K_p$ in the form (2), eleven in the parallel form. The wide panels "
        "are cut off and show the rest.",
        alt="Four panels. On the left the initial kick of the control signals; on the right the control signals "
        "over 6 time units, where Visioli's oscillates with a large amplitude before it settles.",
        size=(7.4, 5.2),
    ),
    ResponseFigure(
        "fig-8",
        "Control signals for the load step, Example 2",
        partial(draw_load_controls, comparison=visioli("load"), limits=(-6.0, 5.4)),
        caption="Unit step of a load at the plant input; Visioli's load setting, structures as in Figure 6.",
        alt="Two panels of control signals. Left, Visioli's grows without bound; right, it oscillates several "
        "times before it reaches minus 1, while the proposed signal gets there after one undershoot.",
    ),
)

add_figures(FIGURES)
