"""The picture that stands on the page where no script runs: the first row's responses."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from replicate.display.inline_svg import inline_svg
from replicate.figures.off_screen import svg_text
from replicate.figures.style import style
from replicate.loops import Loop
from replicate.loops.notation import parse_controller, parse_plant
from replicate.whatif.rows import Row


def still(row: Row) -> str:
    """Return the responses of a row's loop to steps of set-point and load as an element of the page."""
    loop = Loop(parse_plant(row.plant), parse_controller(row.controller))
    with style(hashsalt="whatif"):
        fig = Figure(figsize=(6.0, 2.8))
        axes = fig.subplots()
        if loop.is_stable():
            step, load = loop.step(), loop.load_step()
            times = np.linspace(0.0, min(step.horizon, load.horizon), 600)
            axes.plot(times, step(times), label="set-point step")
            axes.plot(times, load(times), label="load step")
            axes.legend()
        axes.set_xlabel("time")
        axes.set_ylabel("output")
        svg = svg_text(fig, row.label)
    return inline_svg(svg, "still", row.label, f"Responses of {row.plant} with {row.controller} to unit steps.")
