"""The responses of one plant under many controllers, which move through time together."""

from __future__ import annotations

from collections.abc import Sequence

from replicate.loops import checks
from replicate.loops.controller import PID
from replicate.loops.loop import Loop
from replicate.loops.one_thread import one_thread
from replicate.loops.plant import Plant
from replicate.loops.time_domain.responses import responses
from replicate.loops.time_domain.signal import Signal
from replicate.loops.units import Units


def step_responses(
    plant: Plant, controllers: Sequence[PID], until: float, *, setpoint: float = 1.0, load: float = 0.0
) -> list[Signal]:
    """Return the outputs of one rational plant under many controllers that differ only in their gains.

    With dead time all loops advance together: one matrix product per dead-time interval for the whole sweep.

    Parameters
    ----------
    plant
        A rational plant.
    controllers
        The controllers.
    until
        Time until which the responses are computed.
    setpoint, load
        Heights of the steps of the set point and, at the plant input, of the load.

    Raises
    ------
    LoopError
        If the controllers are none, or differ in more than k, ki, kd and b.
    """
    checks.instance("the plant", plant, Plant, "a Plant")
    controllers = checks.several("the controllers", controllers, "a list of PI or PID")
    for controller in controllers:
        checks.instance("each controller", controller, PID, "a PI or PID")
    if not controllers:
        return []
    until = checks.positive("the horizon until", until, allowed="a finite time > 0")
    units = Units.of(plant, controllers[0])
    with one_thread():
        found = responses(
            units.plant(plant), [units.controller(c) for c in controllers], until / units.time,
            setpoint=setpoint, load=load * units.gain, unit=units.time,
        )  # fmt: skip
    signals = []
    for controller, (breaks, y, _) in zip(controllers, found, strict=True):
        loop = Loop(plant, controller)
        final, _ = loop.steady_state(setpoint, load)
        signals.append(Signal(breaks * units.time, y, final=final, stable=loop.is_stable))
    return signals
