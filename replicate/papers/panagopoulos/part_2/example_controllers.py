"""The two controllers of the supplement's example for 1/(s+1)^4, and the poles of their loops."""

from __future__ import annotations

import numpy as np

from replicate.loops import PID
from replicate.papers.panagopoulos.part_2.processes import G4

CONTROLLERS = {"kd=1": PID(1.00, 0.50, 1.00), "kd=3": PID(1.00, 0.98, 3.00)}


def closed_loop_poles(controller: PID) -> np.ndarray:
    """Return all five poles of the closed loop, real ones first, then pairs by descending frequency."""
    numerator = [controller.kd, controller.k, controller.ki]
    poles = np.roots(np.polyadd(np.append(G4.den, 0.0), np.polymul(numerator, G4.num)))
    return np.asarray(sorted(poles, key=lambda p: (abs(p.imag) > 1e-9, -abs(p), -p.imag)))


def pole_numbers(controller: PID) -> dict[str, float]:
    """Return the real pole, and relative damping and frequency of the two pairs."""
    real, first, _, second, _ = closed_loop_poles(controller)
    numbers = {"p": float(real.real)}
    for n, pole in enumerate((first, second), start=1):
        numbers |= {f"zeta{n}": float(-pole.real / abs(pole)), f"omega{n}": float(abs(pole))}
    return numbers
