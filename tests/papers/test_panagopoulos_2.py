"""Paper II of the thesis and its supplement against other libraries, symbolic algebra and brute force."""

from __future__ import annotations

from dataclasses import replace

import control
import numpy as np
import pytest
import sympy as sp
from scipy import integrate

from replicate.exhibits import Table
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.rounded_inputs import compute_reading
from replicate.loops import PID, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2 import (
    example,
    example_controllers,
    feasible,
    filters,
    noise_figures,
    setpoint,
    tables,
)
from replicate.papers.panagopoulos.part_2.designs import optimal, printed
from replicate.papers.panagopoulos.part_2.printed_gains import printed_number
from replicate.papers.panagopoulos.part_2.processes import PLANTS, ROWS, split
from replicate.papers.panagopoulos.part_2.setpoint_formulas import weight_peak
from replicate.papers.panagopoulos.part_2.shape import largest_gain, largest_over
from replicate.papers.panagopoulos.part_2.tables import printed_properties

S = control.tf("s")


def g4() -> control.TransferFunction:
    return 1 / (S + 1) ** 4


@pytest.mark.parametrize("table", ["II-table-1", "IIs-table-2"])
def test_transcribed_gains_agree_with_the_transcribed_integrated_errors(table: str) -> None:
    # IE = Ti/k: a wrong digit in one of the three would show, beyond rounding
    for row in ROWS:
        k, ti, ie = (printed_number(table, row, column) for column in ("k", "Ti", "IE"))
        assert ti / k == pytest.approx(ie, rel=0.025), row


@pytest.mark.parametrize("table", ["II-table-1", "IIs-table-2"])
def test_a_filter_is_printed_exactly_where_the_weight_is_zero(table: str) -> None:
    for row in ROWS:
        assert (printed_number(table, row, "b") == 0.0) == (printed_number(table, row, "Tsp") > 0.0), row


def test_peaks_of_a_row_by_another_library() -> None:
    c = printed("IIs-table-2", "G4 Ms=2.0")
    loop = g4() * (c.k + c.ki / S + c.kd * S)
    w = np.linspace(0.3, 2.0, 20001)
    response = np.asarray(control.frequency_response(loop, w).complex).ravel()
    found = printed_properties("IIs-table-2", "G4 Ms=2.0")
    assert found.Ms == pytest.approx(np.max(1.0 / np.abs(1.0 + response)), rel=1e-7)
    assert found.Mp == pytest.approx(np.max(np.abs(response / (1.0 + response))), rel=1e-7)
    assert found.w0 == pytest.approx(w[np.argmin(np.abs(1.0 + response))], rel=1e-3)


def test_absolute_error_by_partial_fractions() -> None:
    c = example_controllers.CONTROLLERS["kd=3"]
    den = np.polyadd(np.append(np.poly([-1.0] * 4), 0.0), [c.kd, c.k, c.ki])
    poles = np.roots(den)
    weights = poles / np.polyval(np.polyder(den), poles) / poles  # y = L^-1 of s/den * 1/s

    def y(t: np.ndarray) -> np.ndarray:
        return (np.exp(np.outer(t, poles)) @ weights).real

    t = np.linspace(0.0, 250.0, 400001)
    exact = example.numbers("kd=3", {"k": c.k, "ki": c.ki, "kd": c.kd})["IAE"]
    assert exact == pytest.approx(integrate.simpson(np.abs(y(t)), x=t), rel=1e-7)


def test_poles_of_the_example() -> None:
    for key, c in example_controllers.CONTROLLERS.items():
        poles = control.feedback(g4() * (c.k + c.ki / S + c.kd * S), 1).poles()
        pairs = sorted((p for p in poles if p.imag > 1e-9), key=abs, reverse=True)
        found = example.numbers(key, {"k": c.k, "ki": c.ki, "kd": c.kd})
        assert found["omega1"] == pytest.approx(abs(pairs[0]), rel=1e-9)
        assert found["zeta2"] == pytest.approx(-pairs[1].real / abs(pairs[1]), rel=1e-9)


