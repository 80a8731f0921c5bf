"""How far a Padé approximation of the dead time is from the exact response, by order."""

import control
import numpy as np
from matplotlib.figure import Figure

from replicate.loops import PI, Loop, Plant


def draw() -> Figure:
    """Draw the difference of the responses to a set-point step for three orders."""
    controller = PI(k=0.6, ki=0.5)
    times = np.linspace(0.0, 8.0, 800)
    exact = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=1.0), controller).step(until=8.0)(times)
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.subplots()
    for order in (1, 2, 4):
        num, den = control.pade(1.0, order)
        approximated = Loop(Plant(num, np.polymul(den, [1.0, 1.0])), controller).step(until=8.0)(times)
        axes.plot(times, approximated - exact, label=f"order {order}")
    axes.set_xlabel("time")
    axes.set_ylabel("error of the output")
    axes.legend()
    return figure
