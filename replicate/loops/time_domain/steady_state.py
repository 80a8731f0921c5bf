"""The values that output and control signal of a stable loop approach."""

from __future__ import annotations

import numpy as np

from replicate.loops.controller import PID
from replicate.loops.plant import Plant

NAN = float("nan")


def steady_state(
    plant: Plant, controller: PID, setpoint: float, load: float, *, inner_gain: float = 0.0
) -> tuple[float, float]:
    """Return output and control signal at rest, ``nan`` where there is none.

    Parameters
    ----------
    setpoint, load
        Heights of the steps of the set-point and, at the plant input, of the load.
    inner_gain
        Steady-state gain of what a predictor adds to the measurement, from the control signal.
    """
    gain = plant.gain
    (num, den), (filter_num, filter_den) = (
        controller.setpoint_filter_polynomials(),
        controller.measurement_filter_polynomials(),
    )
    reference, measured = setpoint * float(num[-1] / den[-1]), float(filter_num[-1] / filter_den[-1])
    blocked = plant.num[-1] == 0.0 if plant.is_rational else gain == 0.0
    k = controller.k
    if controller.ki:
        if blocked or not measured:
            return NAN, NAN
        seen = reference / measured  # output + inner_gain * control signal
        if np.isinf(gain) or not inner_gain:
            output = seen + (inner_gain * load if inner_gain else 0.0)
            return output, (output / gain if gain else NAN) - load
        control = (seen - gain * load) / (gain + inner_gain)
        return gain * (control + load), control
    if np.isinf(gain):  # the integrator's input vanishes: u = -load
        output = (controller.b * reference + load / k) / measured if k and measured else NAN
        return output + inner_gain * load, -load
    if inner_gain:
        control = k * (controller.b * reference - measured * gain * load) / (1.0 + k * measured * (gain + inner_gain))
        return gain * (control + load), control
    output = gain * (k * controller.b * reference + load) / (1.0 + gain * k * measured)
    return output, k * (controller.b * reference - measured * output)
