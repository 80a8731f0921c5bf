"""PID designs against a gradient-free search that shares nothing with them but the problem.

The search is differential evolution over (k, kd). For each pair the largest feasible ki is exact on a frequency
grid: with L linear in ki every constraint is a quadratic in ki at each frequency and forbids an interval, and the
answer is the top of the highest gap between the intervals in which the loop is stable. Stability is judged by the
roots of the characteristic polynomial, with dead time by the winding number. Derivatives with respect to frequency
are central differences.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.optimize import Bounds, brentq, differential_evolution, nnls

from replicate.loops import PI, Constraint, Loop, LoopError, PIDDesign, Plant, design_pi, design_pid, search_range
from replicate.loops.design import gain_map, pid_search
from replicate.loops.design.gain_map import Summit

LAG = np.array([1.0, 1.0])


def power(n: int) -> np.ndarray:
    product = np.array([1.0])
    for _ in range(n):
        product = np.polymul(product, LAG)
    return product


G3_DEN = np.polymul(np.polymul(LAG, [0.2, 1.0]), np.polymul([0.04, 1.0], [0.008, 1.0]))

# (num, den, dead time) of Panagopoulos (2000), paper II, section 4
PLANTS = {
    "G1": ([1.0], np.polymul(power(3), [1.0, 0.0]), 0.0),
    "G2": ([1.0], power(3), 5.0),
    "G3": ([1.0], G3_DEN, 0.0),
    "G4": ([1.0], power(4), 0.0),
    "G5": ([1.0], power(5), 0.0),
    "G6": ([1.0], power(6), 0.0),
    "G7": ([1.0], power(7), 0.0),
    "G8": ([-2.0, 1.0], power(3), 0.0),
}
INTEGRATING = ("G1", "G3")
CASES = [(name, ms) for name in PLANTS for ms in (1.4, 2.0)]
PLANTS["lightly damped"] = ([1.0], np.array([1.0, 0.4, 1.0]), 0.3)  # none of the paper's


def plant(name: str) -> Plant:
    num, den, dead_time = PLANTS[name]
    return Plant(num, den, dead_time=dead_time)


def shape(name: str) -> tuple[str, ...]:
    """Return the shape constraints of the text."""
    return ("phase",) if name in INTEGRATING else ("curvature", "phase")


@dataclass
class Search:
    """The independent search for one plant, one circle and a set of shape constraints on one frequency range."""

    name: str
    ms: float
    kinds: tuple[str, ...]
    span: tuple[float, float]
    points: int = 260

    def __post_init__(self) -> None:
        num, den, self.dead_time = PLANTS[self.name]
        self.num, self.den = np.asarray(num), np.asarray(den)
        # s den + (kd s^2 + k s + ki) num is the characteristic polynomial
        self.open_loop = np.append(self.den, 0.0)
        self.fed_back = np.zeros((3, self.open_loop.size))
        for row, end in zip(self.fed_back, (-2, -1, None), strict=True):
            row[:end][-self.num.size :] = self.num
        corner = self.ultimate()[1]
        self.w = np.geomspace(0.02 * corner, 8.0 * corner, self.points)
        low, high = self.span
        self.inner = np.linspace(low, min(high, 30.0 * corner), self.points)
        self.basis = self.jets(self.w)[:1], self.jets(self.inner)
        self.whole = self.columns(np.concatenate([np.geomspace(1e-6, 1e-2, 40), np.linspace(1e-2, 7.0, 500)]))

    def plant(self, s: np.ndarray) -> np.ndarray:
        return np.polyval(self.num, s) / np.polyval(self.den, s) * np.exp(-s * self.dead_time)

    def ultimate(self) -> tuple[float, float]:
        """Return (gain, frequency) at which the plant's phase first reaches -180 degrees."""
        w = np.geomspace(1e-3, 1e3, 40000)
        value = self.plant(1j * w)
        phase = np.unwrap(np.angle(value))
        i = int(np.argmax(phase <= -np.pi))
        return 1.0 / abs(value[i]), float(w[i])

    def columns(self, w: np.ndarray) -> np.ndarray:
        """Return what k, ki and kd are multiplied by in L, shape (3, n)."""
        g = self.plant(1j * w)
        return np.array([g, g / (1j * w), 1j * w * g])

    def jets(self, w: np.ndarray) -> np.ndarray:
        """Return the columns and their first two derivatives in w by central differences of fourth order."""
        h = 2e-3 * w
        at = {n: self.columns(w + n * h) for n in (-2, -1, 0, 1, 2)}
        first = (at[-2] - 8 * at[-1] + 8 * at[1] - at[2]) / (12 * h)
        second = (-at[-2] + 16 * at[-1] - 30 * at[0] + 16 * at[1] - at[2]) / (12 * h**2)
        return np.array([at[0], first, second])

    def quadratics(self, k: float, kd: float) -> np.ndarray:
        """Return a, b, c of every constraint ``a ki^2 + b ki + c >= 0``, shape (3, n)."""
        (position,), inner = self.basis
        rest = 1.0 + k * position[0] + kd * position[2]
        found = [
            np.array(
                [
                    np.abs(position[1]) ** 2,
                    2.0 * (np.conj(rest) * position[1]).real,
                    np.abs(rest) ** 2 - 1.0 / self.ms**2,
                ]
            )
        ]
        for kind in self.kinds:
            left, right = (1, 2) if kind == "curvature" else (0, 1)
            a1, a2 = (k * inner[n, 0] + kd * inner[n, 2] for n in (left, right))
            b1, b2 = inner[left, 1], inner[right, 1]
            found.append(
                -np.array(
                    [
                        (np.conj(b1) * b2).imag,
                        (np.conj(a1) * b2 + np.conj(b1) * a2).imag,
                        (np.conj(a1) * a2).imag,
                    ]
                )
            )
        return np.concatenate(found, axis=1)

    def largest_ki(self, k: float, kd: float) -> float:
        """Return the largest feasible ki with a stable loop, 0 if there is none."""
        a, b, c = self.quadratics(k, kd)
        inside = b**2 - 4.0 * a * c
        real = inside > 0.0
        if np.any(~real & (c < 0.0)):
            return 0.0
        root = np.sqrt(inside[real])
        a, b, c = a[real], b[real], c[real]
        q = -0.5 * (b + np.where(b >= 0.0, root, -root))
        with np.errstate(divide="ignore", invalid="ignore"):
            one, two = q / a, np.where(q != 0.0, c / q, 0.0)
        low, high = np.fmin(one, two), np.fmax(one, two)
        opens = a > 0.0  # forbidden between the roots; otherwise outside them
        starts = np.concatenate([low[opens], np.full((~opens).sum(), -np.inf), high[~opens]])
        ends = np.concatenate([high[opens], low[~opens], np.full((~opens).sum(), np.inf)])
        order = np.argsort(starts)
        starts, ends = starts[order], np.maximum.accumulate(ends[order])
        floor = np.maximum(np.concatenate([[0.0], ends[:-1]]), 0.0)
        for i in np.nonzero(starts > floor)[0][::-1]:
            if np.isfinite(starts[i]) and self.stable(k, floor[i] + 0.7 * (starts[i] - floor[i]), kd):
                return float(starts[i])
        return 0.0

    def stable(self, k: float, ki: float, kd: float) -> bool:
        if self.dead_time:
            return self.winds_once(k, ki, kd)
        return bool(np.roots(self.open_loop + np.array([kd, k, ki]) @ self.fed_back).real.max() < 0.0)

    def winds_once(self, k: float, ki: float, kd: float) -> bool:
        """Whether 1 + L turns by +90 degrees from rest to infinity, as for a stable loop with one integrator."""
        value = 1.0 + np.array([k, ki, kd]) @ self.whole
        angle = np.unwrap(np.angle(value))
        # other counts differ by 180 degrees; a neutral loop keeps turning a little about the last value
        return bool(abs(angle[-1] - angle[0] - 0.5 * np.pi) < 0.8)

    def cost(self, x: np.ndarray) -> float:
        """Return -ki where there is a feasible one, else by how much the least bad of a few ki fails."""
        k, kd = (float(v) for v in x)
        ki = self.largest_ki(k, kd)
        if ki > 0.0:
            return -ki
        a, b, c = self.quadratics(k, kd)
        tried = np.geomspace(1e-4, 1.0, 9)[:, None] * k * self.w.max() + 1e-12
        size = np.abs(a) * tried**2 + np.abs(b) * tried + np.abs(c)
        return 1.0 - float(np.max(np.min((a * tried**2 + b * tried + c) / size, axis=1)))

    def run(self, popsize: int = 20) -> tuple[float, float, float]:
        """Return (ki, k, kd) of the best point found."""
        gain, w = self.ultimate()
        found = differential_evolution(
            self.cost,
            bounds=Bounds([0.0, -0.1 * gain / w], [2.0 * gain, 2.5 * gain / w]),
            rng=7,
            mutation=(0.4, 1.0),
            popsize=popsize,
            maxiter=80,
            tol=1e-4,
            polish=False,
        )
        k, kd = (float(v) for v in found.x)
        return -float(found.fun), k, kd


