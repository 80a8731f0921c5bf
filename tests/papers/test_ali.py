"""Ali and Majhi against sympy, mpmath, python-control and closed forms, which share no code with it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Literal

import control
import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from loops.references import talbot
from numpy.typing import NDArray

from replicate.exhibits import Table
from replicate.loops import Loop
from replicate.papers.ali import iste, paper, sensitivities, sensitivity_count, tuning
from replicate.papers.ali.examples import example_1, example_2
from replicate.papers.ali.structures import (
    ALPHA,
    STRUCTURES,
    Settings,
    d_filter,
    plant,
    series,
)
from replicate.papers.ali.toolchain import norm_estimate, pade_sensitivity_norm, pade_sensitivity_peak

ROWS = [Fraction(k, 10) for k in range(1, 11)]


@pytest.fixture(scope="module")
def exhibits() -> dict[str, Table]:
    return {id: exhibit for id, exhibit in paper.load().exhibits.items() if isinstance(exhibit, Table)}


# -------------------------------------------------------------------------------------------------- structures and Ms


def transfer(structure: str, k: Settings, s: Any) -> Any:
    """The controller's textbook formula, for mpmath numbers as for floats."""
    lag = 1 + s * ALPHA * k.Td
    return {
        "series": k.Kp * (1 + 1 / (s * k.Ti)) * (1 + s * k.Td) / lag,
        "d-filter": k.Kp * (1 + 1 / (s * k.Ti)) * (1 + s * k.Td / lag),
        "ideal": k.Kp * (1 + 1 / (s * k.Ti) + s * k.Td / lag),
        "ideal-on-output": k.Kp * (1 + 1 / (s * k.Ti) + s * k.Td / lag),
    }[structure]


@pytest.mark.parametrize("structure", STRUCTURES)
def test_structures_are_their_textbook_formulas(structure: str) -> None:
    settings = Settings(2.018, 11.15, 0.3427)
    pid = STRUCTURES[structure](settings)
    for s in (0.3 + 2.0j, 5.0j, 40.0 + 1.0j):
        expected = transfer(structure, settings, s)
        assert abs(complex(pid.feedback(s)) - expected) < 1e-13 * abs(expected)
        if structure == "ideal-on-output":  # the set point is not differentiated
            expected -= settings.Kp * s * settings.Td / (1 + s * ALPHA * settings.Td)
        assert abs(complex(pid.feedforward(s)) - expected) < 1e-13 * abs(complex(pid.feedback(s)))


@pytest.mark.parametrize("row", ["0.1", "0.5", "0.9"])
@pytest.mark.parametrize("reading", ["as-written", "filter-on-d"])
def test_exact_sensitivity_peaks(exhibits: dict[str, Table], row: str, reading: str) -> None:
    x = Fraction(row)
    settings = Settings(math.sqrt(2 / x), tuning.integral_time(x), float(x / 2))
    structure = "series" if reading == "as-written" else "d-filter"
    with mp.workdps(30):

        def distance2(w: mp.mpf) -> mp.mpf:
            s = mp.mpc(0, w)
            value = 1 + transfer(structure, settings, s) * mp.exp(-s * mp.mpf(x.numerator) / x.denominator) / (s - 1)
            return abs(value) ** 2

        coarse = np.geomspace(0.05, 400.0, 400)
        start = coarse[np.argmin([float(distance2(w)) for w in coarse])]
        w = mp.findroot(lambda w: mp.diff(distance2, w), mp.mpf(start))
        expected = float(1 / mp.sqrt(distance2(w)))
    computed = exhibits["table-1"].readings[reading].compute()["Ms"].to_dict()[row]
    assert computed == pytest.approx(expected, rel=1e-11)


def test_pade_peak_agrees_with_python_control_on_a_grid() -> None:
    settings, theta = Settings(1.52, 7.68, 0.35), 0.7
    s = control.tf("s")
    lag = 1 + ALPHA * settings.Td * s
    loop = settings.Kp * (1 + 1 / (settings.Ti * s)) * (1 + settings.Td * s / lag) / (s - 1)
    loop = loop * control.tf(*control.pade(theta, 3))
    w = np.linspace(2.0, 3.0, 200001)
    expected = np.max(np.abs(1 / (1 + loop(1j * w))))
    assert pade_sensitivity_peak(theta, d_filter(settings), 3) == pytest.approx(expected, rel=1e-9)


