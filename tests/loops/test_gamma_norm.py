"""The norm gamma against singular values, a Hamiltonian test and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

from replicate.loops import PI, PID, Loop, LoopError, Plant, UnstableLoopError, Weight, gamma_norm, stability_margin
from replicate.loops.frequency_domain.gamma_norm import singular_value

FOURTH_ORDER = Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0])

LOOPS = {
    "fourth order": (FOURTH_ORDER, PI(0.76, 0.36)),
    "dead time": (Plant([1.34], [43.3**2, 2 * 43.3, 1.0], dead_time=12.9), PI(0.8, 0.8 / 60)),
    "integrator": (Plant([0.24, 0.008], [5.0, 1.0, 0.0], dead_time=2.0), PI(5.0, 1.0)),
    "filtered PID": (FOURTH_ORDER, PID(1.1, 0.5, 1.1, derivative_filter=0.1)),
    "resonance": (Plant([9.0], np.polymul([1.0, 1.0], [1.0, 0.2, 9.0])), PI(0.05, 0.1)),
}


def matrices(plant: Plant, controller: PID, w: np.ndarray, scale: float = 1.0) -> np.ndarray:
    """The closed loop's transfer matrix itself, frequency by frequency."""
    s = 1j * w
    g = np.polyval(plant.num, s) / np.polyval(plant.den, s) * np.exp(-s * plant.dead_time)
    gc = controller.k + controller.ki / s + controller.kd * s / (1.0 + controller.derivative_filter * s)
    rows = np.array([[-g * gc, g * scale], [-gc / scale, np.ones_like(g)]]) / (1.0 + g * gc)
    return np.moveaxis(rows, -1, 0)


@pytest.mark.parametrize("name", LOOPS)
@pytest.mark.parametrize("scale", [None, 0.4, 3.0])
def test_supremum_of_singular_values(name: str, scale: float | None) -> None:
    plant, controller = LOOPS[name]
    weight = None if scale is None else Weight.constant(scale)
    found = gamma_norm(plant, controller, weight)
    w = np.geomspace(1e-4, 1e4, 200_001)
    largest = np.linalg.svd(matrices(plant, controller, w, scale or 1.0), compute_uv=False)[:, 0]
    assert largest.max() <= found * (1.0 + 1e-12)
    assert largest.max() == pytest.approx(found, rel=1e-6)  # the grid misses the peak by half a step
    if 0.0 < found.frequency < np.inf:
        there = np.linalg.svd(matrices(plant, controller, np.array([found.frequency]), scale or 1.0), compute_uv=False)
        assert there[0, 0] == pytest.approx(found, rel=1e-12)
        assert there[0, 1] == pytest.approx(0.0, abs=1e-12)  # rank one


@pytest.mark.parametrize("name", LOOPS)
def test_favourable_weight_gives_the_sum_of_both_sensitivities(name: str) -> None:
    plant, controller = LOOPS[name]
    found = gamma_norm(plant, controller, Weight.balancing(plant, controller))
    w = np.geomspace(1e-4, 1e3, 200_001)
    loop = -matrices(plant, controller, w)[:, 0, 0]
    total = np.abs(loop) + np.abs(1.0 - loop)  # |T| + |S|
    assert total.max() <= found * (1.0 + 1e-12)
    assert total.max() == pytest.approx(found, rel=1e-6)
    assert w[total.argmax()] == pytest.approx(found.frequency, rel=1e-3)


@pytest.mark.parametrize("name", LOOPS)
def test_no_constant_weight_beats_the_favourable_one(name: str) -> None:
    plant, controller = LOOPS[name]
    w = np.geomspace(1e-3, 1e2, 500)
    best = singular_value(plant, controller, w, Weight.balancing(plant, controller))
    for scale in np.geomspace(0.05, 20.0, 60):
        assert np.all(best <= singular_value(plant, controller, w, Weight.constant(float(scale))) * (1.0 + 1e-12))