@cache
def designed(name: str, ms: float, kinds: tuple[str, ...]) -> tuple[PIDDesign, tuple[float, float]]:
    pi = design_pi(plant(name), ms=ms)
    span = search_range(plant(name), pi.k, pi.ki)
    return design_pid(plant(name), ms=ms, constraints=kinds), span


def compare(
    name: str, ms: float, kinds: tuple[str, ...], *, points: int = 260, popsize: int = 20, tolerance: float = 1e-6
) -> None:
    design, span = designed(name, ms, kinds)
    search = Search(name, ms, kinds, span, points)
    ki, _, _ = search.run(popsize)
    assert ki == pytest.approx(design.ki, rel=2e-3)
    # and the search's own judge finds the design feasible, to the accuracy of its derivatives
    assert search.stable(design.k, design.ki, design.kd)
    assert search.quadratics(design.k, design.kd).T @ [design.ki**2, design.ki, 1.0] == pytest.approx(
        np.maximum(search.quadratics(design.k, design.kd).T @ [design.ki**2, design.ki, 1.0], 0.0), abs=tolerance
    )


@pytest.mark.parametrize(("name", "ms"), CASES)
def test_stated_problem_is_solved(name: str, ms: float) -> None:
    compare(name, ms, shape(name))
    assert designed(name, ms, shape(name))[0].status == "optimal"


