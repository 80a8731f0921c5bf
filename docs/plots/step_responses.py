"""Responses of one loop to steps of the set-point and of the load."""

import numpy as np
from matplotlib.figure import Figure

from replicate.loops import PI, Loop, Plant


def draw() -> Figure:
    """Draw both responses, the peak and the settling time of the first."""
    loop = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=1.0), PI(k=0.6, ki=0.5))
    step, load = loop.step(until=15.0), loop.load_step(until=15.0)
    times = np.linspace(0.0, 15.0, 600)
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.subplots()
    axes.plot(times, step(times), label="set-point step")
    axes.plot(times, load(times), label="load step")
    peak = step.peak()
    axes.plot([peak.time], [peak.value], "ko", markersize=4, label="peak")
    axes.axvline(step.settling_time(), color="0.5", linewidth=0.8, linestyle="--", label="settled within 2 %")
    axes.set_xlabel("time")
    axes.set_ylabel("output")
    axes.legend()
    return figure
