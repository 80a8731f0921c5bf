"""Largest sensitivity over gain and integral gain, as an image with contours."""

import matplotlib.pyplot as plt
import numpy as np

k, ki = np.meshgrid(np.linspace(0.1, 1.0, 40), np.linspace(0.1, 0.8, 30))
w = np.logspace(-2, 1.5, 300)[:, None, None]
loop = (k + ki / (1j * w)) * np.exp(-1j * w) / (1.0 + 1j * w)
peak = np.abs(1.0 / (1.0 + loop)).max(axis=0)
fig, ax = plt.subplots()
image = ax.imshow(np.clip(peak, 1.0, 3.0), origin="lower", extent=(0.1, 1.0, 0.1, 0.8), aspect="auto")
ax.contour(k, ki, peak, levels=[1.4, 1.6, 2.0], colors="white")
fig.colorbar(image, label="largest sensitivity")
ax.set(xlabel="gain", ylabel="integral gain")
