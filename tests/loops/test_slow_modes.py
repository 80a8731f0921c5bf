"""Loops whose slow modes last a million times longer than the others: few pieces, and every digit.

References: de Hoog's inversion of the closed loop's transform in mpmath, and IE = 1/ki of a load response.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest

from replicate.loops import PI, PID, Loop, Plant, SmithPredictor

Transform = Callable[[mp.mpc], mp.mpc]

MOST_PIECES = 500


def lag(gain: float, time_constant: float, dead_time: float) -> Transform:
    return lambda s: mp.mpf(gain) * mp.exp(-s * mp.mpf(dead_time)) / (1 + s * mp.mpf(time_constant))


def pi(k: float, ki: float) -> Transform:
    return lambda s: mp.mpf(k) + mp.mpf(ki) / s


FOPTD, SLOW = Plant.foptd(1.0, 1.0, 1.0), 1e-9
MODEL = Plant.foptd(1.1, 1.0, 1.2)
# a loop, its G, C and set-point filter, and the inner feedback C M of a predictor
LOOPS: dict[str, tuple[Loop, Transform, Transform, Transform, Transform]] = {
    "weak integral action": (
        Loop(FOPTD, PI(0.6, SLOW)), lag(1, 1, 1), pi(0.6, SLOW), lambda _: mp.mpf(1), lambda _: mp.mpf(0),
    ),
    "slow pair": (
        Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(1e-6, 1e-12)),
        lambda s: mp.exp(-s) / s, pi(1e-6, 1e-12), lambda _: mp.mpf(1), lambda _: mp.mpf(0),
    ),
    "slow lag that cancels": (
        Loop(Plant.foptd(1.0, 1e7, 1.0), PI.from_integral_time(5e6, 1e7)),
        lag(1, 1e7, 1), pi(5e6, 0.5), lambda _: mp.mpf(1), lambda _: mp.mpf(0),
    ),
    "slow set-point filter": (
        Loop(FOPTD, PID(0.6, 0.5, setpoint_filter=1e8)),
        lag(1, 1, 1), pi(0.6, 0.5), lag(1, 1e8, 0), lambda _: mp.mpf(0),
    ),
    "slowly unstable plant": (
        Loop(Plant([1.0], [1.0, -1e-8], 1.0), PI(0.3, 1e-10)),
        lambda s: mp.exp(-s) / (s - mp.mpf(1e-8)), pi(0.3, 1e-10), lambda _: mp.mpf(1), lambda _: mp.mpf(0),
    ),
    # the moment from which all but the fastest are left comes while the response is far below what they will be
    "a set-point that only the integral sees": (
        Loop(Plant([5.2], [1.0, 1.6, 0.0], 0.0013), PI(1.6, 0.04, b=0.0)),
        lambda s: lag(5.2 / 1.6, 1 / 1.6, 0.0013)(s) / s, pi(1.6, 0.04), lambda s: pi(0.0, 0.04)(s) / pi(1.6, 0.04)(s),
        lambda _: mp.mpf(0),
    ),
    "a filter far from all else": (
        Loop(Plant([7.5], [1.0, 0.0, 0.0]), PID(2.0, 0.001, 0.05, b=0.0, measurement_filter=3e-5)),
        lambda s: mp.mpf(7.5) / s**2, lambda s: (pi(2.0, 0.001)(s) + mp.mpf(0.05) * s) * lag(1, 3e-5, 0)(s),
        lambda s: pi(0.0, 0.001)(s) / ((pi(2.0, 0.001)(s) + mp.mpf(0.05) * s) * lag(1, 3e-5, 0)(s)),
        lambda _: mp.mpf(0),
    ),
    "predictor": (
        Loop(FOPTD, SmithPredictor(PI(0.6, 1e-8), MODEL)), lag(1, 1, 1), pi(0.6, 1e-8), lambda _: mp.mpf(1),
        lambda s: pi(0.6, 1e-8)(s) * (lag(1.1, 1, 0)(s) - lag(1.1, 1, 1.2)(s)),
    ),
}  # fmt: skip


@pytest.mark.parametrize("load", [0.0, 0.5])
@pytest.mark.parametrize("name", LOOPS)
def test_slow_exponentials_are_passed_over(name: str, load: float) -> None:
    loop, plant, controller, setpoint_filter, inner = LOOPS[name]
    found = loop.respond(setpoint=1.0, load=load)
    assert found.output.breaks.size < MOST_PIECES
    times = np.array([1e-4, 1.0 / 300.0, 1.0 / 34.0, 0.1]) * loop.horizon()

    def transform(s: mp.mpc) -> mp.mpc:
        drive = controller(s) * setpoint_filter(s) + load * (1 + inner(s))
        return plant(s) * drive / (s * (1 + inner(s) + controller(s) * plant(s)))

    with mp.workdps(30):
        expected = np.array([float(mp.invertlaplace(transform, t, method="dehoog", degree=40)) for t in times])
    np.testing.assert_allclose(found.output(times), expected, rtol=1e-12, atol=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize("ki", [1e-6, 1e-9, 1e-12, 1e-15])
@pytest.mark.parametrize("plant", [FOPTD, Plant([0.2, 1.0], [1.0, 1.0], 1.0), Plant([1.0], [1.0, 0.0], 1.0)])
def test_integrated_error_of_weak_integral_action(plant: Plant, ki: float) -> None:
    load = Loop(plant, PI(0.6, ki)).load_step()
    assert load.breaks.size < MOST_PIECES
    assert load.ie() == pytest.approx(1.0 / ki, rel=1e-12)


def test_a_long_end_close_to_rest_has_the_digits_of_its_deviation() -> None:
    # half of the area lies in y = 1 - 5e-7 exp(-5e-8 t), which a number of 16 digits holds to 2e-10 of the deviation
    plant, controller = lag(1, 1e7, 1), pi(1e6, 0.05)
    y = Loop(Plant.foptd(1.0, 1e7, 1.0), PI(1e6, 0.05)).step()
    with mp.workdps(30):
        for t in (1e3, 1e6, 2e7):
            deviation = mp.invertlaplace(
                lambda s: 1 / (s * (1 + controller(s) * plant(s))), t, method="dehoog", degree=40
            )
            assert 1.0 - y(t) == pytest.approx(float(deviation), rel=2e-9)
    assert y.iae() == pytest.approx(20.0, rel=5e-9)


@pytest.mark.parametrize(("k", "ki"), [("0.51242", "0.00034788"), ("0.41721", "0.00029552")])
def test_the_moment_of_an_error_with_a_weak_slow_mode(k: str, ki: str) -> None:
    # 1/(s (5 s + 1)) under PI: the error is a sum of three exponentials, the slowest a thousandth of the first
    with mp.workdps(40):
        gain, integral = mp.mpf(k), mp.mpf(ki)
        poles = mp.polyroots([5, 1, gain, integral], maxsteps=200, extraprec=200)
        residues = [-(gain * p + integral) / (p * (15 * p**2 + 2 * p + gain)) for p in poles]

        def error(t: mp.mpf) -> mp.mpf:
            return mp.re(sum(r * mp.exp(p * t) for r, p in zip(residues, poles, strict=True)))

        def moment(t: mp.mpf) -> mp.mpf:  # antiderivative of t e(t)
            return mp.re(sum(r * mp.exp(p * t) * (t / p - 1 / p**2) for r, p in zip(residues, poles, strict=True)))

        times = [mp.mpf(i) / 2 for i in range(400)]
        turns = [pair for pair in pairwise(times) if error(pair[0]) * error(pair[1]) < 0]
        ends = [mp.mpf(0), *(mp.findroot(error, pair, solver="anderson") for pair in turns)]
        values = [*(moment(t) for t in ends), mp.mpf(0)]
        expected = float(sum(abs(after - before) for before, after in pairwise(values)))
    y = Loop(Plant([1.0], [5.0, 1.0, 0.0]), PI(float(k), float(ki))).step()
    assert y.itae() == pytest.approx(expected, rel=3e-10)
    assert y.breaks.size < MOST_PIECES
