"""Step response of a second-order system, for three damping ratios."""

import matplotlib.pyplot as plt
import numpy as np

t = np.linspace(0.0, 15.0, 2001)
fig, ax = plt.subplots()
for zeta in (0.2, 0.5, 0.8):
    w = np.sqrt(1.0 - zeta**2)
    y = 1.0 - np.exp(-zeta * t) * (np.cos(w * t) + zeta / w * np.sin(w * t))
    ax.plot(t, y, label=rf"$\zeta = {zeta}$")
ax.axhline(1.0, color="0.6", linewidth=0.8)
ax.set(xlabel="time", ylabel="output", title="Step response")
ax.legend()
plt.show()
