"""VI: the figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.figures.curve_labels import label_curves
from replicate.loops import PI, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.active_damping import (
    EXAMPLE,
    K_B,
    PI_GAIN,
    PI_INTEGRAL_TIME,
    allpass,
    bandpass,
    k_b_from,
)
from replicate.papers.panagopoulos.parts_3_to_6.damping_batch import OMEGA_P, fit, of
from replicate.papers.panagopoulos.parts_3_to_6.diagrams import Diagram
from replicate.papers.panagopoulos.parts_3_to_6.modal import ModalSum

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DAMPINGS = (0.2, 0.4, 0.6, 0.8)
PULSE = 0.1  # s, width of the pulse of Figure 7; the paper does not state its own


@paper.figure(
    "VI-fig-1",
    "A notch filter in the loop",
    kind="diagram",
    caption="The notch filter $F$ keeps the controller from exciting the mode, but a load disturbance $l$ still does.",
    alt="Block diagram: set point, controller C, notch filter F, then the load l is added before the process "
    "P; unit feedback.",
    size=(6.6, 1.9),
)
def notch(fig: Figure) -> None:
    """Draw the loop with the notch filter."""
    diagram = Diagram(fig)
    diagram.arrow((-1.3, 0), (-0.2, 0), label="$r$", at=(-0.9, 0.3))
    diagram.sum((0, 0), {"bottom": "$-$"})
    diagram.arrow((0.2, 0), (1.0, 0))
    diagram.box((1.8, 0), "$C$")
    diagram.arrow((2.6, 0), (3.4, 0))
    diagram.box((4.2, 0), "$F$")
    diagram.arrow((5.0, 0), (5.8, 0))
    diagram.sum((6.0, 0), {"top": "$+$"})
    diagram.arrow((6.0, 1.1), (6.0, 0.2), label="$l$", at=(5.7, 0.9))
    diagram.arrow((6.2, 0), (7.0, 0))
    diagram.box((7.8, 0), "$P$")
    diagram.arrow((8.6, 0), (10.2, 0), label="$y$", at=(9.9, 0.3))
    diagram.dot((9.2, 0))
    diagram.arrow((9.2, 0), (9.2, -1.1), (0, -1.1), (0, -0.2))
    diagram.frame(-1.5, 10.4, -1.4, 1.3)


@paper.figure(
    "VI-fig-2",
    "Control with active damping",
    kind="diagram",
    caption="The inner loop with $F$ damps the mode; the outer loop with $C$ does the rest.",
    alt="Block diagram: set point, controller C, a junction where the output of F is subtracted, the load l "
    "is added, then the process P; F feeds back the output, and so does the outer loop.",
    size=(6.6, 2.3),
)
def active(fig: Figure) -> None:
    """Draw both loops."""
    diagram = Diagram(fig)
    diagram.arrow((-1.3, 0), (-0.2, 0), label="$r$", at=(-0.9, 0.3))
    diagram.sum((0, 0), {"bottom": "$-$"})
    diagram.arrow((0.2, 0), (1.0, 0))
    diagram.box((1.8, 0), "$C$")
    diagram.arrow((2.6, 0), (3.6, 0))
    diagram.sum((3.8, 0), {"left": "$+$", "top": "$+$", "bottom": "$-$"})
    diagram.arrow((3.8, 1.1), (3.8, 0.2), label="$l$", at=(3.5, 0.9))
    diagram.arrow((4.0, 0), (5.2, 0))
    diagram.box((6.0, 0), "$P$")
    diagram.arrow((6.8, 0), (9.2, 0), label="$y$", at=(8.9, 0.3))
    diagram.dot((7.6, 0))
    diagram.arrow((7.6, 0), (7.6, -1.3), (6.8, -1.3))
    diagram.box((6.0, -1.3), "$F$", height=0.9)
    diagram.arrow((5.2, -1.3), (3.8, -1.3), (3.8, -0.2), label="$y_f$", at=(4.5, -1.0))
    diagram.dot((8.3, 0))
    diagram.arrow((8.3, 0), (8.3, -2.1), (0, -2.1), (0, -0.2))
    diagram.frame(-1.5, 9.4, -2.4, 1.3)


@paper.figure(
    "VI-fig-3",
    "From load to output",
    kind="diagram",
    caption="The inner loop alone: $Y/L = P/(1+PF)$.",
    alt="Block diagram: the load l minus the output of F drives the process P; F feeds back the output y.",
    size=(5.6, 1.9),
)
def inner(fig: Figure) -> None:
    """Draw the inner loop."""
    diagram = Diagram(fig)
    diagram.arrow((-1.3, 0), (-0.2, 0), label="$l$", at=(-0.9, 0.3))
    diagram.sum((0, 0), {"left": "$+$", "bottom": "$-$"})
    diagram.arrow((0.2, 0), (1.4, 0))
    diagram.box((2.2, 0), "$P$")
    diagram.arrow((3.0, 0), (5.0, 0), label="$y$", at=(4.7, 0.3))
    diagram.dot((3.9, 0))
    diagram.arrow((3.9, 0), (3.9, -1.3), (3.0, -1.3))
    diagram.box((2.2, -1.3), "$F$", height=0.9)
    diagram.arrow((1.4, -1.3), (0, -1.3), (0, -0.2), label="$y_f$", at=(0.7, -1.0))
    diagram.frame(-1.5, 5.2, -1.9, 0.7)


@paper.figure(
    "VI-fig-4",
    "Bode diagrams of the all-pass and the band-pass filter",
    caption="$\\omega_a = \\omega_b = K_b = 1$. The all-pass filter turns the phase and leaves the gain at "
    "one; the band-pass filter has no phase at its centre frequency.",
    alt="Four panels, magnitude above phase. All-pass: magnitude one, phase falling from 0 to -360 degrees, "
    "the steeper the smaller the damping. Band-pass: resonance curves that are the higher the smaller the "
    "damping, phase from 90 to -90 degrees.",
    size=(6.8, 4.6),
)
def bode(fig: Figure) -> None:
    """Draw Figure 4."""
    grid = fig.subplots(2, 2, sharex=True)
    w = np.geomspace(0.01, 100.0, 801)
    for index, zeta in enumerate(DAMPINGS):
        style = {"color": f"C{index}", "label": f"$\\zeta = {zeta:g}$", "linewidth": 1.4}
        for column, (num, den) in enumerate((allpass(1.0, zeta), bandpass(1.0, zeta, 1.0))):
            value = np.polyval(num, 1j * w) / np.polyval(den, 1j * w)
            phase = np.degrees(np.unwrap(np.angle(value)))
            grid[0, column].loglog(w, np.abs(value), **style)
            grid[1, column].semilogx(w, phase - 360.0 * np.round((phase[0] - 90.0 * column) / 360.0), **style)
    grid[0, 0].set_ylim(0.1, 10.0)
    grid[1, 0].set_yticks(range(-360, 1, 90))
    grid[1, 1].set_yticks(range(-90, 91, 45))
    for axes, title in zip(grid[0], ("all-pass $F_a$", "band-pass $F_b$"), strict=True):
        axes.set_title(title)
    for axes in grid[1]:
        axes.set_xlabel("frequency $\\omega$")
        axes.set_xlim(0.01, 100.0)
    grid[0, 0].set_ylabel("magnitude")
    grid[1, 0].set_ylabel("phase (degrees)")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=4)


@paper.figure(
    "VI-fig-5",
    "What the design needs to know of the process",
    caption="$|P(i\\omega)|$ of the flexible shaft, with $P_{max}$ at $\\omega_p$ and the local minimum "
    "$P_{min}$ below it.",
    alt="Magnitude of the process over frequency, both logarithmic: flat, then falling, a minimum, a sharp "
    "resonance and a steep fall. The minimum and the resonance are marked.",
    size=(6.4, 3.6),
)
def characteristics(fig: Figure) -> None:
    """Draw Figure 5."""
    axes = fig.subplots()
    smallest, _ = EXAMPLE.extrema()
    near = EXAMPLE.omega_p * (1.0 + np.linspace(-0.3, 0.3, 301))
    w = np.union1d(np.geomspace(0.01, 100.0, 601), near)
    axes.loglog(w, np.abs(EXAMPLE.plant(1j * w)), linewidth=1.8, label="$|P(i\\omega)|$")
    axes.plot([EXAMPLE.omega_p], [EXAMPLE.p_max], "o", markersize=5, label=f"$P_{{max}} = {EXAMPLE.p_max:.3f}$")
    axes.plot([smallest.frequency], [smallest.value], "s", markersize=5, label=f"$P_{{min}} = {smallest.value:.4f}$")
    axes.set_xlim(0.01, 100.0)
    axes.set_ylim(1e-4, 10.0)
    axes.set_xlabel("frequency $\\omega$")
    axes.set_ylabel("$|P(i\\omega)|$")
    axes.legend(loc="lower left")


@paper.figure(
    "VI-fig-6",
    "The best gain over $P_{max}/P_{min}$",
    caption="Crosses and other marks: gain of smallest IAE on the test batch of the table above, by resonance "
    "frequency, with the line through each. Full line: (10) as printed.",
    alt="Scatter plot of the best gain over the ratio, with one fitted line for each of four resonance "
    "frequencies. The lines have different slopes; the printed line lies near that of the lowest frequency.",
    size=(6.4, 4.0),
    stands_for="The paper's test batch is not given. The marks belong to a batch chosen here; the line (10) "
    "is the paper's.",
)
def regression(fig: Figure) -> None:
    """Draw Figure 6."""
    axes = fig.subplots()
    ratio = [1.4, 28.0]
    for index, (omega_p, marker) in enumerate(zip(OMEGA_P, "x+1s", strict=True)):
        members = of(omega_p)
        line = fit(members)
        x = np.array([member.ratio for member in members])
        color = f"C{index + 1}"
        label = f"$\\omega_p = {omega_p:g}$"
        axes.plot(x, [m.k_b for m in members], marker, color=color, linestyle="none", markersize=6, label=label)
        axes.plot(np.sort(x), line.intercept + line.slope * np.sort(x), color=color, linewidth=0.9, linestyle="--")
    axes.plot(ratio, [k_b_from(x) for x in ratio], color="C0", linewidth=2.0, label="(10)")
    axes.set_xlim(0.0, 28.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("$P_{max}/P_{min}$")
    axes.set_ylabel("best $k_b$")
    axes.legend(loc="upper left")


@paper.figure(
    "VI-fig-7",
    "Response to a short pulse at the input of the shaft",
    caption=f"Pulse of unit area and {PULSE:g} s width. Left without, right with active control, $k_b = 2.75$.",
    alt="Two panels with the same scale. Left an oscillation that decays slowly, right one that has died out "
    "after a few seconds; both on top of a slow decay.",
    size=(6.8, 3.2),
    stands_for="The size of the paper's pulse is not stated; the width here is a choice.",
)
def pulse(fig: Figure) -> None:
    """Draw Figure 7."""
    left, right = fig.subplots(1, 2, sharey=True)
    t = np.linspace(0.0, 10.0, 1001)
    for axes, k_b, title in ((left, 0.0, "no active control"), (right, K_B, "active control")):
        response = ModalSum.impulse(EXAMPLE.damped(k_b))
        axes.plot(t, response.pulse(PULSE, t), linewidth=1.4)
        axes.set_title(title)
        axes.set_xlim(0.0, 10.0)
        axes.set_xlabel("time (s)")
    left.set_ylabel("output $y$")


@paper.figure(
    "VI-fig-8",
    "Closed loop with a PI controller",
    caption="Set-point step under PI control, $K = 1$, $T_i = 12.5$ s, without and with active control, $k_b = 2.75$.",
    alt="Two step responses. Without active control a lasting oscillation rides on the response, with it the "
    "response is smooth.",
    size=(6.4, 3.6),
    stands_for="The paper does not say which signal it shows; a unit set-point step is drawn.",
)
def closed_loop(fig: Figure) -> None:
    """Draw Figure 8."""
    axes = fig.subplots()
    t = np.linspace(0.0, 60.0, 3001)
    controller = PI.from_integral_time(PI_GAIN, PI_INTEGRAL_TIME)
    for k_b, label, width in ((0.0, "no active control", 0.8), (K_B, "active control", 2.2)):
        axes.plot(t, Loop(EXAMPLE.damped(k_b), controller).step(until=60.0)(t), linewidth=width, label=label)
    axes.set_xlim(0.0, 60.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("output $y$")
    if not label_curves(axes):
        axes.legend(loc="lower right")
