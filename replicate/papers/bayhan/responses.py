"""How the figures draw step responses: the pole assignment in front, the competitors behind it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PI
from replicate.papers.bayhan.processes import Process, controllers, exact_step

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Load-disturbance rules are solid, the set-point rule of the same criterion is dashed in the same colour.
STYLES = {
    "ZN": ("C6", "-."),
    "CC": ("C4", "-."),
    "IMC": ("C5", "-."),
    "ISE": ("C0", "-"),
    "IAE": ("C1", "-"),
    "IAESPC": ("C1", "--"),
    "ITSE": ("C3", "-"),
    "ITSESPC": ("C3", "--"),
    "ITAE": ("C2", "-"),
    "ITAESPC": ("C2", "--"),
}

PANELS = {"Kp/Ti": "$K_i = K_p/T_i$, equation (3)", "1/Ti": "$K_i = 1/T_i$, as in the tables"}


def draw_step(axes: Axes, process: Process, controller: PI, until: float, **style: object) -> None:
    """Draw the exact unit step response of a stable loop on [0, until]."""
    response = exact_step(process, controller.k, controller.ki)
    if response is None:
        msg = f"{style.get('label', 'the loop')} is unstable and has no step response to draw"
        raise ValueError(msg)
    times = np.linspace(0.0, until, 1201)
    inside = times <= response.horizon
    values = np.ones_like(times)  # beyond its horizon a response has settled to better than a line's width
    values[inside] = response(times[inside])
    axes.plot(times, values, **style)  # type: ignore[arg-type]


def step_axes(axes: Axes, until: float, title: str = "") -> None:
    """Label an axes of step responses and show the 2 % band around the set point."""
    axes.axhspan(0.98, 1.02, color="0.5", alpha=0.18, linewidth=0.0)
    axes.set_xlim(0.0, until)
    axes.set_xlabel("time $t$")
    axes.set_title(title)


def compare_rules(
    fig: Figure,
    process: Process,
    rows: Sequence[str],
    until: float,
    top: float,
    *,
    panels: Mapping[str, str] = PANELS,
) -> None:
    """Draw the rules side by side with the integral gain of the text and with that of the tables."""
    both = fig.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axes, (convention, title) in zip(both, panels.items(), strict=True):
        found = controllers(process, "Kp/Ti" if convention == "Kp/Ti" else "1/Ti")
        step_axes(axes, until, title)
        others = [row for row in rows if row != "PA"]
        for row in others:
            color, line = STYLES[row]
            draw_step(axes, process, found[row], until, label=row, color=color, linestyle=line, linewidth=1.3)
        draw_step(
            axes,
            process,
            found["PA"],
            until,
            label="PA",
            color=axes.xaxis.label.get_color(),
            linestyle="-",
            linewidth=2.6,
        )
        axes.set_ylim(0.0, top)
    both[0].set_ylabel("output $y(t)$")
    handles, labels = both[0].get_legend_handles_labels()
    fig.legend(handles[-1:] + handles[:-1], labels[-1:] + labels[:-1], loc="outside lower center", ncols=6)