def test_norm_estimate_is_a_lower_bound_within_its_tolerance() -> None:
    for theta in (0.1, 0.3, 0.6, 0.9):
        x = Fraction(round(10 * theta), 10)
        controller = d_filter(Settings(math.sqrt(2 / x), tuning.integral_time(x), theta / 2))
        peak = pade_sensitivity_peak(theta, controller, 3)
        for tolerance in (0.01, 1e-4):
            estimate = pade_sensitivity_norm(theta, controller, 3, tolerance)
            assert estimate <= peak * (1 + 1e-9) <= estimate * (1 + tolerance) * (1 + 1e-9)


def test_norm_estimate_of_a_resonance_is_its_closed_form() -> None:
    for zeta in (0.05, 0.3, 0.6):
        estimate = norm_estimate(np.array([1.0]), np.array([1.0, 2 * zeta, 1.0]))
        assert estimate == pytest.approx(1 / (2 * zeta * math.sqrt(1 - zeta**2)), rel=1e-12)


def test_reconstruction_meets_every_printed_sensitivity_two_of_them_by_truncation(exhibits: dict[str, Table]) -> None:
    truncated = []
    for id in ("table-1", "table-2"):
        computed = exhibits[id].readings["authors"].compute()["Ms"].to_dict()
        for (row, column), text in paper.printed_cells(id).items():
            if column == "Ms":
                assert float(text) - 0.005 <= computed[row] < float(text) + 0.01  # rounds or truncates to the print
                truncated += [(id, row)] * (computed[row] > float(text) + 0.005)
    assert truncated == [("table-1", "0.2"), ("table-1", "0.7")]  # as the notes say


# --------------------------------------------------------------------------------------- tangency, cubic and stability


@pytest.mark.parametrize("x", ROWS, ids=str)
def test_design_loop_meets_the_specification_only_with_the_other_sign_of_q(
    exhibits: dict[str, Table], x: Fraction
) -> None:
    row = exhibits["tangency"].readings["as-written"].compute().loc[str(float(x))]
    theta, gain = float(x), math.sqrt(2 / x)
    w = np.geomspace(1e-2, 1e5, 40001)
    for suffix in ("", "_tangency"):
        s, ti = 1j * w, row["Ti" + suffix]
        sampled = np.max(np.abs(1 / (1 + gain * (1 - theta * s / 2) * (1 + s * ti) / (s * ti * (s - 1)))))
        assert row["Ms_design" + suffix] == pytest.approx(sampled, rel=1e-6)
    assert row["Ms_design"] == pytest.approx(1 / (1 - math.sqrt(x / 2)), rel=1e-12)
    assert row["Ms_design_tangency"] == pytest.approx(row["Ms_star"], rel=1e-12)
    # and yet the printed Ti, never smaller, really gives the smaller Ms
    assert row["Ti"] >= row["Ti_tangency"]
    assert row["Ms"] <= row["Ms_tangency"]


def test_cubic_is_the_least_squares_fit_to_the_printed_data(exhibits: dict[str, Table]) -> None:
    texts = {**paper.printed_cells("table-2"), **paper.printed_cells("table-1")}
    data = {Fraction(row): Fraction(text) for (row, column), text in texts.items() if column == "Ti"}
    assert len(data) == 10
    matrix = sp.Matrix([[sp.Rational(x.numerator, x.denominator) ** n for n in (3, 2, 1, 0)] for x in data])
    values = sp.Matrix([sp.Rational(v.numerator, v.denominator) for v in data.values()])
    expected = (matrix.T * matrix).LUsolve(matrix.T * values)  # exact normal equations
    computed = exhibits["eq-11"].readings["as-written"].compute()["coefficient"]
    assert computed.tolist() == pytest.approx([float(c) for c in expected], rel=1e-10)
    printed = paper.printed_cells("eq-11")
    for row, value in zip(computed.index, expected, strict=True):
        text = printed[row, "coefficient"]
        assert f"{float(value):.{len(text.split('.')[1])}f}" == text


def characteristic(structure: str, settings: Settings, theta: mp.mpf) -> Callable[[mp.mpc], mp.mpc]:
    return lambda s: 1 + transfer(structure, settings, s) * mp.exp(-s * theta) / (s - 1)