def test_set_point_formulas_solve_their_equation() -> None:
    """Symbolically: the corrected b and T_sp make |F_sp G_sp| one at the resonance."""
    k, ki, kd, w, m = sp.symbols("k k_i k_d w M", positive=True)
    a = k**2 * w**2 + (ki - w**2 * kd) ** 2
    b = sp.sqrt(a - ki**2 * m**2) / (k * w * m)  # (13)
    assert sp.simplify((ki**2 + (b * k * w) ** 2) / a * m**2 - 1) == 0
    t = sp.sqrt(ki**2 * m**2 / a - 1) / w  # (16) with w
    assert sp.simplify(ki**2 / a * m**2 / (1 + (w * t) ** 2) - 1) == 0
    full = sp.sqrt(((ki**2 + k**2 * w**2) * m**2 - a) / a) / w
    assert sp.simplify((ki**2 + (k * w) ** 2) / a * m**2 / (1 + (w * full) ** 2) - 1) == 0
    assert sp.simplify(full.subs(kd, 0) ** 2 - (m**2 - 1) / w**2) == 0  # the printed PI case


def test_the_code_has_these_formulas() -> None:
    c, peak = PID(1.2, 0.5, 0.9), setpoint.Resonance(0.9, 1.4)
    for b, time in (
        (setpoint.weight_from_peak(PID(1.2, 0.3, 0.1), peak), 0.0),
        (1.0, setpoint.full_weight_filter_corrected(c, peak)),
    ):
        used = c if time else PID(1.2, 0.3, 0.1)
        assert b > 0.0
        s = 1j * peak.frequency
        gain = abs((used.ki + b * used.k * s) / (used.ki + used.k * s + used.kd * s**2) / (1 + s * time)) * peak.value
        assert gain == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("row", ["G2 Ms=1.4", "G8 Ms=1.4", "G4 Ms=1.4"])
def test_exact_weight_limit_is_sharp(row: str) -> None:
    c = optimal(row)
    limit = setpoint.exact_weight_limit(c)
    w = np.geomspace(1e-4, 1e3, 200001)

    def left(b: float) -> float:
        return float(np.max(np.abs((c.ki + 1j * b * c.k * w) / (c.ki + 1j * c.k * w - c.kd * w**2))))

    assert left(limit) <= 1.0 + 1e-9
    assert left(1.05 * limit) > 1.0 + 1e-6
    assert weight_peak(c, 1.3 * limit) == pytest.approx(left(1.3 * limit), rel=1e-7)


def test_noise_response_by_simulation() -> None:
    controller = noise_figures.filtered("n2_N5")
    num, den = controller.feedback_polynomials()
    feedback = control.tf(num, den)
    t = np.linspace(0.0, 2.0, 40001)
    noise = np.sin(noise_figures.NOISE_FREQUENCY * t)
    for to, system in (
        ("y", control.feedback(control.tf([1.0], [1.0]), g4() * feedback)),
        ("u", -control.feedback(feedback, g4())),
    ):
        simulated = control.forced_response(control.ss(system), t, noise).outputs
        assert noise_figures.noise_response(controller, t, to=to) == pytest.approx(simulated, abs=2e-5)


def test_filter_table_angle_and_noise_gain() -> None:
    frame = filters.numbers(*filters.by_the_text("n1_N5"))
    assert frame["argFy"] == pytest.approx(np.degrees(np.angle(1.0 / (1.0 + 0.2j))), rel=1e-12)
    controller = noise_figures.filtered("n1_N5")
    s = 1j * np.geomspace(1e-2, 1e6, 200001)
    c = (controller.k + controller.ki / s + controller.kd * s) / (1.0 + s * controller.measurement_filter)
    assert frame["Mn"] == pytest.approx(np.max(np.abs(c / (1.0 + c / (s + 1) ** 4))), rel=1e-6)


