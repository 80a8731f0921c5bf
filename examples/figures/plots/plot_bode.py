"""Bode diagram of a first-order lag with dead time; saved, not shown."""

import matplotlib.pyplot as plt
import numpy as np

w = np.logspace(-2, 2, 400)
gain = 1.0 / (1.0 + 1j * w)
fig, (magnitude, phase) = plt.subplots(2, 1, sharex=True, layout="constrained")
magnitude.loglog(w, np.abs(gain))
magnitude.set_ylabel("magnitude")
phase.semilogx(w, np.degrees(np.angle(gain) - 0.1 * w))
phase.set(xlabel="frequency", ylabel="phase in degrees")
fig.suptitle("Lag with dead time")
fig.savefig("bode.pdf")
plt.close(fig)