def test_the_optimum_of_a_lightly_damped_plant_is_found() -> None:
    # feasible gains are a needle about those whose zeros cancel the plant's poles
    compare("lightly damped", 1.4, ("curvature", "phase"))
    assert designed("lightly damped", 1.4, ("curvature", "phase"))[0].status == "optimal"


def test_what_a_fine_map_shows_is_an_optimum_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    # the resonance is so narrow that the circle is touched between the frequencies of the coarse grid
    climbs = []

    def ascend(*given: Any) -> Summit:
        climbs.append(given)
        return gain_map.ascend(*given)

    monkeypatch.setattr(pid_search, "ascend", ascend)
    resonant = Plant([9.0], np.polymul([1.0, 1.0], [1.0, 0.1, 9.0]))
    found = design_pid(resonant, ms=2.0)
    assert found.status == "optimal"
    assert Loop(resonant, found.controller).sensitivity_peak().value == pytest.approx(2.0, rel=1e-9)
    assert len(climbs) == 1


@pytest.mark.parametrize(("name", "ms"), [("G1", 2.0), ("G2", 1.4), ("G4", 1.4), ("G8", 2.0)])
def test_circle_alone(name: str, ms: float) -> None:
    compare(name, ms, ())


@pytest.mark.parametrize("ms", [1.4, 2.0])
def test_severe_constraints_push_the_optimum_far_from_the_pi_design(ms: float) -> None:
    # hardly any proportional action is left and the resonance is narrow: a coarse grid would look through it
    compare("G1", ms, ("curvature", "phase"), points=1000, popsize=30)


