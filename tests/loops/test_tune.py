"""Callable tuning rules against the numbers of their papers and against the property that they aim at."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from replicate.loops import PI, PID, Loop, LoopError, Plant, tune

FOPTD = Plant.foptd(2.0, 10.0, 1.0)
INTEGRATING = Plant([0.2], [1.0, 0.0], 7.4)
LAGS = Plant([1.0], np.poly([-1.0] * 4), 0.0)  # 1/(s+1)^4


def ideal(controller: PID) -> tuple[float, float, float]:
    return controller.k, controller.integral_time, controller.derivative_time


def test_simc_of_a_lag_and_of_an_integrator() -> None:
    # Skogestad (2003), table 1: K = T/(k (tau_c + L)), Ti = min(T, 4 (tau_c + L))
    assert ideal(tune.simc(FOPTD)) == pytest.approx((2.5, 8.0, 0.0), rel=1e-14)
    assert ideal(tune.simc(FOPTD, tau_c=4.0)) == pytest.approx((1.0, 10.0, 0.0), rel=1e-14)
    assert ideal(tune.simc(INTEGRATING)) == pytest.approx((1 / (0.2 * 14.8), 59.2, 0.0), rel=1e-14)
    assert type(tune.simc(FOPTD)) is PI


def test_simc_of_higher_orders_by_the_half_rule() -> None:
    # 1/(s+1)^4: T1 = 1.5, L = 2.5 for PI; T1 = 1, T2 = 1.5, L = 1.5 for PID (Skogestad, section 2: the first kept one
    # is untouched, the second takes half of the third)
    pi = tune.simc(LAGS)
    assert ideal(pi) == pytest.approx((1.5 / 5.0, 1.5, 0.0), rel=1e-12)
    pid = tune.simc(LAGS, derivative=True)
    expected = PID.series(1.5 / 3.0, 1.5, 1.0)  # the larger of the two is T1
    assert (pid.k, pid.ki, pid.kd) == pytest.approx((expected.k, expected.ki, expected.kd), rel=1e-12)


def test_the_half_rule_on_skogestads_first_example() -> None:
    # G = 1/((s+1)(0.2s+1)), Skogestad (2003) E1: first order T = 1.1, L = 0.1
    model = tune.half_rule(Plant([1.0], [0.2, 1.2, 1.0]))
    assert [*model.time_constants, model.dead_time] == pytest.approx([1.1, 0.1])
    # (-0.3s+1)(0.08s+1)/((2s+1)(s+1)(0.4s+1)(0.2s+1)(0.05s+1)^3) has a zero on the left: refused, not guessed
    with pytest.raises(LoopError, match="zero, apart from one to the right, must be real and stable"):
        tune.half_rule(Plant([0.08, 1.0], [1.0, 2.0, 1.0]))


def test_zeros_to_the_right_are_dead_time() -> None:
    model = tune.lag_model(Plant([-0.6, 2.0], [1.0, 2.0, 1.0], 0.5))
    assert [model.gain, model.dead_time] == pytest.approx([2.0, 0.8])
    assert model.time_constants == pytest.approx((1.0, 1.0), rel=1e-14)


def test_simc_of_a_double_integrator_and_of_a_dead_time() -> None:
    # Skogestad, table 1: Kc = 1/(4 k (tau_c + L)^2), Ti = Td = 4 (tau_c + L), series form
    pid = tune.simc(Plant([1.0], [1.0, 0.0, 0.0], 0.5))
    assert pid == PID.series(0.25, 4.0, 4.0)
    # pure dead time: integral control 0.5/(k L)
    assert tune.simc(Plant([2.0], [1.0], 3.0)) == PI(0.0, 1 / 12)
    # integrating with lag: Td = T2
    assert tune.simc(Plant([1.0], [3.0, 1.0, 0.0], 1.0), derivative=True) == PID.series(0.5, 8.0, 3.0)


def test_amigo_at_balanced_lag_and_delay() -> None:
    # T = L = 1: K = 0.15 + 0.35 - 0.25, Ti = 0.35 + 13/20; PID: K = 0.65, Ti = 1.2/1.1, Td = 0.5/1.3
    balanced = Plant.foptd(1.0, 1.0, 1.0)
    assert ideal(tune.amigo(balanced)) == pytest.approx((0.25, 1.0, 0.0), rel=1e-14)
    assert ideal(tune.amigo(balanced, derivative=True)) == pytest.approx((0.65, 12 / 11, 5 / 13), rel=1e-14)
    assert ideal(tune.amigo(INTEGRATING)) == pytest.approx((0.35 / 1.48, 13.4 * 7.4, 0.0), rel=1e-14)
    assert ideal(tune.amigo(INTEGRATING, derivative=True)) == pytest.approx((0.45 / 1.48, 59.2, 3.7), rel=1e-14)


def test_the_integrating_rules_are_the_limits_of_the_others() -> None:
    slow = Plant.foptd(0.2 * 1e9, 1e9, 7.4)
    for rule in (tune.amigo, lambda plant: tune.amigo(plant, derivative=True), tune.ziegler_nichols, tune.simc):
        assert ideal(rule(slow)) == pytest.approx(ideal(rule(INTEGRATING)), rel=0.05, abs=1e-9)


def test_lambda_tuning_cancels_the_lag() -> None:
    controller = tune.lambda_(FOPTD, tau_cl=4.0)
    assert ideal(controller) == pytest.approx((1.0, 10.0, 0.0), rel=1e-14)
    assert ideal(tune.lambda_(FOPTD)) == pytest.approx((10 / 22, 10.0, 0.0), rel=1e-14)
    # the closed loop of an integrating plant: 2 tau + L over Kv (tau + L)^2
    assert ideal(tune.lambda_(INTEGRATING, 10.0)) == pytest.approx((27.4 / (0.2 * 17.4**2), 27.4, 0.0), rel=1e-14)


def test_ziegler_nichols_step_method() -> None:
    # K = 1.2/a, Ti = 2 L, Td = L/2 with a = K L/T = 0.2
    assert ideal(tune.ziegler_nichols(FOPTD, "PID")) == pytest.approx((6.0, 2.0, 0.5), rel=1e-14)
    assert ideal(tune.ziegler_nichols(FOPTD, "PI")) == pytest.approx((4.5, 1 / 0.3, 0.0), rel=1e-14)
    assert tune.ziegler_nichols(FOPTD, "P") == PI(5.0)


def test_the_ultimate_point() -> None:
    # 1/(s+1)^4: each lag turns by 45 degrees at w = 1, gain 4; e^{-s}/s: pi/2 at w = pi/2
    assert tune.ultimate(LAGS) == pytest.approx((4.0, 2 * np.pi), rel=1e-10)
    assert tune.ultimate(Plant([1.0], [1.0, 0.0], 1.0)) == pytest.approx((np.pi / 2, 4.0), rel=1e-10)
    assert tune.ultimate(Plant([-2.0], np.poly([-1.0] * 4))) == pytest.approx((-2.0, 2 * np.pi), rel=1e-10)
    found = tune.ziegler_nichols(LAGS, "PID", method="ultimate")
    assert ideal(found) == pytest.approx((2.4, np.pi, np.pi / 4), rel=1e-10)
    with pytest.raises(LoopError, match="it has no ultimate gain"):
        tune.ultimate(Plant([1.0], [1.0, 1.0]))


@pytest.mark.parametrize("plant", [Plant.foptd(1.0, 1.0, 0.5), LAGS, Plant([-0.2], [1.0, 0.0], 1.0)])
@pytest.mark.parametrize("specification", [(4.0, 60.0), (3.0, 55.0)])
def test_the_margins_are_those_that_were_asked_for(plant: Plant, specification: tuple[float, float]) -> None:
    margins = Loop(plant, tune.gain_phase_margins(plant, *specification)).margins()
    assert (margins.gain, margins.phase) == pytest.approx(specification, rel=1e-8)


def test_classical_rules_by_name() -> None:
    # Cohen and Coon: K = T/(K L) (0.9 + L/(12 T)), Ti = L (30 + 3 L/T)/(9 + 20 L/T)
    found = tune.by_name(FOPTD, "cohen-coon")
    assert ideal(found) == pytest.approx((5 * (0.9 + 0.1 / 12), 30.3 / 11, 0.0), rel=1e-13)
    with pytest.raises(LoopError, match="no classical rule 'x'; allowed are ziegler-nichols"):
        tune.by_name(FOPTD, "x")
    with pytest.raises(LoopError, match="not for an integrating plant"):
        tune.by_name(INTEGRATING, "cohen-coon")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: tune.simc(FOPTD, tau_c=-1.0), "tau_c must be >= 0"),
        (lambda: tune.simc(Plant([1.0], [1.0, 1.0])), "> 0 for a plant without dead time"),
        (lambda: tune.simc(Plant([1.0], [1.0, 0.1, 1.0], 1.0)), "every pole must be real and stable"),
        (lambda: tune.simc(Plant([1.0], [1.0, -1.0], 1.0)), "every pole must be real and stable, not 1"),
        (lambda: tune.simc(Plant([1.0], [1.0, 0.0, 0.0, 0.0], 1.0)), "cannot hold the plant's 3 integrators"),
        (lambda: tune.amigo(LAGS), "tune.half_rule reduces a plant"),
        (lambda: tune.amigo(Plant([1.0], [1.0, 1.0])), "AMIGO needs a plant with dead time"),
        (lambda: tune.lambda_(FOPTD, -1.0), "tau_cl must be a time >= 0"),
        (lambda: tune.ziegler_nichols(FOPTD, "PD"), "kind must be P, PI or PID"),  # type: ignore[arg-type]
        (lambda: tune.gain_phase_margins(FOPTD, 0.5, 60.0), "must be a factor > 1"),
        (lambda: tune.gain_phase_margins(FOPTD, 1.01, 170.0), "no PI controller gives"),
        (lambda: tune.simc(Plant.from_function(lambda s: np.exp(-np.sqrt(s)))), "made for a rational plant"),
    ],
)
def test_what_a_rule_refuses(call: Callable[[], object], message: str) -> None:
    with pytest.raises(LoopError, match=message):
        call()


def test_every_rule_has_its_source_and_range() -> None:
    assert {"simc", "amigo", "lambda_", "ziegler_nichols", "gain_phase_margins"} < tune.RULES.keys()
    for name, card in tune.RULES.items():
        assert getattr(tune, name) is card.rule
        assert card.source
        assert card.validity
