"""V: the figures. Measurements cannot be repeated; simulations of the paper's models stand in for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.figures.curve_labels import label_curves
from replicate.loops import PID, Loop, Plant
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.diagrams import Diagram
from replicate.papers.panagopoulos.parts_3_to_6.industrial import (
    DRYING,
    DRYING_PI,
    STARCH,
    STARCH_PI,
    drying_pid,
    starch_pid,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SKETCH = "A sketch of the plant: there is nothing to compute."
MEASURED = (
    "The paper shows measurements at the mill. What is drawn is the paper's model with the printed settings, for "
    "{what}."
)


@paper.figure(
    "V-fig-1",
    "Step response of the starch boiler's model",
    caption="The fitted model $1.34\\,e^{-12.9s}/(43.3s+1)^2$, unit step at $t = 0$.",
    alt="Step response: zero until 12.9 seconds, then an s-shaped rise that approaches 1.34 after about 250 seconds.",
    size=(6.4, 3.2),
    stands_for="The paper shows the tool's window with the measured step response and the fitted model. Only "
    "the model can be drawn.",
)
def model_step(fig: Figure) -> None:
    """Draw the open-loop step response."""
    axes = fig.subplots()
    t = np.linspace(0.0, 350.0, 701)
    x = np.maximum(t - STARCH.dead_time, 0.0) / 43.3
    axes.plot(t, STARCH.gain * (1.0 - (1.0 + x) * np.exp(-x)), linewidth=2.0, label="model")
    axes.axhline(STARCH.gain, color="0.5", linewidth=0.8, linestyle=":", label="steady state")
    axes.axvline(STARCH.dead_time, color="0.5", linewidth=0.8, linestyle="--", label="dead time")
    axes.set_xlim(0.0, 350.0)
    axes.set_ylim(0.0, 1.5)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("change of temperature signal")
    if not label_curves(axes):
        axes.legend(loc="lower right")


@paper.figure(
    "V-fig-2",
    "The loop for which the controllers are designed",
    kind="diagram",
    caption="$G_{ff}$ acts on the set point, $G_c$ on the measured output; $l$ is the load disturbance, $n$ "
    "the measurement noise.",
    alt="Block diagram. The set point passes Gff; the output of Gc is subtracted, the load is added and "
    "drives the process G; its output x plus noise n is the measurement y that Gc receives.",
    size=(6.6, 2.2),
)
def loop(fig: Figure) -> None:
    """Draw the two-degree-of-freedom loop."""
    diagram = Diagram(fig)
    diagram.arrow((-1.4, 0), (-0.2, 0), label="$y_{sp}$", at=(-1.0, 0.3))
    diagram.box((0.6, 0), "$G_{ff}$")
    diagram.arrow((1.4, 0), (2.2, 0))
    diagram.sum((2.4, 0), {"left": "$+$", "bottom": "$-$"})
    diagram.arrow((2.6, 0), (3.6, 0), label="$u$", at=(3.1, 0.3))
    diagram.sum((3.8, 0), {"top": "$+$"})
    diagram.arrow((3.8, 1.1), (3.8, 0.2), label="$l$", at=(3.55, 0.9))
    diagram.arrow((4.0, 0), (4.8, 0))
    diagram.box((5.6, 0), "$G$")
    diagram.arrow((6.4, 0), (7.6, 0), label="$x$", at=(7.0, 0.3))
    diagram.sum((7.8, 0), {"top": "$+$"})
    diagram.arrow((7.8, 1.1), (7.8, 0.2), label="$n$", at=(7.5, 0.9))
    diagram.arrow((8.0, 0), (9.8, 0), label="$y$", at=(9.5, 0.3))
    diagram.dot((8.8, 0))
    diagram.arrow((8.8, 0), (8.8, -1.5), (6.4, -1.5))
    diagram.box((5.6, -1.5), "$G_c$")
    diagram.arrow((4.8, -1.5), (2.4, -1.5), (2.4, -0.2))
    diagram.frame(-1.6, 10.0, -2.2, 1.3)


paper.not_computable("V-fig-3", "The control problem of the starch boiler", SKETCH, kind="diagram")


def _experiment(axes: tuple[Axes, Axes], case: tuple[Plant, PID, str], until: float, load: tuple[float, float]) -> None:
    """Draw output and control signal for a unit set-point step and a load step (size, time)."""
    plant, controller, label = case
    size, at = load
    response = Loop(plant, controller).respond(load=size, load_at=at, until=until)
    # controllers with an ideal derivative jump at every multiple of the dead time: keep both sides of a jump apart
    t = np.unique(np.concatenate([np.linspace(0.0, until, 1501), response.control.breaks]))
    t = t[t <= until]
    axes[0].axhline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    axes[0].plot(t, response.output(t), linewidth=1.8, label="output")
    axes[1].plot(t, response.control(t), linewidth=1.2, color="C1", label="control signal")
    axes[0].set_title(label)
    for axis in axes:
        axis.set_xlim(0.0, until)
    axes[1].set_xlabel("time (s)")


def _side_by_side(
    fig: Figure, cases: tuple[tuple[Plant, PID, str], ...], until: float, load: tuple[float, float]
) -> None:
    grid = fig.subplots(2, len(cases), sharex=True, sharey="row", squeeze=False, gridspec_kw={"height_ratios": [3, 2]})
    for column, case in enumerate(cases):
        _experiment((grid[0, column], grid[1, column]), case, until, load)
    grid[0, 0].set_ylabel("output $y$")
    grid[1, 0].set_ylabel("control $u$")


@paper.figure(
    "V-fig-4",
    "Starch boiler: PI and PID controller",
    caption="Unit set-point step at $t = 0$ and a load step of $-0.5$ at 400 s, with $b = 1$ as the mill's "
    "system demands and the derivative filter $N = 8$. The PID controller rejects the load better but overshoots more.",
    alt="Two columns. Left the PI controller: the output overshoots moderately, and the load step pulls it down for "
    "about 150 seconds. Right the PID controller: more overshoot, and a smaller and shorter deviation after the load "
    "step.",
    size=(6.8, 4.2),
    stands_for=MEASURED.format(what="a set-point step and a load step"),
)
def starch(fig: Figure) -> None:
    """Draw Figure 4."""
    cases = (
        (STARCH, STARCH_PI, "PI, $K = 0.80$, $T_i = 60$"),
        (STARCH, starch_pid(), "PID, $K = 1.35$, $T_i = 40$, $T_d = 19$"),
    )
    _side_by_side(fig, cases, 900.0, (-0.5, 400.0))


paper.not_computable("V-fig-5", "The steam pressure control of a drying section", SKETCH, kind="diagram")


@paper.figure(
    "V-fig-6",
    "Cascade control of moisture and steam pressure",
    kind="diagram",
    caption="The outer controller $C_1$ keeps the moisture content $y_1$, the inner one, $C_2$, the steam "
    "pressure $y_2$. The paper designs $C_2$.",
    alt="Block diagram of a cascade. C1 acts on r1 minus y1 and gives the set point r2 of the inner loop of "
    "C2 and P2, whose output y2, disturbed by v2, drives P1; v1 disturbs the output y1.",
    size=(6.8, 2.1),
)
def cascade(fig: Figure) -> None:
    """Draw the cascade."""
    diagram = Diagram(fig)
    diagram.arrow((-1.2, 0), (-0.2, 0), label="$r_1$", at=(-0.8, 0.3))
    diagram.sum((0, 0), {"bottom": "$-$"})
    diagram.arrow((0.2, 0), (0.9, 0))
    diagram.box((1.6, 0), "$C_1$", width=1.4)
    diagram.arrow((2.3, 0), (3.4, 0), label="$r_2$", at=(2.8, 0.3))
    diagram.sum((3.6, 0), {"bottom": "$-$"})
    diagram.arrow((3.8, 0), (4.5, 0))
    diagram.box((5.2, 0), "$C_2$", width=1.4)
    diagram.arrow((5.9, 0), (6.6, 0))
    diagram.sum((6.8, 0), {"top": "$+$"})
    diagram.arrow((6.8, 1.1), (6.8, 0.2), label="$v_2$", at=(6.45, 0.9))
    diagram.arrow((7.0, 0), (7.6, 0))
    diagram.box((8.3, 0), "$P_2$", width=1.4)
    diagram.arrow((9.0, 0), (10.4, 0), label="$y_2$", at=(9.8, 0.3))
    diagram.dot((9.5, 0))
    diagram.arrow((9.5, 0), (9.5, -1.1), (3.6, -1.1), (3.6, -0.2))
    diagram.box((11.1, 0), "$P_1$", width=1.4)
    diagram.arrow((11.8, 0), (12.5, 0))
    diagram.sum((12.7, 0), {"top": "$+$"})
    diagram.arrow((12.7, 1.1), (12.7, 0.2), label="$v_1$", at=(12.35, 0.9))
    diagram.arrow((12.9, 0), (14.4, 0), label="$y_1$", at=(14.1, 0.3))
    diagram.dot((13.5, 0))
    diagram.arrow((13.5, 0), (13.5, -1.9), (0, -1.9), (0, -0.2))
    diagram.frame(-1.4, 14.6, -2.2, 1.3)


@paper.figure(
    "V-fig-7",
    "Drying section: set-point change with PI and PID controller",
    caption="Unit set-point step; the PID controller has the set-point filter $T_f = 5.32$ s and an ideal derivative.",
    alt="Two columns. Left the PI controller: fast rise, overshoot and a slow tail. Right the PID controller "
    "with filter: slower rise, less overshoot, and also a slow tail.",
    size=(6.8, 4.0),
    stands_for=MEASURED.format(what="a set-point step")
    + " On this nominal model both loops settle several times more slowly than the paper reports for the plant.",
)
def drying_step(fig: Figure) -> None:
    """Draw Figure 7."""
    cases = ((DRYING, DRYING_PI, "PI"), (DRYING, drying_pid(), "PID with filter"))
    _side_by_side(fig, cases, 70.0, (0.0, 0.0))


LOAD = (1.0, 40.0)  # a load step of one at 40 s shows beside the unit set-point step


@paper.figure(
    "V-fig-8",
    "Drying section: PI controller, set point and load",
    caption="Unit set-point step at $t = 0$ and unit load step at 40 s, PI controller $K = 5$, $T_i = 5$ s.",
    alt="Output and control signal of the PI loop: an overshoot after the set-point step, a short deviation "
    "after the load "
    "step.",
    size=(6.4, 3.6),
    stands_for=MEASURED.format(what="a set-point step and a load step"),
)
def drying_pi(fig: Figure) -> None:
    """Draw Figure 8."""
    _side_by_side(fig, ((DRYING, DRYING_PI, "PI"),), 80.0, LOAD)


@paper.figure(
    "V-fig-9",
    "Drying section: PID controller, set point and load",
    caption="The same experiment with the PID controller and its set-point filter. With an ideal derivative "
    "the control signal has a kink or jump at every multiple of the dead time.",
    alt="Output and control signal of the PID loop: an overshoot after the set-point step, and a deviation "
    "after the load step that is smaller than with PI.",
    size=(6.4, 3.6),
    stands_for=MEASURED.format(what="a set-point step and a load step"),
)
def drying_pid_figure(fig: Figure) -> None:
    """Draw Figure 9."""
    _side_by_side(fig, ((DRYING, drying_pid(), "PID with filter"),), 80.0, LOAD)