@pytest.mark.parametrize(("name", "ms"), CASES)
def test_optimality_conditions(name: str, ms: float) -> None:
    """-grad ki is a positive combination of the active gradients, each constraint touching zero from above."""
    kinds = shape(name)
    design, span = designed(name, ms, kinds)
    gains = np.array([design.k, design.ki, design.kd])
    search = Search(name, ms, kinds, span)
    assert {part.kind for part in design.active} <= {"sensitivity", *kinds}
    gradients = []
    for part in design.active:
        w = part.frequency

        def value(x: np.ndarray, at: float, kind: str = part.kind) -> float:
            jets = np.einsum("dxn,x->dn", search.jets(np.array([at])), x)[:, 0]
            if kind == "sensitivity":
                return float((ms * abs(1.0 + jets[0])) ** 2 - 1.0)
            if kind == "phase":
                return float(-(jets[1] / jets[0]).imag * at)
            return float(-(np.conj(jets[1]) * jets[2]).imag / abs(jets[1]) ** 3)

        assert value(gains, w) == pytest.approx(0.0, abs=3e-7)
        slope = (value(gains, w * 1.0001) - value(gains, w * 0.9999)) / 2e-4
        at_end = any(w == pytest.approx(end, rel=1e-9) for end in span)
        assert at_end or slope == pytest.approx(0.0, abs=1e-4)
        steps = np.diag(3e-4 * np.abs(gains))
        gradients.append([(value(gains + s, w) - value(gains - s, w)) / 6e-4 for s in steps])
    multipliers, residual = nnls(np.array(gradients).T, np.array([0.0, -1.0, 0.0]))
    assert residual < 1e-4
    assert multipliers == pytest.approx([part.multiplier for part in design.active], rel=1e-3)


def test_dead_time_design_is_stable_by_winding_number() -> None:
    for ms in (1.4, 2.0):
        for kinds in ((), shape("G2")):
            design, span = designed("G2", ms, kinds)
            search = Search("G2", ms, kinds, span)
            assert search.winds_once(design.k, design.ki, design.kd)
            assert not search.winds_once(4.0 * design.k, 4.0 * design.ki, 4.0 * design.kd)


def test_search_range_of_a_lag_of_fourth_order() -> None:
    pi = design_pi(plant("G4"), ms=1.4)
    low, high = search_range(plant("G4"), pi.k, pi.ki)

    def phase(w: float) -> float:
        return float(np.arctan2(w * pi.k, pi.ki) - 0.5 * np.pi - 4.0 * np.arctan(w))

    reached = [brentq(lambda w, a=angle: phase(w) + a, 1e-3, 50.0) for angle in (np.pi, 1.5 * np.pi)]
    assert high == pytest.approx(0.5 * sum(reached), rel=1e-3)
    w = np.linspace(0.2, 1.0, 400001)
    distance = np.abs(1.0 + (pi.k + pi.ki / (1j * w)) / (1.0 + 1j * w) ** 4)
    assert low == pytest.approx(0.5 * w[np.argmin(distance)], rel=1e-4)


SUBSETS = ((), ("curvature",), ("phase",), ("curvature", "phase"))


@pytest.mark.parametrize(("name", "ms"), [*((name, 1.4) for name in PLANTS), ("G1", 2.0), ("G4", 2.0)])
def test_fewer_constraints_never_give_less(name: str, ms: float) -> None:
    designs = {kinds: designed(name, ms, kinds) for kinds in SUBSETS}
    for fewer, (relaxed, span) in designs.items():
        for more, (strict, _) in designs.items():
            if set(fewer) < set(more):
                assert relaxed.ki >= strict.ki * (1.0 - 1e-9)
        # a relaxed design that wins by looking through a constraint would be caught by a fine grid
        assert relaxed.status in ("optimal", "not-polished")
        fine = Search(name, ms, fewer, span, points=20000).quadratics(relaxed.k, relaxed.kd)
        a, b, c = fine
        size = np.abs(a) * relaxed.ki**2 + np.abs(b) * relaxed.ki + np.abs(c)
        assert np.all(a * relaxed.ki**2 + b * relaxed.ki + c >= -1e-6 * size)


@pytest.mark.parametrize("ms", [1.4, 2.0])
def test_curvature_alone_allows_a_loop_turned_over(ms: float) -> None:
    # the optimum lies beyond the designs with a cusp, where methods that follow gradients do not get from the PI design
    compare("G4", ms, ("curvature",), points=3000, tolerance=1e-5)


