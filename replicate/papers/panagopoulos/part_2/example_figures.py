"""Figures 4 to 6 of the supplement: load responses, Bode and Nyquist diagrams of the two controllers of its example."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.figures.curve_labels import label_curves
from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.example_controllers import CONTROLLERS
from replicate.papers.panagopoulos.part_2.processes import G4

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LABELS = {"kd=1": "(1.00, 0.50, 1.00)", "kd=3": "(1.00, 0.98, 3.00)"}
STYLES = {"kd=1": ("C0", "-"), "kd=3": ("C1", "--")}


@paper.figure(
    "IIs-fig-4",
    "Load responses of the two controllers",
    caption="$G = 1/(s+1)^4$, unit load step. $(k, k_i, k_d)$ as labelled.",
    alt="Two load responses. The full line rises to a little less than one half and dies out after one small "
    "swing; the dashed "
    "line peaks lower and keeps swinging.",
    size=(6.0, 3.2),
)
def load_responses(fig: Figure) -> None:
    """Draw the load responses."""
    axes = fig.subplots()
    t = np.linspace(0.0, 50.0, 801)
    for key, controller in CONTROLLERS.items():
        color, line = STYLES[key]
        axes.plot(t, Loop(G4, controller).load_step(until=50.0)(t), color=color, linestyle=line, label=LABELS[key])
    axes.set_xlim(0.0, 50.0)
    axes.set_xlabel("time $t$")
    axes.set_ylabel("output $y(t)$")
    if not label_curves(axes):
        axes.legend(title="$(k, k_i, k_d)$")


@paper.figure(
    "IIs-fig-5",
    "Bode diagrams of the loop transfer functions",
    caption="Gain and phase of $L$, with $(k, k_i, k_d)$ as labelled. With $k_d = 3$ the phase first lags, then leads.",
    alt="Bode diagram. Both gains fall; the phase of the full line falls steadily, that of the dashed line "
    "drops below it, rises again around 0.6 rad/s and then falls.",
    size=(6.0, 4.6),
)
def bode(fig: Figure) -> None:
    """Draw gain and phase."""
    gain, phase = fig.subplots(2, 1, sharex=True)
    w = np.geomspace(0.01, 10.0, 600)
    for key, controller in CONTROLLERS.items():
        color, line = STYLES[key]
        value = Loop(G4, controller)(1j * w)
        gain.loglog(w, np.abs(value), color=color, linestyle=line, label=LABELS[key])
        phase.semilogx(w, np.degrees(np.unwrap(np.angle(value))), color=color, linestyle=line, label=LABELS[key])
    gain.set_title("gain")
    phase.set_title("phase")
    gain.set_ylabel("$|L(i\\omega)|$")
    phase.set_ylabel("$\\arg L(i\\omega)$, degrees")
    phase.set_yticks([-90, -180, -270])
    phase.set_xlabel("frequency $\\omega$, rad per unit of time")
    if not label_curves(gain):
        gain.legend(title="$(k, k_i, k_d)$")


@paper.figure(
    "IIs-fig-6",
    "Nyquist curves of the two loops",
    caption="With the circle of $M_s = 1.4$ around $-1$, which both curves enter. The right curve has the sharp "
    "bend that the "
    "supplement calls a cusp.",
    alt="Two Nyquist curves with a circle around minus one. The left one bends smoothly around the circle, the "
    "right one turns sharply to the left of it and then follows it.",
    size=(7.0, 3.6),
)
def nyquist(fig: Figure) -> None:
    """Draw the Nyquist curves."""
    panels = fig.subplots(1, 2, sharey=True)
    w = np.geomspace(0.1, 30.0, 3000)
    turn = np.linspace(0.0, 2.0 * np.pi, 121)
    for (key, controller), axes in zip(CONTROLLERS.items(), panels, strict=True):
        value = Loop(G4, controller)(1j * w)
        axes.plot(
            -1.0 + np.cos(turn) / 1.4, np.sin(turn) / 1.4, color="C6", linestyle="-", linewidth=1.1, label="$M_s = 1.4$"
        )
        axes.plot(value.real, value.imag, color=STYLES[key][0], linestyle="-", label="$L(i\\omega)$")
        axes.plot([-1.0], [0.0], marker="+", color="C6", linestyle="", label="$-1$")
        axes.set_xlim(-2.0, 0.5)
        axes.set_ylim(-2.0, 0.5)
        axes.set_aspect("equal")
        axes.set_title(LABELS[key])
        axes.set_xlabel("Re")
    panels[0].set_ylabel("Im")
    if not label_curves(panels[0]):
        panels[0].legend(loc="lower left")
