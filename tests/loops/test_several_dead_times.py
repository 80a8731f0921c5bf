"""Plants with several dead times: algebra, responses and poles against sums over paths around the loop.

A path goes through one term of the plant each time around; its transform is rational times one dead time and is
inverted in 40 digits.
"""

from __future__ import annotations

from itertools import product

import mpmath as mp
import numpy as np
import pytest

from loops.references import talbot
from replicate.loops import PI, PID, Loop, LoopError, Plant, design_pi

Term = tuple[list[float], list[float], float]

WINDOW: list[Term] = [([1.0], [1.0, 0.0], 0.0), ([-1.0], [1.0, 0.0], 1.0)]  # (1 - e^-s)/s
ECHO: list[Term] = [([1.0], [1.0], 1.0), ([0.5], [1.0], 2.0)]  # e^-s + 0.5 e^-2s
PARALLEL: list[Term] = [([1.0], [1.0, 1.0], 1.0), ([0.5], [1.0, 2.0], 2.3)]
SHARED: list[Term] = [([1.0], [1.0, 1.0], 0.3), ([-0.4], [1.0, 1.5, 0.5], np.sqrt(2.0))]


def path_sum(terms: list[Term], k: float, ki: float, t: float, *, load: bool) -> float:
    """Return the response to a unit step by all paths that have arrived at time ``t``; all dead times are positive."""
    longest = int(t / min(delay for *_, delay in terms))
    total = mp.mpf(0)
    with mp.workdps(30):
        for trips in range(longest):
            for path in product(terms, repeat=trips + 1):
                left = mp.mpf(t) - mp.fsum(delay for *_, delay in path)
                if left <= 0:
                    continue

                def transform(s: mp.mpc, path: tuple[Term, ...] = path, trips: int = trips) -> mp.mpc:
                    plant = mp.fprod(mp.polyval(num, s) / mp.polyval(den, s) for num, den, _ in path)
                    controller = k + ki / s
                    return (-controller) ** trips * (1 if load else controller) * plant / s

                total += talbot(transform, left, 40)
    return float(total)


@pytest.mark.parametrize("terms", [ECHO, PARALLEL, SHARED], ids=["echo", "parallel", "shared pole"])
@pytest.mark.parametrize("load", [False, True])
def test_responses_against_sums_over_paths(terms: list[Term], load: bool) -> None:
    k, ki = 0.25, 0.3
    loop = Loop(Plant.from_terms(terms), PI(k, ki))
    y = loop.respond(setpoint=0.0 if load else 1.0, load=1.0 if load else 0.0, until=8.0).output
    for t in (0.2, 1.35, 2.55, 4.15) if terms is not SHARED else (0.2, 0.65, 1.55, 1.95):
        assert float(y(t)) == pytest.approx(path_sum(terms, k, ki, t, load=load), abs=1e-12)


def test_moving_average_under_integral_control() -> None:
    # y' = u(t) - u(t - 1) and u' = ki (1 - y): an oscillation, which from t = 1 on is forced at resonance,
    # z'' + ki z = ki - ki cos(root x) with x = t - 1
    ki, x = 0.7, 0.6
    y = Loop(Plant.from_terms(WINDOW), PI(0.0, ki)).step(until=5.0)
    root = np.sqrt(ki)
    assert float(y(0.8)) == pytest.approx(1.0 - np.cos(root * 0.8), abs=1e-14)
    free = (1.0 - np.cos(root)) * np.cos(root * x) + np.sin(root) * np.sin(root * x)
    forced = 1.0 - np.cos(root * x) - 0.5 * root * x * np.sin(root * x)
    assert float(y(1.0 + x)) == pytest.approx(free + forced, abs=1e-13)