@pytest.mark.parametrize("kd", [1.0, 2.0, 3.0])
def test_largest_ki_at_fixed_kd_by_brute_force(kd: float) -> None:
    found = feasible.best(kd)
    assert found is not None
    w = np.geomspace(0.02, 6.0, 3000)
    g = 1.0 / (1.0 + 1j * w) ** 4

    def allowed(k: float, ki: float) -> bool:
        distance = np.abs(1.0 + (k + ki / (1j * w) + 1j * w * kd) * g)
        roots = np.roots(np.polyadd(np.append(np.poly([-1.0] * 4), 0.0), [kd, k, ki]))
        return bool(distance.min() >= 1.0 / 1.4 and roots.real.max() < 0.0)

    k = np.concatenate([np.linspace(0.02, 1.5, 60), found.k + np.linspace(-2e-3, 2e-3, 21)])
    assert not any(allowed(float(x), found.ki * 1.003) for x in k)
    assert any(allowed(float(x), found.ki * 0.99) for x in found.k + np.linspace(-1e-2, 1e-2, 41))


def test_curvature_of_a_loop_by_differences() -> None:
    row = "G8 Ms=2.0"
    c, plant = printed("II-table-1", row), PLANTS[split(row)[0]]
    w = np.linspace(0.3, 1.2, 90001)
    value = Loop(plant, c)(1j * w)
    first, second = np.gradient(value, w), np.gradient(np.gradient(value, w), w)
    curvature = (first.real * second.imag - first.imag * second.real) / np.abs(first) ** 3
    assert largest_over("curvature", plant, c, (0.3, 1.2)) == pytest.approx(curvature[5:-5].max(), rel=1e-3)


def test_largest_gain_of_four_lags() -> None:
    # k = (4 cos^3 x cos(4x - pi) ...) has no closed form here: a plain grid over the left vertices
    w = np.linspace(0.5, 2.0, 300001)
    g = 1.0 / (1.0 + 1j * w) ** 4
    left = -g.real / np.abs(g) ** 2 - 1.0 / (1.4 * np.abs(g))
    assert largest_gain(PLANTS["G4"], 1.4) == pytest.approx(left.max(), rel=1e-8)


def test_curvature_alone_does_not_exclude_a_rising_phase() -> None:
    stated, rival = optimal("G4 Ms=1.4"), feasible.best(3.0)
    assert rival is not None
    assert rival.ki > 1.5 * stated.ki
    w = np.geomspace(1e-2, 20.0, 400001)
    value = (rival.k + rival.ki / (1j * w) + 3.0j * w) / (1.0 + 1j * w) ** 4
    assert np.abs(1.0 + value).min() >= 1.0 / 1.4 - 1e-7
    assert np.roots(np.polyadd(np.append(np.poly([-1.0] * 4), 0.0), [3.0, rival.k, rival.ki])).real.max() < 0.0
    first = np.gradient(value, w)
    second = np.gradient(first, w)
    assert (first.real * second.imag - first.imag * second.real)[3:-3].max() < 0.0
    assert np.diff(np.unwrap(np.angle(value))).max() > 0.0


def test_what_the_digits_leave_open() -> None:
    full = paper.load().exhibits[tables.REPLACEMENT]
    assert isinstance(full, Table)
    rows = ("G3 Ms=2.0", "G8 Ms=1.4")
    values = {key: PrintedValue(text, *key) for key, text in paper.printed_cells(full.id).items() if key[0] in rows}
    _, ranges = compute_reading(replace(full, rows=rows), full.readings["printed-gains"], values)
    # IE = Ti/k grows with Ti and falls with k: its ends are two corners
    assert ranges.lower["G8 Ms=1.4", "IE"] == pytest.approx(2.245 / 0.3125, rel=1e-12)
    assert ranges.upper["G8 Ms=1.4", "IE"] == pytest.approx(2.255 / 0.3115, rel=1e-12)
    # b = sqrt(Td/Ti), (15)
    assert ranges.lower["G3 Ms=2.0", "b"] == pytest.approx((0.125 / 0.1895) ** 0.5, rel=1e-12)
    assert ranges.upper["G3 Ms=2.0", "b"] == pytest.approx((0.135 / 0.1885) ** 0.5, rel=1e-12)
    # one point of the box for the row: gains that round to the printed ones
    point = ranges.points["G3 Ms=2.0"]
    assert all(abs(point[name] - printed_number(full.id, "G3 Ms=2.0", name)) <= half + 1e-12
               for name, half in (("k", 0.05), ("Ti", 0.0005), ("Td", 0.005)))  # fmt: skip
