"""Nyquist curve and the circle that it must not enter; and the same loop on polar axes."""

import matplotlib.pyplot as plt
import numpy as np

w = np.logspace(-1, 2, 3000)
loop = (0.6 + 0.5 / (1j * w)) * np.exp(-1j * w) / (1.0 + 1j * w)
fig, ax = plt.subplots()
ax.plot(loop.real, loop.imag)
ax.add_patch(plt.Circle((-1.0, 0.0), 1.0 / 1.6, fill=False, linestyle="--"))
ax.set(xlim=(-2, 1), ylim=(-2, 1), aspect="equal", xlabel="real part", ylabel="imaginary part")
fig, ax = plt.subplots(subplot_kw={"projection": "polar"})
ax.plot(np.angle(loop), np.abs(loop))
ax.set_rmax(2.0)
plt.show()
