"""Sweeps: every value is the one of the single loop, and what does not exist is nan with a reason."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial
from importlib.util import find_spec
from typing import Any, cast

import control
import numpy as np
import pandas as pd
import pytest
from scipy.optimize import brentq
from threadpoolctl import threadpool_info, threadpool_limits

from replicate.loops import PI, PID, Loop, LoopError, Plant, Signal, SweepResult, sweep
from replicate.loops.sweep import running
from replicate.loops.sweep.metric_names import ALLOWED
from replicate.loops.sweep.paces import by_pace
from replicate.loops.time_domain.total_variation import total_variation

FOPTD = Plant.foptd(gain=1.0, time_constant=1.0, dead_time=1.0)

#: The single-loop path, spelled out by hand: metrics of a signal, of the loop.
OF_A_SIGNAL: dict[str, Callable[[Signal], Any]] = {
    "overshoot": lambda y: y.overshoot(),
    "peak": lambda y: y.peak().value,
    "peak_time": lambda y: y.peak().time,
    "settling_time": lambda y: y.settling_time(0.02),
    "rise_time": lambda y: y.rise_time(),
    "delay_time": lambda y: y.delay_time(),
    "iae": lambda y: y.iae(),
    "ise": lambda y: y.ise(),
    "ie": lambda y: y.ie(),
    "itae": lambda y: y.itae(),
    "itse": lambda y: y.itse(),
}
OF_A_LOOP: dict[str, Callable[[Loop], Any]] = {
    "rightmost_pole": lambda loop: loop.rightmost_pole(),
    "ms": lambda loop: loop.sensitivity_peak().value,
    "mp": lambda loop: loop.complementary_peak().value,
    "gain_margin": lambda loop: loop.margins().gain,
    "phase_margin": lambda loop: loop.margins().phase,
    "delay_margin": lambda loop: loop.margins().delay,
}
NAMES = [*OF_A_SIGNAL, *(f"load_{name}" for name in OF_A_SIGNAL), "total_variation", "load_total_variation"]
NAMES += OF_A_LOOP


def single(loop: Loop, until: float | None) -> dict[str, Any]:
    """Return what the objects say about one loop, nan where they say nothing."""
    questions: dict[str, Callable[[], Any]] = {name: partial(ask, loop) for name, ask in OF_A_LOOP.items()}
    if loop.is_stable():
        step, load = (loop.respond(setpoint=1.0 - height, load=height, until=until) for height in (0.0, 1.0))
        questions |= {name: partial(ask, step.output) for name, ask in OF_A_SIGNAL.items()}
        questions |= {f"load_{name}": partial(ask, load.output) for name, ask in OF_A_SIGNAL.items()}
        questions["total_variation"] = lambda: total_variation(step.control)
        questions["load_total_variation"] = lambda: total_variation(load.control)
    answers = dict.fromkeys(NAMES, np.nan)
    for name, question in questions.items():
        with suppress(LoopError):
            answers[name] = question()
    return answers


def of_every_kind(seed: int, count: int) -> tuple[list[Plant], list[PID]]:
    """Return random pairs: FOPTD, higher order, integrating, unstable, with and without dead time, slow, undamped."""
    random = np.random.default_rng(seed)
    plants: list[Plant] = []
    controllers: list[PID] = []
    for i in range(count):
        lag, delay, gain = random.uniform(0.3, 3.0), random.uniform(0.3, 2.0), random.uniform(0.2, 3.0)
        poles = random.uniform(0.5, 4.0, 3)
        made = [
            Plant.foptd(1.0, lag, delay),
            Plant([2.0 * np.prod(poles)], np.poly(-poles), delay),
            Plant([1.0], [1.0, 0.0], delay),
            Plant([1.0], [lag, 1.0, 0.0]),
            Plant([2.0], [lag, -1.0], 0.2 * lag * random.uniform(0.0, 1.0)),
            Plant([1.0], [1.0, 0.1, 1.0], delay),
            Plant(np.array([-1.0, 2.0]) * np.prod(poles[:2]), np.poly(-poles[:2])),
            Plant([-1.5], [lag, 1.0], delay),
        ][i % 8]
        ki = random.choice([0.0, 0.3, 1.0]) * gain
        if i % 3 == 2:
            controllers.append(PID(gain, ki, 0.2 * gain, derivative_filter=0.1, b=random.choice([0.0, 1.0])))
        else:
            controllers.append(PI(gain if i % 8 != 7 else -gain, ki if i % 8 != 7 else -ki))
        plants.append(made)
    # slow: a rightmost pole near -0.005, thousands of dead times until it has decayed
    plants.append(Plant.foptd(1.0, 1.0, 0.25))
    controllers.append(PI(1.0, 0.01))
    # undamped: an integrator under integral action alone, and P control of an integrator at the limit w L = pi/2
    plants += [Plant([1.0], [1.0, 0.0]), Plant([1.0], [1.0, 0.0], 1.0)]
    controllers += [PI(0.0, 1.0), PI(0.5 * np.pi)]
    return plants, controllers


@pytest.mark.parametrize("until", [None, 3.0])
def test_every_value_is_that_of_the_single_loop(until: float | None) -> None:
    plants, controllers = of_every_kind(seed=18, count=16)
    result = sweep(plants, controllers, metrics=NAMES, until=until, pairing="pairwise")
    for i, (plant, controller) in enumerate(zip(plants, controllers, strict=True)):
        loop = Loop(plant, controller)
        assert result["stable"][i] == loop.is_stable()
        for name, expected in single(loop, until).items():
            value = result[name][i]
            np.testing.assert_allclose(value, expected, rtol=1e-9, atol=1e-12, err_msg=f"{name} of {loop}")
            assert not np.isnan(value) or result.reason[i]
    assert 4 < np.sum(result["stable"]) < len(plants)  # the sample holds both kinds
    assert not result["stable"][-2:].any()


#: Plants under controllers of one form each, gains varied: what a sweep computes as blocks.
PLANTS_OF_BLOCKS = {
    "first order": FOPTD,
    "slow": Plant.foptd(2.0, 20.0, 0.5),
    "fast": Plant.foptd(1.0, 0.1, 1.0),
    "integrating": Plant([0.5], [1.0, 0.0], 1.0),
    "fourth order": Plant([1.0], np.poly([-1.0] * 4), 0.5),
    "unstable": Plant([2.0], [1.0, -1.0], 0.2),
    "resonant": Plant([1.0], [1.0, 0.4, 1.0], 0.7),
    "zero to the right": Plant([-1.0, 2.0], [1.0, 3.0, 2.0], 0.4),
    "jumps": Plant([1.0, 2.0], [3.0, 1.0], 0.4),
}
FORMS_OF_BLOCKS: dict[str, dict[str, Any]] = {
    "P": {"ki": 0.0},
    "PI": {},
    "I": {"k": 0.0},
    "PID": {"kd": 1.0, "derivative_filter": 0.1},
    "weighted and filtered": {"b": 0.0, "measurement_filter": 0.2, "setpoint_filter": 1.5},
}


@pytest.mark.parametrize(
    ("plant", "form"),
    [
        ("first order", "PI"), ("first order", "weighted and filtered"), ("slow", "PID"), ("fast", "P"), ("fast", "I"),
        ("integrating", "PI"), ("fourth order", "PID"), ("unstable", "PI"), ("resonant", "I"),
        ("zero to the right", "weighted and filtered"), ("jumps", "PI"),
    ],
)  # fmt: skip
def test_a_block_has_the_values_of_the_single_loops(plant: str, form: str) -> None:
    random = np.random.default_rng(2018)
    given = PLANTS_OF_BLOCKS[plant]
    controllers = []
    for _ in range(4):  # fewer go one by one
        k, ki, kd = 10.0 ** random.uniform([-1.0, -1.5, -2.0], [0.5, 0.2, -0.3])
        own = FORMS_OF_BLOCKS[form]
        controllers.append(PID(**{"k": k, "ki": ki, **own, **({"kd": kd} if "kd" in own else {})}))
    result = sweep(given, controllers, metrics=NAMES)
    for i, controller in enumerate(controllers):
        loop = Loop(given, controller)
        assert result["stable"][0, i] == loop.is_stable()
        for name, expected in single(loop, None).items():
            # the time of a peak is known to the square root of how far it rises above its surroundings
            rtol = 1e-7 if name.endswith("peak_time") else 1e-9
            value = result[name][0, i]
            np.testing.assert_allclose(value, expected, rtol=rtol, atol=1e-11, err_msg=f"{name} of {loop}")
            assert not np.isnan(value) or result.reason[0, i]


@pytest.mark.parametrize("until", [2.5, 7.0])
def test_a_block_with_a_horizon_has_the_values_of_the_single_loops(until: float) -> None:
    gains = np.array([[0.5, 0.4], [0.7, 0.05], [1.2, 0.9], [0.2, 0.1], [0.4, 0.6]])
    names = [name for name in NAMES if name not in OF_A_LOOP]
    result = sweep(FOPTD, gains, metrics=names, until=until)
    for i, row in enumerate(gains):
        expected = single(Loop(FOPTD, PI(*row)), until)
        for name in names:
            np.testing.assert_allclose(result[name][0, i], expected[name], rtol=1e-9, atol=1e-12, err_msg=name)
            assert not np.isnan(expected[name]) or name in result.reason[0, i]


def test_a_first_order_loop_has_the_values_of_its_closed_form() -> None:
    # 1/s under k: y = 1 - exp(-kt)
    k = np.array([0.5, 2.0])
    result = sweep(
        Plant([1.0], [1.0, 0.0]), np.column_stack([k, 0.0 * k]), pairing="pairwise",
        metrics=["overshoot", "settling_time", "rise_time", "iae", "ise", "rightmost_pole", "ms", "gain_margin"],
    )  # fmt: skip
    np.testing.assert_allclose(result["settling_time"], np.log(50.0) / k, rtol=1e-10)
    np.testing.assert_allclose(result["rise_time"], np.log(9.0) / k, rtol=1e-10)
    np.testing.assert_allclose(result["iae"], 1.0 / k, rtol=1e-10)
    np.testing.assert_allclose(result["ise"], 0.5 / k, rtol=1e-10)
    np.testing.assert_allclose(result["rightmost_pole"], -k, rtol=1e-12)
    np.testing.assert_array_equal(result["overshoot"], 0.0)
    np.testing.assert_allclose(result["ms"], 1.0)
    assert np.isinf(result["gain_margin"]).all()
    assert (result.reason == "").all()


def test_the_grid_holds_every_controller_on_every_plant() -> None:
    plants = [FOPTD, Plant([1.0], [1.0, 2.0, 1.0])]
    gains = np.array([[0.3, 0.2], [0.6, 0.4], [0.9, 0.6]])
    grid = sweep(plants, gains, metrics="load_ie")
    assert grid["load_ie"].shape == grid.reason.shape == grid.shape == (2, 3)
    np.testing.assert_allclose(grid["load_ie"], np.broadcast_to(1.0 / gains[:, 1], (2, 3)), rtol=1e-9)
    assert sweep(FOPTD, PI(0.3, 0.2), metrics="ms")["ms"].shape == (1, 1)


def test_all_ways_to_give_plants_and_controllers_agree() -> None:
    plants = pd.DataFrame({"gain": [1.0, 2.0], "time_constant": [1.0, 3.0], "dead_time": [1.0, 0.5]}, index=["a", "b"])
    gains = pd.DataFrame({"k": [0.3, 0.5], "ki": [0.2, 0.1]})
    expected = sweep([Plant.foptd(*row) for row in plants.to_numpy()], [PI(0.3, 0.2), PI(0.5, 0.1)], metrics="ms")["ms"]
    for given in (
        plants,
        plants.to_numpy(),
        plants.to_numpy().tolist(),
        np.array([Plant.foptd(*r) for r in plants.to_numpy()]),
    ):
        for tuned in (
            gains,
            gains.to_numpy(),
            [(0.3, 0.2), (0.5, 0.1)],
            np.array([PI(0.3, 0.2), PI(0.5, 0.1)]),
            np.array(["k=0.3,ki=0.2", "k=0.5,ki=0.1"]),
        ):
            np.testing.assert_array_equal(sweep(given, tuned, metrics="ms")["ms"], expected)


def test_a_frame_has_a_row_for_each_loop_with_the_labels_given() -> None:
    plants = pd.DataFrame({"gain": [1.0, 1.0], "time_constant": [1.0, -1.0], "dead_time": [1.0, 5.0]}, index=["a", "b"])
    frame = sweep(plants, [PI(0.3, 0.2)], metrics=["ms", "rightmost_pole"]).to_frame()
    assert list(frame.columns) == ["ms", "rightmost_pole", "stable", "reason"]
    assert frame.index.tolist() == [("a", 0), ("b", 0)]
    assert frame["reason"].tolist() == ["", "the loop is unstable"]
    assert np.isnan(frame["ms"].to_numpy()[1])
    assert frame["rightmost_pole"].to_numpy()[1].real > 0.0
    series = sweep(FOPTD, pd.Series([PI(0.3, 0.2), PI(0.4, 0.2)], index=["x", "y"]), metrics="ms").to_frame()
    assert series.index.tolist() == [(0, "x"), (0, "y")]
    pairs = sweep(plants, PI(0.3, 0.2), metrics="ms", pairing="pairwise").to_frame()
    assert pairs.index.tolist() == [("a", 0), ("b", 0)]


def test_xarray_where_it_is_installed() -> None:
    result = sweep(FOPTD, [PI(0.3, 0.2)], metrics="ms")
    if find_spec("xarray") is None:
        with pytest.raises(LoopError, match="to_xarray needs xarray"):
            result.to_xarray()
        return
    assert result.to_xarray()["ms"].dims == ("plant", "controller")
    levels = pd.MultiIndex.from_tuples([("a", 1), ("a", 2)])
    frame = pd.DataFrame({"k": [0.3, 0.4], "ki": 0.2}, index=levels)
    for pairing, dims in (("grid", ("plant", "controller")), ("pairwise", ("pair",))):
        found = sweep(FOPTD, frame, metrics="ms", pairing=pairing)
        dataset = found.to_xarray()
        assert dataset["ms"].dims == dims
        assert dataset["controller"].to_numpy().tolist() == [("a", 1), ("a", 2)]
        np.testing.assert_array_equal(dataset["ms"], found["ms"])


def test_what_does_not_exist_has_a_reason() -> None:
    result = sweep(FOPTD, [PI(0.5, 0.4), PI(0.5, 1e-3), PI(9.0, 1.0)], metrics=["settling_time", "iae"], until=6.0)
    assert np.isnan(result["settling_time"][0, 1:]).all()
    assert "settling_time: the response has not settled within 0.02" in result.reason[0, 1]
    assert np.isnan(result["iae"][0, 2])
    assert result.reason[0, 2] == "the loop is unstable"
    improper = sweep(Plant([1.0], [1.0], 1.0), PID(0.5, 0.1, kd=1.0), metrics="ms")
    assert not improper["stable"].any()
    assert np.isnan(improper["ms"]).all()
    assert improper.reason[0, 0]


def test_a_block_of_loops_without_a_value_says_why() -> None:
    # an ideal derivative of a pure dead time is improper; a gain above one at high frequency has no rightmost pole
    improper = sweep(Plant([1.0], [1.0], 1.0), [PID(k, 0.2, kd=0.1) for k in (0.1, 0.2, 0.3, 0.4)], metrics="ms")
    assert not improper["stable"].any()
    assert np.char.find(improper.reason.astype(str), "grows without bound").min() >= 0
    neutral = sweep(Plant([2.0, 1.0], [1.0, 1.0], 1.0), [PI(k, 0.1) for k in (1.0, 2.0, 3.0, 4.0)], "rightmost_pole")
    assert np.isnan(neutral["rightmost_pole"]).all()
    assert np.char.find(neutral.reason.astype(str), "rightmost_pole: the loop gain does not fall below").min() >= 0


@pytest.mark.parametrize("until", [None, 3.0])
def test_the_peak_of_a_load_that_only_lowers_the_output_is_at_the_start(until: float | None) -> None:
    plant, gains = Plant.foptd(-2.0, 1.0, 0.5), np.array([[-0.3, -0.2], [-0.35, -0.01], [-0.2, -0.2], [-0.5, -0.4]])
    result = sweep(plant, gains, metrics=["load_peak", "load_peak_time"], until=until)
    for i, row in enumerate(gains):
        peak = Loop(plant, PI(*row)).load_step(until=until).peak()
        assert peak.time == result["load_peak_time"][0, i] == 0.0
        np.testing.assert_allclose([peak.value, result["load_peak"][0, i]], 0.0, atol=1e-12)


def test_a_horizon_far_beyond_rest_changes_nothing() -> None:
    names, gains = ["overshoot", "peak_time", "settling_time", "iae", "load_iae"], np.full((5, 2), [0.6, 0.5])
    natural, far = sweep(FOPTD, gains, metrics=names), sweep(FOPTD, gains, metrics=names, until=1e9)
    for name in names:
        np.testing.assert_allclose(far[name], natural[name], rtol=1e-9)
    assert Loop(FOPTD, PI(0.6, 0.5)).step(until=1e9)(1e9) == pytest.approx(1.0, abs=1e-13)


@pytest.mark.parametrize("metric", ["peak_time", "load_peak_time"])
@pytest.mark.parametrize("until", [None, 400.0])
def test_a_peak_that_lasts_has_the_time_that_the_single_loop_gives(metric: str, until: float | None) -> None:
    # the plant comes to rest at the peak before its output has an effect: two dead times of 66 time constants each
    plant = Plant.foptd(1.3, 1.0, 66.0)
    controllers = [PI(0.4, 0.0), PI(0.3, 0.0), PI(0.2, 0.0), PI(0.1, 0.0)]
    controllers += [PI(0.02, 1e-6), PI(0.03, 1e-6), PI(0.04, 1e-6), PI(0.05, 1e-6)]
    result = sweep(plant, controllers, metrics=metric, until=until)
    loops = [Loop(plant, controller) for controller in controllers]
    responses = [loop.step(until) if metric == "peak_time" else loop.load_step(until) for loop in loops]
    np.testing.assert_allclose(result[metric][0], [y.peak().time for y in responses], rtol=1e-9)


def test_a_horizon_beyond_all_pieces_is_a_horizon() -> None:
    result = sweep(FOPTD, [PI(0.6, ki) for ki in (0.3, 0.35, 0.4, 0.45)], metrics=["ie", "stable"], until=1e300)
    np.testing.assert_allclose(result["ie"][0], [1 / 0.3, 1 / 0.35, 1 / 0.4, 1 / 0.45], rtol=1e-9)  # 1/ki


@pytest.mark.parametrize("count", [1, 5])
@pytest.mark.parametrize("gains", [(1e300, 0.4), (0.5, 1e200), (1e155, 1e155), (1e100, 0.0)])
def test_gains_whose_squares_are_no_numbers_are_refused(gains: tuple[float, float], count: int) -> None:
    result = sweep(FOPTD, [gains] * count, metrics=["stable", "ms", "rightmost_pole", "overshoot"])
    assert not result["stable"].any()
    assert np.isnan(result["ms"]).all()
    assert all("the loop gain is too large to compute with" in reason for reason in result.reason.ravel())


NOT_A_SWEEP: dict[str, tuple[Callable[[], object], str]] = {
    "no plants": (lambda: sweep([], [PI(1.0)]), "the sweep has no plants"),
    "no controllers": (lambda: sweep(FOPTD, np.empty((0, 2))), "the sweep has no controllers"),
    "nan gain": (lambda: sweep(FOPTD, [(1.0, 0.1), (np.nan, 0.1)]), r"controllers\[1\]: the controller's k must be"),
    "negative dead time": (lambda: sweep([(1.0, 1.0, -1.0)], PI(1.0)), r"plants\[0\]: the dead time must be"),
    "unknown metric": (lambda: sweep(FOPTD, PI(1.0), metrics=["overshot"]), "unknown metric 'overshot': allowed"),
    "no metric": (lambda: sweep(FOPTD, PI(1.0), metrics=[]), "metrics must name at least one"),
    "pairs": (lambda: sweep([FOPTD] * 2, [PI(1.0)] * 3, pairing="pairwise"), "not 2 plants and 3 controllers"),
    "metrics are a number": (lambda: sweep(FOPTD, PI(1.0), metrics=cast("Any", 3)), "metrics must be names"),
    "pairing": (lambda: sweep(FOPTD, PI(1.0), pairing="all"), "pairing must be 'grid' or 'pairwise'"),
    "pairings": (lambda: sweep(FOPTD, PI(1.0), pairing=cast("Any", ["grid"])), "pairing must be 'grid' or 'pairwise'"),
    "masked": (
        lambda: sweep(FOPTD, np.ma.array([[0.5, 0.4], [0.5, 0.3]], mask=[[False, True], [False, False]])),
        r"controllers\[0\]: the controller's ki must be a finite number, not nan",
    ),
    "masked texts": (
        lambda: sweep(FOPTD, np.ma.array([["a", "b"]], mask=[[False, True]])), "k must be a finite number, not 'a'",
    ),
    "a system of python-control": (
        lambda: sweep(control.ss([[-1.0]], [[1.0]], [[1.0]], [[0.0]]), PI(1.0)), "Plant.from_control makes one of a",
    ),
    "band": (lambda: sweep(FOPTD, PI(1.0), band=0.0), "the settling band must be"),
    "until": (lambda: sweep(FOPTD, PI(1.0), until=np.nan), "the horizon until must be"),
    "flat array": (lambda: sweep(FOPTD, np.array([1.0, 2.0])), r"one row for each, shape \(n, numbers\), not \(2,\)"),
    "number": (lambda: sweep(FOPTD, 1.0), "the controllers of a sweep must be"),
    "column": (lambda: sweep(FOPTD, pd.DataFrame({"k": [1.0], "Ti": [2.0]})), "no column Ti: allowed are k, ki"),
    "a plant's column misspelt": (
        lambda: sweep(pd.DataFrame({"gain": [1.0], "time_constant": [1.0], "deadtime": [5.0]}), PI(0.5)),
        r"plants\[0\]: a table of plants has the columns .*, not gain, time_constant, deadtime",
    ),
    "a column beside plants": (
        lambda: sweep(pd.DataFrame({"plant": ["1/(s+1)"], "dead_time": [3.0]}), PI(0.5)), "not plant, dead_time",
    ),
    "a column beside controllers": (
        lambda: sweep(FOPTD, pd.DataFrame({"controller": ["k=1"], "k": [3.0]})), "has no column controller: .* alone",
    ),
    "a mapping": (lambda: sweep({"gain": 1.0}, PI(1.0)), "the plants of a sweep must be"),
    "not asked for": (lambda: sweep(FOPTD, PI(0.5), metrics="ms")["mp"], "the sweep has no metric 'mp'"),
    "several names": (
        lambda: sweep(FOPTD, PI(0.5), metrics="ms")[cast("Any", ["ms"])], r"the sweep has no metric \['ms'\]",
    ),
    "integral action alone": (lambda: sweep(FOPTD, pd.DataFrame({"ki": [1.0]})), "controllers needs a column k"),
}  # fmt: skip


@pytest.mark.parametrize("wrong", NOT_A_SWEEP)
def test_what_is_not_a_sweep_says_so_in_one_line(wrong: str) -> None:
    call, message = NOT_A_SWEEP[wrong]
    with pytest.raises(LoopError, match=message) as caught:
        call()
    assert "\n" not in str(caught.value)


def test_the_names_promised_are_allowed() -> None:
    assert {*NAMES, "stable"} <= set(ALLOWED)
    result = sweep(FOPTD, PI(0.5), metrics="stable")
    assert isinstance(result, SweepResult)
    assert "stable" in result
    assert "ms" not in result


def test_a_sweep_uses_one_thread_and_leaves_their_number_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    def threads() -> set[int]:
        return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}

    seen: list[set[int]] = []
    compute = running._compute

    def watched(*given: Any) -> None:
        seen.append(threads())
        compute(*given)

    monkeypatch.setattr(running, "_compute", watched)
    with threadpool_limits(2, user_api="blas"):
        before = threads()
        sweep(FOPTD, np.array([[0.5, 0.4], [0.6, 0.4]]), metrics="overshoot")
        assert seen == [{1}]
        assert threads() == before


@pytest.mark.parametrize(
    ("plant", "form"),
    [
        (Plant([1.0], [1.0, 1.0]), {"ki": 0.0}),
        (Plant([2.0], [1.0, 3.0, 1.0]), {}),
        (Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0]), {"kd": 0.4, "derivative_filter": 0.05}),
        (Plant([1.0], [1.0, 1.0, 0.0]), {"b": 0.3, "measurement_filter": 0.2, "setpoint_filter": 1.5}),
        (Plant([-1.0, 2.0], [1.0, 3.0, 2.0]), {"k": 0.0}),
        (Plant([1.0], np.polymul([200.0, 1.0], [1.0, 0.2, 1.0])), {"ki": 5e-4}),
    ],
    ids=[
        "first order, P",
        "second order, PI",
        "fourth order, PID",
        "integrating, filtered",
        "zero to the right, I",
        "slow and resonant, PI",
    ],
)
def test_a_block_without_dead_time_has_the_values_of_the_single_loops(plant: Plant, form: dict[str, Any]) -> None:
    controllers = [PID(**{"k": 0.5 * (1.0 + 0.02 * i), "ki": 0.2 * (1.0 + 0.03 * i), **form}) for i in range(4)]
    gains = np.array([[c.k, c.ki, c.kd, c.b] for c in controllers]).T
    ((places, _),) = by_pace(plant, controllers[0], (gains[0], gains[1], gains[2], gains[3]))
    assert places.size == 4  # they go together
    result = sweep(plant, controllers, metrics=NAMES)
    for i, controller in enumerate(controllers):
        for name, expected in single(Loop(plant, controller), None).items():
            np.testing.assert_allclose(result[name][0, i], expected, rtol=1e-9, atol=1e-12, err_msg=name)


def test_slow_modes_of_a_block_without_dead_time_have_the_integrals_of_their_closed_form(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # 1/(s (s + 1)) under k: E = (s + 1)/(s^2 + s + k), e > 0; its integrals are values of E, -E' and Parseval's
    k = np.array([1e-2, 3e-3, 1e-3, 1e-4, 1e-6])
    monkeypatch.delattr(running, "loop_metrics")  # they go together
    found = sweep(Plant([1.0], [1.0, 1.0, 0.0]), np.column_stack([k, 0.0 * k]), metrics=["iae", "itae", "ise"])
    np.testing.assert_allclose(found["iae"][0], 1.0 / k, rtol=1e-9)
    np.testing.assert_allclose(found["itae"][0], (1.0 - k) / k**2, rtol=1e-9)
    np.testing.assert_allclose(found["ise"][0], (1.0 + k) / (2.0 * k), rtol=1e-9)


def test_sensitivity_that_only_tends_to_one_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    # S = s/(s + k + ki/s) with k^2 > 2 ki: |S|^2 = x^2/(x^2 + (k^2 - 2 ki) x + ki^2) < 1, with x = w^2
    monkeypatch.delattr(running, "loop_metrics")
    gains = np.array([[2.0, 0.1], [2.1, 0.2], [2.2, 0.5], [2.3, 1.0]])
    np.testing.assert_array_equal(sweep(Plant([1.0], [1.0, 0.0]), gains, metrics="ms")["ms"], 1.0)


def test_loops_without_dead_time_are_grouped_by_their_pace() -> None:
    gains = 10.0 ** np.repeat([-1.0, 1.0], 5)
    groups = list(by_pace(Plant([1.0], [1.0, 1.0]), PI(1.0), (gains, 0.0 * gains, 0.0 * gains, gains**0.0)))
    assert sorted(places.tolist() for places, _ in groups) == [[0, 1, 2, 3, 4], [5, 6, 7, 8, 9]]
    assert groups[0][1].time != groups[1][1].time


def test_truth_values_are_no_gains() -> None:
    for given in (np.array([[True, False]]), pd.DataFrame({"k": [True], "ki": [0.1]}), [(True, False)]):
        with pytest.raises(LoopError, match=r"k must be a finite number, not (np\.)?True"):
            sweep(FOPTD, given, metrics="ms")


def test_the_peak_of_a_narrow_resonance_is_that_of_its_closed_form() -> None:
    # S of 1/(s^2 + c s + 1) under k: |S|^2 = ((1 - x)^2 + c^2 x)/((1 + k - x)^2 + c^2 x) with x = w^2, largest at a
    # root of the quadratic that its derivative leaves
    c, gains = 2e-3, np.array([0.01, 0.1, 0.3, 1.0, 3.0])
    expected = []
    for k in gains:
        n, d = np.poly1d([1.0, c**2 - 2.0, 1.0]), np.poly1d([1.0, c**2 - 2.0 * (1.0 + k), (1.0 + k) ** 2])
        x = (n.deriv() * d - n * d.deriv()).roots.real.max()
        expected.append(np.sqrt(n(x) / d(x)))
    plant = Plant([1.0], [1.0, c, 1.0])
    found = sweep(plant, np.column_stack([gains, 0.0 * gains]), metrics="ms")["ms"][0]
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_two_integrators_leave_no_integrated_error_however_slow_their_last_mode_is() -> None:
    plant = Plant([0.3], [1.0, 0.0], dead_time=2.0)
    gains = np.array([[0.4, 1e-7], [0.3, 2e-7], [0.15, 3e-8], [0.6, 2e-8], [0.5, 1e-6]])
    found = sweep(plant, gains, metrics=["ie", "iae", "itae"])
    np.testing.assert_allclose(found["ie"][0], 0.0, atol=1e-9 * found["iae"].max())
    for i, (k, ki) in enumerate(gains):
        y = Loop(plant, PI(k, ki)).step(until=4000.0)
        # e changes its sign once, E(0) = 0 and -E'(0) = -1/(0.3 ki): both integrals follow from what is before
        turn = brentq(lambda t, y=y: y(t) - 1.0, 30.0, 4000.0)
        before = Loop(plant, PI(k, ki)).step(until=turn)
        expected = [2.0 * before.iae(), 1.0 / (0.3 * ki) + 2.0 * before.itae()]
        np.testing.assert_allclose([found["iae"][0, i], found["itae"][0, i]], expected, rtol=1e-10)


def test_an_oscillation_that_a_dead_time_sees_little_of_has_its_moment() -> None:
    # over a dead time the last mode turns by a hundredth of a period: a residual moves its coefficient far
    plant = Plant([0.0035], [1.0, 1.55, 0.5, 0.057, 0.0021], dead_time=0.355)
    gains = np.column_stack([0.32 * np.linspace(0.98, 1.02, 4), np.full(4, 0.0314)])
    found = sweep(plant, gains, metrics=["iae", "itae"])
    for i, row in enumerate(gains):
        y = Loop(plant, PI(*row)).step()
        np.testing.assert_allclose([found["iae"][0, i], found["itae"][0, i]], [y.iae(), y.itae()], rtol=1e-9)


def test_loops_whose_integral_action_is_slow_stay_together(monkeypatch: pytest.MonkeyPatch) -> None:
    # a real mode leads, and others, an oscillation among them, are known beside it
    plant, gains = Plant.foptd(1.0, 10.0, 1.0), np.column_stack([np.linspace(3.6, 6.4, 6), np.linspace(0.8, 0.45, 6)])
    expected = [Loop(plant, PI(*row)).step() for row in gains]
    monkeypatch.delattr(running, "loop_metrics")
    found = sweep(plant, gains, metrics=["iae", "ise", "itae", "itse", "settling_time", "ie", "overshoot"])
    for name in found.metrics:
        values = [getattr(y, name)() for y in expected]
        np.testing.assert_allclose(found[name][0], values, rtol=1e-9, err_msg=name)


def test_load_responses_that_end_away_from_zero_go_together_and_the_others_have_no_relative_metrics(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delattr(running, "loop_metrics")
    gains = np.array([[0.5, 0.0], [1.5, 0.0], [2.0, 0.0], [2.5, 0.0]])
    result = sweep(
        Plant([1.0], [1.0, 1.0, 1.0]), gains, metrics=["load_overshoot", "load_delay_time", "load_rise_time"]
    )
    # y/d = 1/(s^2 + s + 1 + k)
    decay, frequency = 0.5, np.sqrt(0.75 + gains[:, 0])
    np.testing.assert_allclose(result["load_overshoot"][0], np.exp(-np.pi * decay / frequency), rtol=1e-10)
    for place, w in enumerate(frequency):

        def share(t: float, w: float = w) -> float:
            return float(1.0 - np.exp(-decay * t) * (np.cos(w * t) + decay / w * np.sin(w * t)))

        low, half, high = (brentq(lambda t, at=at: share(t) - at, 0.0, np.pi / w, xtol=1e-15) for at in (0.1, 0.5, 0.9))
        assert result["load_delay_time"][0, place] == pytest.approx(half, rel=1e-10)
        assert result["load_rise_time"][0, place] == pytest.approx(high - low, rel=1e-10)

    integral = sweep(FOPTD, [(0.3, 0.2), (0.4, 0.3), (0.5, 0.2), (0.6, 0.3)], metrics=["load_rise_time", "load_iae"])
    assert np.isnan(integral["load_rise_time"]).all()
    assert np.isfinite(integral["load_iae"]).all()
    assert (integral.reason == "load_rise_time: rise time is relative to the final value, which is 0 here").all()
