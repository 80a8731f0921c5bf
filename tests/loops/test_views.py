"""What plants, controllers, loops and signals are shown as, and when two are equal."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from replicate.loops import PI, PID, Loop, Plant
from replicate.loops.inputs import Ramp
from replicate.loops.notation import parse_controller, parse_plant

LOOP = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5))
PLANTS = (
    Plant.foptd(1.0, 1.0, 1.0),
    Plant.foptd(1.0, 1.0, 2.0),
    Plant([1.0], [1.0, 2.0], 1.0),
    Plant.from_terms([([1.0], [1.0], 1.0), ([0.5], [1.0], 2.0)]),
    Plant.from_terms([([1.0], [1.0, 0.0], 0.0), ([-1.0], [1.0, 0.0], 1.0)]),
    parse_plant("e^{-sqrt(s)}"),
    parse_plant("e^{-sqrt(s)}e^{-s}"),
)


def test_plants_are_equal_when_they_are_the_same_transfer_function_written_alike() -> None:
    for i, plant in enumerate(PLANTS):
        assert [plant == other for other in PLANTS] == [i == j for j in range(len(PLANTS))]
    assert Plant([2.0], [2.0, 2.0], 1.0) == Plant([1.0], [1.0, 1.0], 1)
    assert hash(Plant([2.0], [2.0, 2.0], 1.0)) == hash(Plant([1.0], [1.0, 1.0], 1))
    assert Plant([1.0], [1.0, 1.0]) != "1/(s+1)"
    assert len(set(PLANTS)) == len(PLANTS)


@pytest.mark.parametrize("plant", PLANTS)
def test_a_plant_comes_back_from_its_notation(plant: Plant) -> None:
    assert parse_plant(plant.notation()) == plant
    assert plant._repr_html_().startswith("<code>")


def test_controllers_are_equal_when_their_parameters_are() -> None:
    assert PI(0.6, 0.5) == PI(0.6, 0.5, b=1.0)
    assert PI(0.6, 0.5) != PI(0.6, 0.5, b=0.5)
    assert hash(PID(1.0, 2.0, 3.0)) == hash(PID(1.0, 2.0, 3.0))
    assert parse_controller(PID(1.0, 2.0, 3.0, c=0.1).notation()) == PID(1.0, 2.0, 3.0, c=0.1)


def test_the_text_of_a_controller_makes_it() -> None:
    for controller in (PI(0.6, 0.5, b=0.5), PID(1.0, 0.0, 0.2, derivative_filter=0.1), PI(2.0)):
        assert eval(repr(controller), {"PI": PI, "PID": PID}) == controller  # noqa: S307  -- its own repr
    assert repr(PI(0.6, 0.5)) == "PI(k=0.6, ki=0.5)"
    assert "<th>k</th><td>0.6</td>" in PI(0.6, 0.5)._repr_html_()


def test_loops_are_equal_when_their_parts_are() -> None:
    assert Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5)) == LOOP
    assert Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.4)) != LOOP
    assert len({LOOP, Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5))}) == 1
    assert LOOP._repr_html_().startswith("<table>")


def test_the_methods_of_a_loop_are_the_functions_of_their_files() -> None:
    w = np.array([0.1, 1.0, 3.0])
    L = LOOP(1j * w)
    np.testing.assert_allclose(LOOP.nyquist(w), L, rtol=1e-15)
    np.testing.assert_allclose(LOOP.bode(w).magnitude, np.abs(L), rtol=1e-15)
    np.testing.assert_allclose(LOOP.S(1j * w), 1 / (1 + L), rtol=1e-13)
    np.testing.assert_allclose(LOOP.T(1j * w), L / (1 + L), rtol=1e-13)
    np.testing.assert_allclose(LOOP.PS(1j * w), LOOP.plant(1j * w) / (1 + L), rtol=1e-13)
    np.testing.assert_allclose(LOOP.CS(1j * w), LOOP.controller.feedback(1j * w) / (1 + L), rtol=1e-13)
    assert LOOP.summary().ms == LOOP.sensitivity_peak()
    np.testing.assert_allclose(LOOP.to_control(pade=3).dcgain(), 1.0, rtol=1e-12)
    np.testing.assert_allclose(LOOP.plant.to_control(pade=3).dcgain(), 1.0, rtol=1e-12)
    assert LOOP.controller.to_control().num[0][0].tolist() == [0.6, 0.5]
    ramp = LOOP.respond_to(setpoint=Ramp(1.0), until=60.0).output
    assert float(ramp(60.0)) == pytest.approx(58.0, abs=1e-9)


def test_the_methods_of_a_signal() -> None:
    y = LOOP.step(until=20.0)
    assert y.summary().overshoot == y.overshoot()
    assert y.summary(band=0.05).settling_time == y.settling_time(0.05)
    frame = y.to_frame([1.0, 2.0])
    pd.testing.assert_frame_equal(frame, pd.DataFrame({"value": y([1.0, 2.0])}, index=pd.Index([1.0, 2.0], name="t")))
    assert y.total_variation() >= 1.0
    assert repr(y).startswith("<Signal on [0, 20]")
    assert y._repr_html_().startswith("<table>")
