"""Metrics that the package asks of many loops for itself, against mpmath and the single loop."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from replicate.loops import PI, PID, Loop, LoopError, Plant, sweep
from replicate.loops.sweep.metric_names import ALLOWED, OWN
from replicate.loops.sweep.pairs import pair_metrics

FOUR = Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0])
LATE = Plant([1.0], [1.0, 3.0, 3.0, 1.0], dead_time=5.0)
SLOW = Plant([2.0], [1.0, 0.0], dead_time=3e-3)  # in another unit of time
ADVERSE = Plant([-2.0, 1.0], [1.0, 3.0, 3.0, 1.0])
GAINS: dict[Plant, list[PID]] = {
    FOUR: [PID(k, ki, kd) for k in (0.8, 1.1) for ki in (0.3, 0.5) for kd in (0.5, 1.5)],
    LATE: [PI(k, ki) for k in (0.1, 0.3, 0.5) for ki in (0.08, 0.12)],
    SLOW: [PI(k, ki) for k in (40.0, 60.0, 80.0) for ki in (500.0, 3000.0)],
    ADVERSE: [PID(k, ki, 0.2) for k in (0.2, 0.4) for ki in (0.1, 0.2)],
}
PAIRS = [(plant, controller) for plant, own in GAINS.items() for controller in own]


def transfer(plant: Plant, c: PID, w: mp.mpf) -> mp.mpc:
    s = mp.mpc(0, w)
    rational = mp.polyval([mp.mpf(x) for x in plant.num], s) / mp.polyval([mp.mpf(x) for x in plant.den], s)
    return (mp.mpf(c.k) + mp.mpf(c.ki) / s + mp.mpf(c.kd) * s) * rational * mp.exp(-s * mp.mpf(plant.dead_time))


def exact_peak(plant: Plant, c: PID, *, complementary: bool) -> tuple[float, float]:
    """Return frequency and value of the highest of all peaks, polished at 30 digits; at rest |T| is 1 and S is 0."""

    def height(w: mp.mpf) -> mp.mpf:
        value = transfer(plant, c, w)
        return mp.fabs(value / (1 + value) if complementary else 1 / (1 + value))

    with mp.workdps(30):
        unit = plant.dead_time or 1.0
        grid = np.geomspace(1e-3, 30.0, 1000) / unit
        heights = [float(height(mp.mpf(w))) for w in grid]
        top = int(np.argmax(heights))
        if complementary and heights[top] <= 1.0:
            return 0.0, 1.0
        around = (mp.mpf(grid[top - 1]), mp.mpf(grid[top + 1]))
        w = mp.findroot(lambda w: mp.diff(height, w), around, solver="anderson", tol=1e-22)
        return float(w), float(height(w))


@pytest.mark.parametrize("complementary", [False, True])
def test_peaks_of_many_loops_are_where_mpmath_finds_them(complementary: bool) -> None:
    name = "mp" if complementary else "ms"
    found = pair_metrics(PAIRS, [f"{name}_frequency", name])
    for (plant, controller), one in zip(PAIRS, found, strict=True):
        assert one == pytest.approx(exact_peak(plant, controller, complementary=complementary), rel=1e-12)


def test_a_peak_at_rest_and_one_of_a_single_loop() -> None:
    plant = Plant.foptd(gain=1.0, time_constant=1.0, dead_time=0.2)
    loops = [(plant, PI(0.2, ki)) for ki in (0.1, 0.15, 0.2, 0.25)] + [(FOUR, PID(0.8, 0.3, 0.5))]
    *together, alone = pair_metrics(loops, ["mp_frequency", "mp"])
    assert together == [(0.0, 1.0)] * 4
    assert alone == pytest.approx(exact_peak(*loops[-1], complementary=True), rel=1e-12)


@pytest.mark.parametrize("band", [0.02, 0.05, 0.3])
def test_the_last_time_above_a_level_is_that_of_the_dense_response(band: float) -> None:
    found = pair_metrics(PAIRS, ["load_last_above", "load_settling_time"], band)
    below = 0
    for (plant, controller), one in zip(PAIRS, found, strict=True):
        y = Loop(plant, controller).load_step()
        t = np.linspace(0.0, y.horizon, 200_001)
        values = y(t)
        assert one
        for time, outside in zip(one, (values > band, np.abs(values) > band), strict=True):
            last = t[np.nonzero(outside)[0][-1]] if outside.any() else 0.0
            assert time == pytest.approx(last, abs=1.01 * t[1])
        below += one[0] < one[1]
        assert one[0] == pytest.approx(y.last_crossing(band), rel=1e-11, abs=1e-13)
    assert below or band > 0.1  # some swing below zero last, and there the two differ


def test_loops_that_lack_a_metric_have_none_and_harm_no_other() -> None:
    unstable = (FOUR, PID(50.0, 10.0))
    loops = [*PAIRS[:5], unstable, *PAIRS[5:]]
    found = pair_metrics(loops, ["load_iae", "ms"])
    assert found[5] is None
    others = np.array([one for one in found if one])
    assert others == pytest.approx(np.array(pair_metrics(PAIRS, ["load_iae", "ms"])), rel=1e-12)
    assert pair_metrics([], ["ms"]) == []


def test_what_the_package_asks_for_itself_is_not_offered() -> None:
    assert not set(OWN) & set(ALLOWED)
    for name in OWN:
        with pytest.raises(LoopError, match="unknown metric"):
            sweep(FOUR, PID(0.8, 0.3, 0.5), metrics=[name])
