"""Figures 7 and 8 of the supplement: load and noise with first- and second-order filters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from replicate.figures.curve_labels import label_curves
from replicate.loops import PID, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2 import filters
from replicate.papers.panagopoulos.part_2.processes import G4

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

NOISE_FREQUENCY = 40.0  # rad/s
NOISE = 0.1  # its amplitude, which the text does not give
NOISE_AT, UNTIL = 30.0, 34.0


def noise_response(controller: PID, t: Array, *, to: str) -> Array:
    """Return y or u after the noise sin(40 t) is switched on at t = 0, in closed form by partial fractions.

    The noise is added to the output before the filter; y is what is measured, process output plus noise.
    """
    num, den = controller.feedback_polynomials()
    characteristic = np.polyadd(np.polymul(den, G4.den), np.polymul(num, G4.num))
    top = np.polymul(den, G4.den) if to == "y" else -np.polymul(num, G4.den)
    whole = np.polymul(characteristic, [1.0, 0.0, NOISE_FREQUENCY**2])
    poles = np.concatenate([np.roots(characteristic), [1j * NOISE_FREQUENCY, -1j * NOISE_FREQUENCY]])
    weights = NOISE_FREQUENCY * np.polyval(top, poles) / np.polyval(np.polyder(whole), poles)
    return np.asarray((np.exp(np.outer(t, poles)) @ weights).real)


def filtered(column: str) -> PID:
    """Return the controller of a column as the text describes it, with its filter."""
    filter_, controller = filters.by_the_text(column)
    assert filter_ is not None  # noqa: S101  -- only the design without a filter has none
    return filter_.on(controller)


@paper.figure(
    "IIs-fig-7",
    "Load response, then measurement noise",
    caption="A unit load step; from $t = 30$ on a sinusoid of 40 rad/s and amplitude 0.1 is added to the "
    "measurement (time scale stretched). Measured output and control signal; left with filters of first, right of "
    "second order, designed as the text says. Dashed: the load response of the design without filter. First-order "
    "filters let more of the noise through to the control signal than those of second order.",
    alt="Twelve panels, three filter constants in pairs of rows for y and u, two filter orders in columns. Load "
    "responses differ little between columns; the noise in the control signal is much smaller in the right column and "
    "grows with N.",
    size=(7.4, 9.6),
)
def load_and_noise(fig: Figure) -> None:
    """Draw output and control signal for six filters."""
    panels = fig.subplots(6, 2, sharex=True, sharey="row", height_ratios=(3, 2) * 3)
    t = np.linspace(0.0, NOISE_AT, 301)
    later = np.linspace(0.0, UNTIL - NOISE_AT, 801)
    shown = np.concatenate([t, NOISE_AT + 3.0 * later])  # the noise is faster: stretched
    plain = Loop(G4, filters.unfiltered().controller).load_step(until=UNTIL)(np.concatenate([t, NOISE_AT + later]))
    for column, (order, n) in filters.HEADED.items():
        controller = filtered(column)
        top, bottom = (panels[2 * (2, 5, 10).index(n) + part, order - 1] for part in (0, 1))
        response = Loop(G4, controller).respond(setpoint=0.0, load=1.0, until=UNTIL)
        for axes, signal, to in ((top, response.output, "y"), (bottom, response.control, "u")):
            after = signal(NOISE_AT + later) + NOISE * noise_response(controller, later, to=to)
            axes.plot(
                shown, np.concatenate([signal(t), after]), color="C0", linestyle="-", linewidth=0.9, label="$F_yG$"
            )
        top.plot(shown, plain, color="C1", linestyle="--", linewidth=1.2, label="$G$")
        top.set_title(f"$n = {order}$, $N = {n}$", fontsize=10)
        if order == 1:
            top.set_ylabel("$y$")
            bottom.set_ylabel("$u$")
    ticks = [0.0, 10.0, 20.0, 30.0, 36.0, 42.0]
    for axes in panels[-1]:
        axes.set_xticks(ticks, ["0", "10", "20", "30", "32", "34"])
        axes.set_xlim(0.0, shown[-1])
        axes.set_xlabel("time $t$")
    panels[0, 0].legend(loc="upper right", fontsize=9)


@paper.figure(
    "IIs-fig-8",
    "From measurement noise to control signal",
    caption=r"$|G_c/(1+GG_c)|$ with the filter in $G_c$, for $M_s = 1.4$ and filters of first (left) and second "
    r"order (right) as "
    "the text describes them; dotted in grey the filter that the table's columns headed 2 belong to, $N = 1$.",
    alt="Two panels of amplitude over frequency. Left, first order: the curves level off at a value that grows "
    "with N. Right, second order: they peak and then fall.",
    size=(7.0, 3.5),
)
def amplitudes(fig: Figure) -> None:
    """Draw the amplitude curves."""
    panels = fig.subplots(1, 2, sharey=True)
    w = np.geomspace(0.01, 100.0, 500)
    s = 1j * w
    styles = {2: ("C0", "-"), 5: ("C1", "--"), 10: ("C2", ":")}
    for column, (order, n) in filters.HEADED.items():
        axes = panels[order - 1]
        controller = filtered(column)
        c = controller.feedback(s)
        color, line = styles[n]
        axes.loglog(w, np.abs(c / (1.0 + c * G4(s))), color=color, linestyle=line, label=f"$N = {n}$")
        if n == 2:
            filter_, gains = filters.reconstructed(column)
            assert filter_ is not None  # noqa: S101  -- only the design without a filter has none
            c = filter_.on(gains).feedback(s)
            axes.loglog(w, np.abs(c / (1.0 + c * G4(s))), color="C6", linestyle=":", linewidth=1.2, label="$N = 1$")
    for order, axes in enumerate(panels, start=1):
        axes.set_title(f"$n = {order}$")
        axes.set_xlabel(r"$\omega$, rad per unit of time")
        axes.set_xlim(0.01, 100.0)
    panels[0].set_ylabel("$|G_c/(1+GG_c)|$")
    if not label_curves(panels[0]):
        panels[0].legend()
