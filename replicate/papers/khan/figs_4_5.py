"""Figures 4 and 5: overshoot and rise time against the gain, exact and by the paper's fits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from replicate.papers.khan import paper
from replicate.papers.khan.fits import overshoot_fits, rise_time_fit
from replicate.papers.khan.sweep import stability_limit, sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Figure 4's values are not in the text; small ph left, where cases I to III apply, large ph right.
PH_4 = ((0.0, 0.25, 0.5, 0.75, 1.0, 1.5), (2.5, 4.0, 5.0, 7.0, 10.0))
PH_5 = (0.5, 1.0, 1.5, 2.5, 5.0, 7.0, 10.0)  # as the text lists them


def _fit_line(axes: Axes) -> dict[str, Any]:
    """Fits are thin dashed lines in the colour of the text, on top of the exact curves."""
    return {"color": axes.xaxis.label.get_color(), "ls": (0, (4, 3)), "lw": 0.9}


def _name(axes: Axes, end: tuple[float, float], ph: float, index: int, offset: tuple[float, float]) -> None:
    """Write ph where a curve ends, in the colour of the curve."""
    across: Literal["left", "center"] = "left" if offset[0] else "center"
    down: Literal["center", "bottom"] = "center" if offset[0] else "bottom"
    axes.annotate(
        f"{ph:g}", end, xytext=offset, textcoords="offset points", color=f"C{index}", fontsize=9.5, ha=across, va=down
    )


def _legend(axes: Axes, location: Literal["lower right", "upper right"]) -> None:
    """List the exact curves, and the first fit for all of them."""
    handles, labels = axes.get_legend_handles_labels()
    exact = [pair for pair in zip(handles, labels, strict=True) if not pair[1].startswith("fit")]
    fit = next(pair for pair in zip(handles, labels, strict=True) if pair[1].startswith("fit"))
    shown = [*exact, (fit[0], "fit")]
    axes.legend([handle for handle, _ in shown], [label for _, label in shown], loc=location)


@paper.figure(
    "fig-4",
    "Overshoot against $Kh$",
    caption="Coloured: exact, up to 0.99 of the stability limit, with $ph$ at the end. Dashed: the fit (2), where a "
    "case applies. Next to the limit a later peak is the highest for large $ph$ (the bends right), which the fit does "
    "not follow. The text does not say which $ph$ the figure shows.",
    alt="Two panels of percent overshoot against Kh. Left six curves for ph from 0 to 1.5, each leaving zero at its "
    "break point and then rising almost linearly to about 110; right five flatter, straight curves for ph from 2.5 to "
    "10, of which the last three bend upwards just before the stability limit. The dashed fits lie on the curves.",
    size=(7.4, 4.2),
)
def overshoot(fig: Figure) -> None:
    """Draw exact overshoot and fit."""
    for axes, values in zip(fig.subplots(1, 2, sharey=True), PH_4, strict=True):
        for index, ph in enumerate(values):
            kh = np.linspace(0.005, 0.99, 200) * stability_limit(ph)
            exact = sweep(ph, kh)
            axes.plot(kh, exact.overshoot, color=f"C{index}", ls="-", lw=2.0, label=f"$ph = {ph:g}$")
            axes.plot(kh, overshoot_fits(exact.ph, kh), **_fit_line(axes), label=f"fit, $ph = {ph:g}$")
            _name(axes, (float(kh[-1]), float(exact.overshoot[-1])), ph, index, (0.0, 2.0))
        axes.set(xlabel="$Kh$", xlim=(0.0, None), ylim=(0.0, 125.0))
        _legend(axes, "lower right")
    fig.axes[0].set_ylabel("overshoot (%)")


@paper.figure(
    "fig-5",
    "Rise time against $Kh$",
    caption="Coloured: exact, up to 0.99 of the stability limit, with $ph$ at the end. Dashed: the fit (3). The "
    "logarithmic axis shows where the fit is off: at small gains for $ph = 5$ to 10.",
    alt="Seven falling curves of rise time over dead time against Kh, one for each ph from 0.5 to 10, on a logarithmic "
    "axis. The dashed fits lie on the curves up to ph of 2.5; for 5 and 10 they leave them at small gains.",
    size=(7.2, 4.4),
)
def rise_time(fig: Figure) -> None:
    """Draw exact rise time and fit."""
    axes = fig.subplots()
    for index, ph in enumerate(PH_5):
        kh = np.linspace(0.01, 0.99, 200) * stability_limit(ph)
        exact = sweep(ph, kh).rise_time
        axes.plot(kh, exact, color=f"C{index}", ls="-", lw=2.0, label=f"$ph = {ph:g}$")
        axes.plot(kh, rise_time_fit(ph, kh), **_fit_line(axes), label=f"fit, $ph = {ph:g}$")
        _name(axes, (float(kh[-1]), float(exact[-1])), ph, index, (4.0, 0.0))
    axes.set(xlabel="$Kh$", ylabel="$t_r / h$", xlim=(0.0, 10.5), yscale="log", ylim=(0.04, 4.0))
    axes.set_yticks([0.05, 0.1, 0.2, 0.5, 1.0, 2.0], ["0.05", "0.1", "0.2", "0.5", "1", "2"])
    axes.minorticks_off()
    _legend(axes, "upper right")