def state_space(plant: Plant, controller: PI, scale: float) -> tuple[np.ndarray, ...]:
    """The loop of a strictly proper plant and a PI controller as a state-space system with inputs (n, l)."""
    order = plant.den.size - 1
    a = np.diag(np.ones(order - 1), -1)
    a[0] = -plant.den[1:]
    b = np.eye(order, 1)
    c = np.concatenate([np.zeros(plant.den.size - 1 - plant.num.size), plant.num])[None, :]
    # x' = a x + b v, output x_o = c x, v = W l + u and u = -k (x_o + n) + ki z, z' = -(x_o + n); output u + l over W
    big = np.block([[a - controller.k * b @ c, controller.ki * b], [-c, np.zeros((1, 1))]])
    inputs = np.block([[-controller.k * b, scale * b], [np.array([[-1.0]]), np.zeros((1, 1))]])
    outputs = np.block([[c, np.zeros((1, 1))], [-controller.k * c / scale, np.array([[controller.ki / scale]])]])
    through = np.array([[0.0, 0.0], [-controller.k / scale, 1.0]])
    return big, inputs, outputs, through


def reaches(system: tuple[np.ndarray, ...], level: float) -> bool:
    """Whether some singular value equals ``level`` at some frequency (Boyd, Balakrishnan and Kabamba 1989)."""
    a, b, c, d = system
    r = d.T @ d - level**2 * np.eye(d.shape[1])
    inverse = np.linalg.inv(r)
    top = a - b @ inverse @ d.T @ c
    outer = np.linalg.inv(d @ d.T - level**2 * np.eye(d.shape[0]))
    hamiltonian = np.block([[top, -level * b @ inverse @ b.T], [level * c.T @ outer @ c, -top.T]])
    eigenvalues = scipy.linalg.eigvals(hamiltonian)
    return bool(np.any(np.abs(eigenvalues.real) < 1e-7 * np.abs(eigenvalues)))


@pytest.mark.parametrize("scale", [1.0, 1.7])
@pytest.mark.parametrize("name", ["fourth order", "resonance"])
def test_hamiltonian_matrix(name: str, scale: float) -> None:
    plant, controller = LOOPS[name]
    assert isinstance(controller, PI)
    found = gamma_norm(plant, controller, Weight.constant(scale)).value
    system = state_space(plant, controller, scale)
    assert reaches(system, found * (1.0 - 1e-8))
    assert not reaches(system, found * (1.0 + 1e-8))


@pytest.mark.parametrize(("gain", "k"), [(1.0, 1.0), (2.0, 0.5), (3.0, 4.0)])
def test_integrator_under_proportional_control(gain: float, k: float) -> None:
    # (1 + k^2)(w^2 + gain^2)/(w^2 + (gain k)^2) is monotone in w: one of its limits is the supremum
    found = gamma_norm(Plant([gain], [1.0, 0.0]), PI(k))
    expected = np.sqrt(1.0 + k**2) * max(1.0, 1.0 / k)
    assert found == pytest.approx(expected, rel=1e-12)
    if k != 1.0:
        assert found.frequency == (0.0 if k < 1.0 else np.inf)


def test_ideal_derivative_has_no_bound_without_weight() -> None:
    pid = PID(1.1, 0.5, 1.1)
    assert gamma_norm(FOURTH_ORDER, pid) == np.inf
    assert gamma_norm(FOURTH_ORDER, pid).frequency == np.inf
    assert stability_margin(FOURTH_ORDER, pid) == 0.0
    assert 1.0 < gamma_norm(FOURTH_ORDER, pid, Weight.balancing(FOURTH_ORDER, pid)) < 10.0


def test_between_the_sensitivity_peaks() -> None:
    for plant, controller in LOOPS.values():
        loop = Loop(plant, controller)
        largest = max(loop.sensitivity_peak().value, loop.complementary_peak().value)
        found = gamma_norm(plant, controller, Weight.balancing(plant, controller))
        assert 2.0 * largest - 1.0 <= found <= 2.0 * largest  # triangle inequality with S + T = 1


def test_unstable_loop_has_margin_zero() -> None:
    wild = PI(20.0, 5.0)
    assert stability_margin(FOURTH_ORDER, wild) == 0.0
    with pytest.raises(UnstableLoopError, match="the loop is unstable"):
        gamma_norm(FOURTH_ORDER, wild)


@pytest.mark.parametrize("value", [0.0, -1.0, np.inf, np.nan])
def test_a_weight_is_a_positive_number(value: float) -> None:
    with pytest.raises(LoopError, match="a constant weight must be a positive number"):
        Weight.constant(value)