@pytest.mark.parametrize("terms", [WINDOW, ECHO, PARALLEL, SHARED], ids=["window", "echo", "parallel", "shared"])
def test_poles_are_zeros_of_the_characteristic_function(terms: list[Term]) -> None:
    k, ki = 0.25, 0.3
    loop = Loop(Plant.from_terms(terms), PI(k, ki))
    assert loop.is_stable()
    poles = loop.poles(6)
    assert len(poles) == 6
    assert np.all(np.diff(poles.real) <= 1e-9)
    with mp.workdps(40):
        for pole in poles:
            s = mp.mpc(pole)
            plant = mp.fsum(mp.polyval(num, s) / mp.polyval(den, s) * mp.exp(-s * delay) for num, den, delay in terms)
            hidden = any(abs(mp.polyval(den, s)) < 1e-9 for _, den, _ in terms)
            assert hidden or abs(1 + (k + ki / s) * plant) < 1e-9


def test_algebra() -> None:
    s = np.array([0.3 + 2.0j, 1e-9j, -0.4 + 0.1j])
    window, echo = Plant.from_terms(WINDOW), Plant.from_terms(ECHO)
    exact = (1.0 - np.exp(-s[[0, 2]])) / s[[0, 2]]
    assert np.abs(window(s[[0, 2]]) - exact).max() < 1e-14
    assert abs(window(s)[1] - 1.0) < 1e-8
    assert window.gain == pytest.approx(1.0, rel=1e-14)
    lag = Plant.foptd(2.0, 3.0, 0.5)
    assert np.abs((lag * echo)(s) - lag(s) * echo(s)).max() < 1e-13
    assert np.abs((lag + echo)(s) - lag(s) - echo(s)).max() < 1e-13
    assert np.abs((lag - echo)(s) - lag(s) + echo(s)).max() < 1e-13
    assert np.abs((2.0 * echo + 1.0)(s) - 2.0 * echo(s) - 1.0).max() < 1e-13
    assert (lag * lag).is_rational
    assert (lag * lag).dead_time == 1.0
    assert (lag + Plant([1.0], [1.0, 2.0], 0.5)).is_rational
    heat = Plant.from_function(lambda z: np.exp(-np.sqrt(z)), 0.1)
    assert np.abs((heat * lag)(s) - heat(s) * lag(s)).max() < 1e-13
    assert np.abs((heat + echo)(s) - heat(s) - echo(s)).max() < 1e-13
    with pytest.raises(LoopError, match="cancel"):
        lag - lag
    with pytest.raises(LoopError, match="at least one term"):
        Plant.from_terms([])
    with pytest.raises(LoopError, match=r"\(num, den, dead_time\)"):
        Plant.from_terms([([1.0], [1.0])])  # type: ignore[list-item]


def test_one_dead_time_split_in_two_terms_is_one_plant() -> None:
    # 1/((s+1)(s+2)) = 1/(s+1) - 1/(s+2): as two terms with dead times a hair apart the same response
    one = Plant([1.0], [1.0, 3.0, 2.0], 0.7)
    two = Plant.from_terms([([1.0], [1.0, 1.0], 0.7), ([-1.0], [1.0, 2.0], 0.7 + 1e-7)])
    t = np.linspace(0.1, 20.0, 30)
    a, b = (Loop(p, PID(1.2, 0.8, 0.2)).step(until=20.0)(t) for p in (one, two))
    assert np.max(np.abs(a - b)) < 1e-6
    assert np.max(np.abs(a - b)) > 1e-9


def test_neutral_loop_with_commensurate_dead_times() -> None:
    # 1 + k (z + z^2/2) has its roots outside the unit circle for k < 2, although k + k/2 exceeds one from k = 2/3 on
    echo = Plant.from_terms(ECHO)
    assert Loop(echo, PI(0.9, 0.2)).is_stable()
    assert not Loop(echo, PI(2.1, 0.2)).is_stable()


def test_design_for_several_dead_times() -> None:
    plant = Plant.from_terms(PARALLEL)
    design = design_pi(plant, ms=1.6)
    w = np.geomspace(1e-3, 1e2, 400_001)
    curve = (design.k + design.ki / (1j * w)) * plant(1j * w)
    assert design.status == "optimal"
    assert 1.0 / np.min(np.abs(1.0 + curve)) == pytest.approx(1.6, rel=1e-6)
