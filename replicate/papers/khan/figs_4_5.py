"""Figures 4 and 5: overshoot and rise time against the gain, exact and by the paper's fits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.khan import paper
from replicate.papers.khan.fits import overshoot_fit, rise_time_fit
from replicate.papers.khan.sweep import stability_limit, sweep

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PH_4 = (0.0, 0.25, 0.5, 1.0, 1.5, 2.5, 5.0, 7.0, 10.0)  # the text does not list them
PH_5 = (0.5, 1.0, 1.5, 2.5, 5.0, 7.0, 10.0)  # as the text lists them


@paper.figure(
    "fig-4",
    "Overshoot against $Kh$",
    caption="Solid: exact, up to 0.99 of the stability limit. Dashed: the fit (2) where it is given. The text does not "
    "say which $ph$ the figure shows.",
    alt="Nine curves of percent overshoot against Kh, one for each ph from 0 to 10, each rising almost linearly "
    "from its "
    "break point, with the dashed fit on top of it.",
    size=(7.2, 4.6),
)
def overshoot(fig: Figure) -> None:
    """Draw exact overshoot and fit."""
    axes = fig.subplots()
    for index, ph in enumerate(PH_4):
        kh = np.linspace(0.01, 0.99, 120) * stability_limit(ph)
        color = f"C{index % 7}"
        exact = sweep(ph, kh)
        axes.plot(kh, exact.overshoot, color=color, ls="-", label=f"$ph = {ph:g}$")
        axes.plot(kh, [overshoot_fit(ph, k) for k in kh], color=color, ls="--", lw=1.1, label=f"fit, $ph = {ph:g}$")
        axes.annotate(f"{ph:g}", (kh[-1], exact.overshoot[-1]), xytext=(2, 2), textcoords="offset points", fontsize=8)
    axes.set(xlabel="$Kh$", ylabel="overshoot (%)", xlim=(0, 12), ylim=(0, 110))
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::2], labels[::2], ncols=2, loc="lower right")


@paper.figure(
    "fig-5",
    "Rise time against $Kh$",
    caption="Solid: exact, up to 0.99 of the stability limit. Dashed: the fit (3).",
    alt="Seven falling curves of rise time over dead time against Kh, one for each ph from 0.5 to 10, with the "
    "dashed fit "
    "close to each.",
    size=(7.2, 4.2),
)
def rise_time(fig: Figure) -> None:
    """Draw exact rise time and fit."""
    axes = fig.subplots()
    for index, ph in enumerate(PH_5):
        kh = np.linspace(0.02, 0.99, 120) * stability_limit(ph)
        color = f"C{index % 7}"
        axes.plot(kh, sweep(ph, kh).rise_time, color=color, ls="-", label=f"$ph = {ph:g}$")
        axes.plot(kh, rise_time_fit(ph, kh), color=color, ls="--", lw=1.1, label=f"fit, $ph = {ph:g}$")
    axes.set(xlabel="$Kh$", ylabel="$t_r / h$", xlim=(0, 11), ylim=(0, 3))
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::2], labels[::2])
