r"""The set-point weight b of a designed controller: as large as a set-point response without resonance allows.

References: Astrom, Panagopoulos and Hagglund, Automatica 34 (1998), (24) and (25); Panagopoulos, thesis (2000),
paper II, (13).
"""

from __future__ import annotations

import numpy as np

from replicate.loops.controller import PI, PID
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant


def setpoint_weight(plant: Plant, k: float, ki: float, *, at: tuple[float, float] | None = None) -> float:
    """Return the set-point weight b in [0, 1] of a PI controller that makes |G_sp| = 1 at a frequency (25).

    Parameters
    ----------
    plant
        The plant of the loop.
    k, ki
        Gains of the PI controller.
    at
        (frequency, |T| there); by default the peak of the complementary sensitivity, as the paper's text says (24).
    """
    controller = PI(k, ki)
    if controller.k * controller.ki <= 0.0:
        return 0.0
    if at is None:
        peak = Loop(plant, controller).complementary_peak()
        at = (peak.frequency, peak.value)
    return pid_setpoint_weight(controller, *at)


def pid_setpoint_weight(controller: PID, frequency: float, peak: float) -> float:
    """Return the set-point weight b in [0, 1] for which |G_sp| is one where |T| has its peak (13).

    Parameters
    ----------
    controller
        The controller whose gains count.
    frequency, peak
        Frequency and value of the complementary sensitivity peak; a peak at rest puts no bound and gives 1.
    """
    if controller.k * controller.ki <= 0.0:
        return 0.0
    if peak <= 1.0 or frequency == 0.0:
        return 1.0
    size = (controller.k * frequency) ** 2 + (controller.ki - frequency**2 * controller.kd) ** 2
    inside = size - (controller.ki * peak) ** 2
    return min(1.0, float(np.sqrt(inside) / (abs(controller.k) * frequency * peak))) if inside > 0.0 else 0.0
