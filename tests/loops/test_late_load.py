"""Settling after a load that enters a running set-point response, against mpmath's dead-time series."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from loops.references import ReferenceLoop
from replicate.loops import PI, PID, Loop, Plant
from replicate.loops.sweep.late_load import settling_after_load

BAND = 0.02
CASES: dict[str, tuple[Plant, list[PID], float]] = {
    "slow beside its delay": (
        Plant([1.0], [1.0, 1.0], dead_time=1.0),
        [PI(k, ki) for k in (0.4, 0.7) for ki in (0.35, 0.5, 0.7)],
        4.0,
    ),
    "quick beside its delay": (
        Plant([1.0], [1.0, 1.0], dead_time=10.0),
        [PI(0.25, 0.045), PI(0.3, 0.06), PI(0.2, 0.05), PI(0.3, 0.03), PI(0.4, 0.08)],
        30.0,
    ),
    "weighted, with a derivative": (
        Plant([2.0], [1.0, 1.2, 1.0], dead_time=0.5),
        [PID(0.2, ki, kd, b=0.0, derivative_filter=0.1) for ki in (0.2, 0.3) for kd in (0.1, 0.2, 0.3)],
        2.5,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_the_response_is_at_the_band_then_and_inside_ever_after(name: str) -> None:
    plant, controllers, load_at = CASES[name]
    found = settling_after_load(plant, controllers, load_at, BAND)
    assert np.isfinite(found).all()
    for c, time in [*zip(controllers, found.tolist(), strict=True)][1::3]:
        num, den = (tuple(map(float, part)) for part in (plant.num, plant.den))
        exact = ReferenceLoop(num, den, plant.dead_time, c.k, c.ki, c.kd, c.b, 0.0, c.derivative_filter)

        def error(t: float, exact: ReferenceLoop = exact) -> float:
            return float(mp.fabs(exact(load_at + t, "y") + exact(t, "load_y") - 1))

        assert error(time) == pytest.approx(BAND, abs=1e-12)
        assert error(time - 1e-4 * plant.dead_time) > BAND
        later = time + plant.dead_time * np.array([0.01, 0.2, 0.5, 1.0, 1.5, 2.2, 3.1])
        assert max(error(float(t)) for t in later) < BAND


def test_it_is_what_the_single_loop_says_in_any_order() -> None:
    plant, controllers, load_at = CASES["slow beside its delay"]
    found = settling_after_load(plant, controllers, load_at)
    for controller, time in zip(controllers, found, strict=True):
        loop = Loop(plant, controller)
        y = loop.respond(load=1.0, load_at=load_at, until=load_at + loop.horizon()).output
        assert time == pytest.approx(y.settling_time(BAND) - load_at, rel=1e-11)
    assert settling_after_load(plant, controllers[::-1], load_at)[::-1] == pytest.approx(found, rel=1e-12)


def test_what_is_left_to_the_single_loop() -> None:
    plant, controllers, load_at = CASES["slow beside its delay"]
    mixed = settling_after_load(plant, [*controllers[:3], PI(9.0, 9.0), *controllers[3:]], load_at)
    assert np.isnan(mixed[3])  # unstable
    assert np.delete(mixed, 3) == pytest.approx(settling_after_load(plant, controllers, load_at), rel=1e-12)
    assert np.isnan(settling_after_load(plant, controllers, load_at + 0.3)).all()  # within a piece
    assert np.isnan(settling_after_load(plant, controllers[:2], load_at)).all()  # too few
    assert np.isnan(settling_after_load(Plant([1.0], [1.0, 2.0, 1.0]), controllers, load_at)).all()  # no dead time
    # a band so wide that it is not left again: settled before the load enters
    assert np.isnan(settling_after_load(plant, controllers, 20.0, 0.9)).all()
