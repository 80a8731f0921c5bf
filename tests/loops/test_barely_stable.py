"""Sweeps across the limit of stability: loops that ring for thousands of periods have their values in closed form."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from replicate.loops import PI, Loop, LoopError, Plant, sweep
from replicate.loops.sweep import running
from replicate.loops.sweep.last_modes import LastModes

BAND = 0.02


def test_an_undamped_second_order_loop_has_the_values_of_its_closed_form(monkeypatch: pytest.MonkeyPatch) -> None:
    # 1 / (s (s + 2 z)) under k = 1: natural frequency 1, damping z
    monkeypatch.setattr(running, "loop_metrics", lambda *_: pytest.fail("a loop was asked alone"))
    for damping in (1e-2, 1e-3, 1e-4, 1e-5):
        plant = Plant([1.0], [1.0, 2.0 * damping, 0.0])
        k = [1.1, 1.2, 1.3, 1.4]
        found = sweep(plant, [(gain, 0.0) for gain in k], metrics=["overshoot", "peak_time", "settling_time", "iae"])
        for place, gain in enumerate(k):
            frequency = np.sqrt(gain - damping**2)
            fall = np.exp(-damping * np.pi / frequency)  # from one extremum of the error to the next
            assert found["overshoot"][0, place] == pytest.approx(fall, rel=1e-10)
            assert found["peak_time"][0, place] == pytest.approx(np.pi / frequency, rel=1e-10)
            phase = np.arctan(damping / frequency)  # e = exp(-z t) cos(w t - phase) / cos(phase)
            last = np.floor(np.log(BAND) / np.log(fall))
            start, width = last * np.pi / frequency, BAND / fall**last

            def excess(t: float, frequency: float = frequency, phase: float = phase, z: float = damping) -> float:
                return float(np.exp(-z * t) * np.cos(frequency * t - phase) / np.cos(phase))

            low, high = 0.0, 0.5 * np.pi / frequency + phase / frequency
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if excess(middle) > width else (low, middle)
            assert found["settling_time"][0, place] == pytest.approx(start + low, rel=1e-10)
            first = (np.pi / 2.0 + phase) / frequency  # the first zero of the error; between zeros e is a wave less

            def area(t: float, frequency: float = frequency, phase: float = phase, z: float = damping) -> float:
                wave = np.exp((-z + 1j * frequency) * t - 1j * phase) / (-z + 1j * frequency)
                return float(wave.real / np.cos(phase))

            begin, half = area(first) - area(0.0), area(first) - area(first + np.pi / frequency)
            assert found["iae"][0, place] == pytest.approx(begin + half / (1.0 - fall), rel=1e-9)


def test_a_dead_time_that_leaves_little_damping_costs_no_marching(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "loop_metrics", lambda *_: pytest.fail("a loop was asked alone"))
    limit = _largest_stable_gain()
    gains = [limit * (1.0 - distance) for distance in (1e-2, 1e-3, 1e-4, 1e-5)]
    plant = Plant([1.0], [1.0, 1.0], dead_time=1.0)
    found = sweep(plant, [(k, 0.5 * k) for k in gains], metrics=["settling_time", "iae"])
    assert found["stable"].all()
    mp.mp.dps = 40
    for place, k in enumerate(gains):
        pole, residue = _slowest_mode(k, 0.5 * k)
        decay, frequency = -pole.real, pole.imag
        # the last extremum of the error outside the band, and where it leaves the band
        phase = mp.arg(residue * pole)
        number = mp.floor((mp.log(abs(residue) / BAND) / decay) * frequency / mp.pi)
        while True:
            extremum = (mp.pi / 2 - phase + number * mp.pi) / frequency
            if abs(mp.re(residue * mp.exp(pole * extremum))) > BAND:
                break
            number -= 1
        quarter = mp.pi / 2 / frequency
        leaves = mp.findroot(
            lambda t, c=residue, p=pole: abs(mp.re(c * mp.exp(p * t))) - BAND,
            (extremum + quarter / 10, extremum + quarter * 0.95), solver="anderson",
        )  # fmt: skip
        assert found["settling_time"][0, place] == pytest.approx(float(leaves), rel=1e-9)
        # all other modes have decayed by t = 120: from the next zero on each half-wave is a fraction of the last
        zero = (mp.pi / 2 - mp.arg(residue)) / frequency
        zero += mp.ceil((120 - zero) * frequency / mp.pi) * mp.pi / frequency
        end = residue * mp.exp(pole * zero) / pole
        fall = mp.exp(-decay * mp.pi / frequency)
        rest = abs(mp.re(end)) * (1 + fall) / (1 - fall)
        early = Loop(plant, PI(k, 0.5 * k)).respond(until=float(zero)).output.iae()
        assert found["iae"][0, place] == pytest.approx(early + float(rest), rel=1e-9)


def test_modes_say_where_they_are_highest_and_when_they_leave_a_band() -> None:
    random = np.random.default_rng(5)
    count, width = 60, np.full(60, 0.1)
    pole = -(10.0 ** random.uniform(-1.5, 1.0, count)) + 1j * 10.0 ** random.uniform(-1.0, 1.0, count)
    modes = LastModes.none(count)
    modes.found[:] = True
    modes.start[:] = 3.0
    modes.pole[0], modes.coefficient[0] = pole, random.normal(size=count) + 1j * random.normal(size=count)
    height, at = modes.summit()
    both, above = modes.last_outside(width), modes.last_outside(width, one_sided=True)
    for i in range(count):
        c, p = complex(modes.coefficient[0, i]), complex(pole[i])
        step = 0.01 / abs(p)
        later = np.arange(0.0, 10.0 / -p.real, step)
        value = (c * np.exp(p * later)).real
        summits = value[1:-1][(value[1:-1] > value[:-2]) & (value[1:-1] >= value[2:])]
        if summits.size:
            assert height[i] == pytest.approx(summits[0], abs=2e-4)
            assert value[np.rint((at[i] - 3.0) / step).astype(int)] == pytest.approx(summits[0], abs=2e-4)
        for found, size in ((both[i], np.abs(value)), (above[i], value)):
            outside = np.nonzero(size > width[i])[0]
            if outside.size:
                assert found - 3.0 == pytest.approx(later[outside[-1]], abs=1.01 * step)
            else:
                assert np.isnan(found)


def test_a_response_of_too_many_pieces_is_refused_before_it_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    limit = _largest_stable_gain()
    loop = Loop(Plant([1.0], [1.0, 1.0], dead_time=1.0), PI(limit * (1.0 - 1e-8), 0.5 * limit * (1.0 - 1e-8)))
    monkeypatch.setattr(Loop, "_marched", lambda *_: pytest.fail("it was computed"))
    with pytest.raises(LoopError, match=r"needs more than .* pieces up to t = .*: choose a shorter horizon"):
        loop.step()


def _largest_stable_gain() -> float:
    """Return the gain at which e^{-s} / (s + 1) under k (1 + 0.5 / s) has a pole on the axis."""
    mp.mp.dps = 40
    w = mp.findroot(lambda w: mp.atan(2 * w) - mp.atan(w) - w + mp.pi / 2, mp.mpf(1.7))
    return float(w * mp.sqrt(1 + w**2) / mp.sqrt(w**2 + mp.mpf(0.25)))


def _slowest_mode(k: float, ki: float) -> tuple[mp.mpc, mp.mpc]:
    """Return the pole of e^{-s} / (s + 1) under PI control next to the axis, and twice the residue of y - 1 there."""

    def characteristic(s: mp.mpc) -> mp.mpc:
        return s * (s + 1) + (k * s + ki) * mp.exp(-s)

    pole = mp.findroot(characteristic, mp.mpc(0, 1.7), tol=1e-60)
    slope = mp.diff(characteristic, pole)
    return pole, 2 * (k * pole + ki) * mp.exp(-pole) / (pole * slope)
