"""The sensitivity of a loop over frequency, with its peak."""

import numpy as np
from matplotlib.figure import Figure

from replicate.loops import PI, Loop, Plant


def draw() -> Figure:
    """Draw sensitivity and complementary sensitivity with the exact dead time."""
    loop = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=1.0), PI(k=0.6, ki=0.5))
    frequencies = np.geomspace(0.05, 20.0, 1200)
    transfer = loop(1j * frequencies)
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.subplots()
    axes.loglog(frequencies, np.abs(1.0 / (1.0 + transfer)), label="|S|")
    axes.loglog(frequencies, np.abs(transfer / (1.0 + transfer)), label="|T|")
    peak = loop.sensitivity_peak()
    axes.plot([peak.frequency], [peak.value], "ko", markersize=4, label="$M_s$")
    axes.set_xlabel("frequency")
    axes.set_ylim(0.05, 3.0)
    axes.legend()
    return figure