@pytest.mark.parametrize("id", ["table-1-0.1", "table-1-0.6", "table-1-0.9", "table-2-1.0", "eq-11-0.5"])
def test_rightmost_poles_and_gain_intervals(exhibits: dict[str, Table], id: str) -> None:
    frame = exhibits["stability"].readings["as-written"].compute()
    row = {str(column): float(frame[column][id]) for column in frame.columns}
    x = Fraction(id.rsplit("-", 1)[1])
    theta = float(x)
    a3, a2, a1, a0 = (float(text) for text in paper.printed_cells("eq-11").values())
    ti = tuning.integral_time(x) if id.startswith("table") else ((a3 * theta + a2) * theta + a1) * theta + a0
    settings = Settings(row["KKp"], ti, theta / 2)
    with mp.workdps(30):
        f = characteristic("series", settings, mp.mpf(theta))
        pole = mp.findroot(f, mp.mpc(row["pole_re"], row["pole_im"]))
        assert abs(pole - mp.mpc(row["pole_re"], row["pole_im"])) < 1e-10
    # Encirclements of -1 by the Nyquist curve: one counter-clockwise turn for one unstable plant pole, at the gain
    # itself and just inside the interval, and not just outside.
    for gain, stable in (
        (row["KKp"], True), (row["KKp_min"] * 1.001, True), (row["KKp_max"] * 0.999, True),
        (row["KKp_min"] * 0.999, False), (row["KKp_max"] * 1.001, False),
    ):  # fmt: skip
        assert (encirclements(Settings(gain, ti, theta / 2), theta) == 1) is stable


def encirclements(settings: Settings, theta: float) -> int:
    """Counter-clockwise turns of 1 + L along the imaginary axis, indented to the right of the integrator's pole."""
    w = np.geomspace(1e-5, 1e4, 400001)
    s = 1j * w
    curve = 1 + transfer("series", settings, s) * np.exp(-s * theta) / (s - 1)
    half = np.sum(np.angle(curve[1:] / curve[:-1]))
    # From w = 0+ back over the small half circle: L is -KKp/(s Ti) there and turns by pi.
    indent = 1e-5 * np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 2001))
    small = 1 + transfer("series", settings, indent) * np.exp(-indent * theta) / (indent - 1)
    return round(float(2 * half + np.sum(np.angle(small[1:] / small[:-1]))) / (2 * np.pi))


# ----------------------------------------------------------------------------------------------------------- examples


def delayed_terms(structure: str, settings: Settings, theta: float, load: bool, times: Sequence[float]) -> list[float]:
    """The output as a finite sum over round trips through the dead time, each term a rational transform.

    y = sum over n of (-1)^n (G0 C)^(n+1) e^(-(n+1) theta s)/s, for the load (-1)^n G0 (G0 C)^n e^(-(n+1) theta s)/s.
    Up to time t the terms with (n + 1) theta < t count, and each is inverted without dead time (Talbot's contour).
    """

    def term(n: int, t: mp.mpf) -> mp.mpf:
        def transform(s: mp.mpc) -> mp.mpc:
            round_trip = transfer(structure, settings, s) / (s - 1)
            return round_trip**n * (1 / (s - 1) if load else round_trip) / s

        return (-1) ** n * talbot(transform, t)

    with mp.workdps(40):
        theta, found = mp.mpf(str(theta)), []
        for time in times:
            t = mp.mpf(str(time))
            count = int(mp.floor(t / theta))
            found.append(float(sum(term(n, t - (n + 1) * theta) for n in range(count))))
        return found


@pytest.mark.parametrize(
    ("theta", "structure", "settings", "times"),
    [
        (0.7, "series", example_1()["proposed"], (1.3, 2.0, 9.0)),
        (0.2, "ideal", example_2()["visioli-load"], (0.5, 2.3)),
    ],
)
def test_responses_agree_with_the_sum_over_round_trips(
    theta: float, structure: str, settings: Settings, times: Sequence[float]
) -> None:
    loop = Loop(plant(theta), STRUCTURES[structure](settings))
    for load, signal in ((False, loop.step(until=max(times))), (True, loop.load_step(until=max(times)))):
        expected = delayed_terms(structure, settings, theta, load, times)
        assert signal(np.array(times)) == pytest.approx(expected, rel=1e-11)


def test_first_dead_time_of_the_control_signal_is_its_closed_form(exhibits: dict[str, Table]) -> None:
    # Until the output moves, u is the controller's own step response; (2) starts at Kp/alpha.
    settings, theta = example_1()["padma-sree"], 0.7
    u = Loop(plant(theta), series(settings)).respond(until=2 * theta).control
    lag = ALPHA * settings.Td
    t = np.linspace(0.0, 0.69, 50)
    fade = np.exp(-t / lag)
    lead = 1.0 + (settings.Td / lag - 1.0) * fade
    integral = t + (settings.Td - lag) * (1.0 - fade)
    assert u(t) == pytest.approx(settings.Kp * (lead + integral / settings.Ti), rel=1e-12)
    row = exhibits["example-1"].readings["as-written"].compute()["padma-sree"]
    assert row["u0"] == pytest.approx(settings.Kp / ALPHA, rel=1e-12)


