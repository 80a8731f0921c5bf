"""The Nyquist curves of both loops, beside the point that they must not encircle."""

import numpy as np
from matplotlib.figure import Figure

from skogestad2003 import paper
from skogestad2003.table_1 import exact_loops


@paper.figure(
    "nyquist",
    "How close the loops are to the critical point",
    alt="Nyquist curves of both loops; that of the integrating process passes nearer to the point minus one.",
    size=(4.2, 3.4),
)
def nyquist(fig: Figure) -> None:
    """Draw both loop transfer functions on the imaginary axis."""
    axes = fig.subplots()
    frequencies = np.geomspace(0.2, 20.0, 400)
    for name, loop in exact_loops().items():
        values = loop(1j * frequencies)
        axes.plot(values.real, values.imag, label=name)
    axes.plot([-1.0], [0.0], "k+", label="critical point")
    axes.set_xlim(-1.6, 0.6)
    axes.set_ylim(-1.6, 0.4)
    axes.set_aspect("equal")
    axes.set_xlabel("real part")
    axes.set_ylabel("imaginary part")
    axes.legend()
