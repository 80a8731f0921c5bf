"""Exercises with numbers of every paper: solvable, told from common mistakes, and right by formulas of their own."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable
from importlib import import_module

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy import integrate

from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Inputs, Variation
from replicate.handout import stressed
from replicate.run.library import Library

PAPERS = ("ali", "bayhan", "khan", "krajewski", "panagopoulos")
FORMS = ("one", "two", "three")


def exercises(paper: str) -> Exercises:
    found: Exercises = import_module(f"replicate.papers.{paper}.handout").exercises
    return found


ALL = [(paper, name) for paper in PAPERS for name in exercises(paper).variations]


def variation(paper: str, name: str) -> Variation:
    return exercises(paper).variations[name]


def drawn(paper: str, name: str) -> list[Inputs]:
    found = variation(paper, name)
    return [found.original, *(found.drawn(form) for form in FORMS)]


@pytest.mark.parametrize(("paper", "name"), ALL)
def test_an_exercise_stands_the_stress_and_names_two_mistakes(paper: str, name: str) -> None:
    found = variation(paper, name)
    assert list(stressed(found, 40))
    for answer in found.answers(found.drawn("one")).values():
        assert len(answer.mistakes) >= 2
        assert answer.asked or paper == "bayhan"


@pytest.mark.parametrize("paper", PAPERS)
def test_every_exercise_varies_or_says_why_not(paper: str) -> None:
    text = (Library(bundled=True).paper(paper).folder() / "handout.md").read_text(encoding="utf-8")
    heads = re.findall(r"^::: exercise\n## .*?\{(.*)\}$", text, re.MULTILINE)
    assert len(heads) == text.count("\n::: exercise\n") >= 7
    for head in heads:
        assert (' vary="' in f" {head}") != (' fixed="' in f" {head}")
    named = re.findall(r'vary="([^"]*)"', text)
    assert sorted(named) == sorted(exercises(paper).variations)


@pytest.mark.parametrize("paper", ["ali", "bayhan", "khan"])
def test_the_response_before_the_output_knows_by_quadrature(paper: str) -> None:
    for inputs in drawn(paper, "sketch"):
        p, g, L, k, ki = (float(inputs[key]) for key in ("p", "g", "L", "k", "ki"))
        area, _ = integrate.quad(lambda s: math.exp(p * (L - s)) * (k + ki * s), 0.0, L)  # noqa: B023
        assert variation(paper, "sketch").answers(inputs)["y(2L)"].value == pytest.approx(g * area, rel=1e-9)


@pytest.mark.parametrize("paper", ["bayhan", "krajewski"])
def test_the_control_effort_by_small_steps_of_time(paper: str) -> None:
    for inputs in drawn(paper, "effort"):
        K, T, L, k, ki, U = (float(inputs[key]) for key in ("K", "T", "L", "k", "ki", "U"))
        step, lag = 1e-3, round(L / 1e-3)
        y, total, signals = 0.0, 0.0, [0.0] * lag
        for _ in range(round(30 * (T + L) / step)):  # Euler's method
            signals.append(k * (1 - y) + ki * total)
            total += (1 - y) * step
            y += step * (K * signals[-1 - lag] - y) / T
        found = variation(paper, "effort").answers(inputs)
        assert found["u(0+)"].value == pytest.approx(signals[lag], rel=1e-3)
        assert found["u(L)"].value == pytest.approx(signals[2 * lag], rel=2e-3)
        assert found["u(inf)"].value == pytest.approx(signals[-1], rel=2e-2)
        assert max(signals) == pytest.approx(found["u(L)"].value, rel=2e-3)
        assert found["largest step"].value == pytest.approx(U / max(signals), rel=2e-3)


@pytest.mark.parametrize("paper", ["krajewski", "panagopoulos"])
def test_windup_by_small_steps_of_time(paper: str) -> None:
    for inputs in drawn(paper, "windup"):
        K, T, L, k, ki, U = (float(inputs[key]) for key in ("K", "T", "L", "k", "ki", "U"))
        found = variation(paper, "windup").answers(inputs)
        step, lag = 5e-4, round(L / 5e-4)
        for held in (False, True):
            y, total, time, signals = 0.0, 0.0, 0.0, [0.0] * lag
            while y < 1.0:  # Euler's method
                command = k * (1 - y) + total
                if held and command < U:
                    break
                assert command > U  # at its limit until then
                signals.append(U)
                total += 0.0 if held else ki * (1 - y) * step
                y += step * (K * signals[-1 - lag] - y) / T
                time += step
            if held:
                assert time == pytest.approx(found["left"].value, rel=2e-3)
            else:
                assert time == pytest.approx(found["reached"].value, rel=3e-3)
                assert total == pytest.approx(found["integral"].value, rel=3e-3)


def test_no_windup_in_which_the_forgotten_gain_does_not_show() -> None:
    inputs = {"K": 2.0, "T": 4.5, "L": 0.5, "k": 3.9, "ki": 0.6, "U": 0.75}
    assert math.isclose(2.0 * 0.75 / (2.0 * 0.75 - 1.0), 0.75 / (1.0 - 0.75))  # with the gain, and without
    refused = [words for words, holds in variation("krajewski", "windup").requires.items() if not holds(inputs)]
    assert refused == ["no mistake is accepted"]


LOOPS = {
    "krajewski": lambda s, x: (x["b"] + x["a"] / s) * np.exp(-x["tau"] * s) / (1 + s),
    "panagopoulos": lambda s, x: (x["k"] + x["ki"] / s) / ((x["T"] * s + 1) * (s + 1) ** 2),
    "ali": lambda s, x: (x["k"] + x["ki"] / s) * np.exp(-x["theta"] * s) / (s - 1),
}


@pytest.mark.parametrize("paper", sorted(LOOPS))
def test_margins_and_peak_on_a_dense_grid_of_frequencies(paper: str) -> None:
    w = np.geomspace(1e-2, 1e2, 400_001)
    for inputs in drawn(paper, "nyquist"):
        L = LOOPS[paper](1j * w, inputs)
        found = variation(paper, "nyquist").answers(inputs)
        assert found["Ms"].value == pytest.approx(1 / np.min(np.abs(1 + L)), rel=1e-4)
        crossings = L.real[:-1][(L.imag[:-1] * L.imag[1:] < 0) & (L.real[:-1] < 0) & (L.real[:-1] > -1)]
        assert found["gain margin"].value == pytest.approx(1 / -crossings.min(), rel=1e-3)
        enters = np.flatnonzero((np.abs(L[:-1]) > 1) & (np.abs(L[1:]) <= 1))
        phase = min(abs(math.degrees(math.pi - abs(np.angle(L[place])))) for place in enters)
        assert found["phase margin"].value == pytest.approx(phase, abs=0.05)


def test_a_bode_plot_on_a_dense_grid_of_frequencies() -> None:
    w = np.geomspace(1e-2, 1e1, 200_001)
    for inputs in drawn("khan", "bode"):
        K, T, L, k, ki = (float(inputs[key]) for key in ("K", "T", "L", "k", "ki"))
        curve = K * np.exp(-1j * w * L) / (1 + 1j * w * T) * (k + ki / (1j * w))
        decibels, phase = 20 * np.log10(np.abs(curve)), np.degrees(np.unwrap(np.angle(curve)))
        found = variation("khan", "bode").answers(inputs)
        gain = 10 ** (-np.interp(180.0, -phase, decibels) / 20)
        assert found["gain margin"].value == pytest.approx(gain, rel=1e-4)
        assert found["phase margin"].value == pytest.approx(180.0 + np.interp(0.0, -decibels, phase), abs=0.01)
        assert found["Ms"].value == pytest.approx(1 / np.min(np.abs(1 + curve)), rel=1e-5)
        assert found["Ms"].accepts(10 ** ((20 * math.log10(found["Ms"].value) + 0.45) / 20))  # read off by 0.45 dB


@pytest.mark.parametrize("form", range(4))
def test_frequencies_of_a_bode_plot_are_named_at_one_two_and_five(form: int) -> None:
    bode = variation("khan", "bode")
    canvas = Figure()
    bode.figures["bode"].draw(canvas, inputs=bode.drawn(f"{form}"))
    axis = canvas.axes[1].xaxis
    first, last = axis.get_view_interval()

    def in_sight(places: Iterable[float]) -> list[float]:
        return sorted(at for at in places if first <= at <= last)

    labels = zip(axis.get_ticklocs(minor=True), axis.get_ticklabels(minor=True), strict=True)
    named = {*axis.get_majorticklocs(), *(place for place, label in labels if label.get_text())}
    expected = [mantissa * 10.0**power for power in range(-4, 4) for mantissa in (1, 2, 5)]
    assert sorted(at for at in named if first <= at <= last) == pytest.approx(
        [at for at in expected if first <= at <= last]
    )


@pytest.mark.parametrize("paper", ["khan", "panagopoulos"])
def test_a_step_test_is_identified_from_its_file_alone(paper: str) -> None:
    """The method of areas: L + T is the area above the response, relative to the final value."""
    for inputs in drawn(paper, "step-test"):
        found = variation(paper, "step-test")
        ((name, text),) = found.files(inputs).items()
        assert name == "step-test.csv"
        rows = list(csv.DictReader(io.StringIO(text)))
        t, y = (np.array([float(row[column]) for row in rows]) for column in "ty")
        final = y[t > 0.8 * t[-1]].mean()
        answers = found.answers(inputs)
        assert answers["K"].accepts(final / float(inputs["u"]))
        area = float(np.trapezoid(1.0 - y / final, t))
        assert area == pytest.approx(answers["T"].value + answers["L"].value, rel=0.15)
        for key in "KTL":
            assert answers[key].accepts(float(inputs[key]))  # the true process


def test_the_jump_of_khan_by_hand() -> None:
    for inputs in drawn("khan", "jump"):
        p, h = float(inputs["p"]), float(inputs["h"])
        assert p * h == pytest.approx(0.2, rel=1e-9)
        found = variation("khan", "jump").answers(inputs)
        assert found["first KP"].value == pytest.approx(0.404 / h + 0.256 * p - 0.1275 * (p / h) ** 0.5, rel=1e-12)
        assert found["second KI"].value == pytest.approx(-0.525 * p**2 + 0.4104 * p / h - 0.00024 / h**2, rel=1e-12)


def test_the_design_for_a_dead_time_by_its_equations() -> None:
    for inputs in drawn("panagopoulos", "dead-time"):
        L, ms = float(inputs["L"]), float(inputs["Ms"])
        found = {name: answer.value for name, answer in variation("panagopoulos", "dead-time").answers(inputs).items()}
        x = found["w"] * L
        assert math.sin(x) + x * math.cos(x) == pytest.approx(1 / ms, abs=1e-6)
        assert found["k"] == pytest.approx(-math.cos(x), abs=1e-6)
        assert found["ki"] == pytest.approx(found["w"] * (math.sin(x) - 1 / ms), rel=1e-6)


def test_the_diagonal_of_krajewski_in_degrees() -> None:
    for inputs in drawn("krajewski", "diagonal"):
        found = variation("krajewski", "diagonal").answers(inputs)
        assert found["gain margin"].value == pytest.approx(90.0 / (90.0 - float(inputs["m"])), rel=1e-12)
        assert math.degrees(found["a tau"].value) == pytest.approx(90.0 - float(inputs["m"]), rel=1e-12)


def test_the_search_of_ali_by_trying() -> None:
    for inputs in drawn("ali", "smallest"):
        x = float(inputs["x"])
        found = variation("ali", "smallest").answers(inputs)
        tried = next(n / 10 for n in range(12, 200) if (1 - math.sqrt(x / 2)) ** 2 - (10 / n) ** 2 >= 0)
        assert found["stops at"].value == pytest.approx(tried, abs=1e-9)
        assert found["least"].value == pytest.approx(1 / (1 - math.sqrt(x / 2)), rel=1e-12)
    for inputs in drawn("ali", "means"):
        x = float(inputs["x"])
        found = variation("ali", "means").answers(inputs)
        assert found["geometric"].value == pytest.approx(math.sqrt(2 / x), rel=1e-12)
        assert found["arithmetic"].value == pytest.approx(0.5 + 1 / x, rel=1e-12)