def test_loads_are_cancelled_with_ie_equal_to_ti_over_kp(exhibits: dict[str, Table]) -> None:
    # A load response that does not change sign has IAE = IE = Ti/Kp; one that does has more.
    for id, row in (("example-1", "proposed"), ("example-2", "proposed")):
        settings = (example_1() if id == "example-1" else example_2())[row]
        found = exhibits[id].readings["as-written"].compute()[row]
        assert settings.Ti / settings.Kp <= found["load_iae"] <= 1.1 * settings.Ti / settings.Kp


def test_visioli_load_setting_is_unstable_in_2_and_stable_in_parallel_form(exhibits: dict[str, Table]) -> None:
    for reading, sign in (("as-written", 1), ("filter-on-d", 1), ("ideal", -1)):
        row = exhibits["example-2"].readings[reading].compute()["visioli-load"]
        assert math.copysign(1, row["pole_re"]) == sign
        assert math.isnan(row["ts"]) is (sign > 0)
        structure = {"as-written": "series", "filter-on-d": "d-filter", "ideal": "ideal"}[reading]
        with mp.workdps(30):
            pole = mp.findroot(
                characteristic(structure, example_2()["visioli-load"], mp.mpf("0.2")), mp.mpc(row["pole_re"], 10.0)
            )
        assert float(pole.real) == pytest.approx(row["pole_re"], rel=1e-9)


@pytest.mark.parametrize(("form", "kind"), [("series", "setpoint"), ("series", "load"), ("parallel", "load")])
def test_iste_by_parseval(form: str, kind: Literal["setpoint", "load"]) -> None:
    # the transform of t e(t) is -dE/ds, so the ISTE is the integral of |dE/dw|^2 over all w, over 2 pi
    settings, theta = Settings(4.0, 0.9, 0.11), 0.2

    def error(w: NDArray[np.float64]) -> NDArray[np.complex128]:
        s = 1j * w
        delay = np.exp(-theta * s)
        if form == "series":
            controller = (1 + 1 / (s * settings.Ti)) * (1 + s * settings.Td) / (1 + s * settings.Td / 10)
        else:
            controller = 1 + 1 / (s * settings.Ti) + s * settings.Td
        loop = settings.Kp * controller * delay / (s - 1)
        return np.asarray((1 if kind == "setpoint" else delay / (s - 1)) / s / (1 + loop))

    w, step = np.linspace(1e-3, 400.0, 400_001), 1e-5
    slope = (error(w + step) - error(w - step)) / (2 * step)
    total = np.trapezoid(np.abs(slope) ** 2, w) / np.pi
    assert iste.iste(Loop(plant(theta), iste.FORMS[form](settings)), kind) == pytest.approx(total, rel=1e-3)


@pytest.mark.parametrize("kind", ["setpoint", "load"])
def test_settings_of_smallest_iste_cannot_be_bettered_nearby(kind: Literal["setpoint", "load"]) -> None:
    found = iste.best("parallel", kind)
    lowest = iste.iste(Loop(plant(0.2), iste.parallel(found)), kind)
    for name in ("Kp", "Ti", "Td"):
        for factor in (0.97, 1.03):
            moved = replace(found, **{name: factor * getattr(found, name)})
            assert iste.iste(Loop(plant(0.2), iste.parallel(moved)), kind) > lowest


def test_total_variation_counts_moves_and_jumps() -> None:
    # An undamped loop's sine: k = 1 around 1/(s^2 + 1) has u = cos(sqrt(2) t)/2 + 1/2 after a unit step.
    from replicate.loops import PI, Plant

    period = 2 * math.pi / math.sqrt(2.0)
    u = Loop(Plant([1.0], [1.0, 0.0, 1.0]), PI(k=1.0)).respond(until=3 * period).control
    assert u.total_variation() == pytest.approx(1.0 + 3 * 2.0, rel=1e-10)


def test_every_hypothesis_on_the_sensitivities_is_counted_as_tried() -> None:
    assert len(sensitivity_count.HYPOTHESES) == sensitivities.TRIED