@pytest.mark.parametrize(("dead_time", "ms"), [(1.0, 2.0), (1.0, 1.4), (5.0, 2.0)])
def test_circle_bounds_derivative_gain_at_infinite_frequency(
    dead_time: float, ms: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Under ideal derivative |L| of e^{-Ls}/(s+1) tends to kd and turns through all phases, so 1 - kd >= 1/Ms."""
    design = design_pid(Plant.foptd(1.0, 1.0, dead_time), ms=ms, constraints=())
    assert design.status == "optimal"
    assert design.kd == pytest.approx(1.0 - 1.0 / ms, rel=1e-12)
    assert [part.frequency for part in design.active][-1] == np.inf
    monkeypatch.setitem(PLANTS, "F", ([1.0], [1.0, 1.0], dead_time))
    search = Search("F", ms, (), (0.1, 1.0), points=4000)

    def highest(kd: float) -> float:
        gains, heights = np.linspace(0.0, 2.0, 81), [0.0]
        for _ in range(4):
            heights = [search.largest_ki(k, kd) for k in gains]
            top = int(np.argmax(heights))
            gains = np.linspace(gains[max(top - 1, 0)], gains[min(top + 1, 80)], 81)
        return max(heights)

    assert highest(design.kd) == pytest.approx(design.ki, rel=1e-4)
    assert highest(0.98 * design.kd) < design.ki


def test_unbounded_gain_is_a_status_and_not_a_number() -> None:
    # one or two poles and no zeros to the right: with the controller's zeros on the poles L = const/s, for any const
    for den in ([1.0, 1.0], [1.0, 0.0, 0.0], [0.1, 1.1, 1.0]):
        design = design_pid(Plant([1.0], den), ms=1.4)
        assert design.status == "unbounded"
        assert np.isnan([design.k, design.ki, design.kd]).all()
    assert design_pid(Plant([1.0, 2.0], [1.0, 3.0, 3.0, 1.0]), ms=1.4, constraints=()).status == "unbounded"


def test_plant_that_jumps_with_its_input_is_refused() -> None:
    with pytest.raises(LoopError, match="measurement filter"):
        design_pid(Plant([1.0], [1.0], dead_time=1.0), ms=1.4)


def test_margin_is_kept() -> None:
    free = design_pid(plant("G4"), ms=1.4)
    pi = design_pi(plant("G4"), ms=1.4)
    span = search_range(plant("G4"), pi.k, pi.ki)
    kept = design_pid(plant("G4"), ms=1.4, constraints=[Constraint("curvature", *span, margin=0.1), "phase"])
    search = Search("G4", 1.4, ("curvature",), span)
    jets = np.einsum("dxn,x->dn", search.jets(np.linspace(*span, 4000)), [kept.k, kept.ki, kept.kd])
    curvature = (np.conj(jets[1]) * jets[2]).imag / np.abs(jets[1]) ** 3
    assert curvature.max() == pytest.approx(-0.1, abs=1e-5)
    assert kept.ki < free.ki


def test_no_controller_is_a_status_and_not_an_error() -> None:
    # a dead time of three unstable time constants: no PID controller stabilises it
    design = design_pid(Plant([1.0], [1.0, -1.0], dead_time=3.0), ms=1.4, constraints=())
    assert design.status == "no-controller"
    assert "no stabilising controller" in design.message
    assert not design.shaped
    # where the shape was asked for, too, the message says what lifts that
    assert "constraints=()" not in design.message
    assert "constraints=()" in replace(design, shaped=True).message
    assert np.isnan([design.k, design.ki, design.kd]).all()


def test_what_cannot_be_asked() -> None:
    with pytest.raises(LoopError, match="'slope' is unknown"):
        design_pid(plant("G4"), ms=1.4, constraints=["slope"])
    with pytest.raises(LoopError):
        design_pid(plant("G4"))


def test_derivative_action_never_hurts_under_the_circle_alone() -> None:
    for name, ms in CASES:
        pi = design_pi(plant(name), ms=ms)
        assert Loop(plant(name), PI(pi.k, pi.ki)).is_stable()
        assert design_pid(plant(name), ms=ms, constraints=()).ki >= pi.ki
