"""`design_pi` against a search of the (k, ki) plane that knows no theory.

The search asks of single points only: is the loop stable (winding of the characteristic function along the imaginary
axis, Mikhailov's criterion), and do |S| and |T|, evaluated from their definitions on dense frequencies, keep their
bounds? It scans a grid of (k, ki), then maximises over k the largest ki, a root of the smallest margin over all
frequencies. Nothing of the package is used but the design that is tested.

Plants: Astrom, Panagopoulos and Hagglund, "Design of PI controllers based on non-convex optimization", Automatica 34
(1998) 585-601, all of them, and some that are none of the paper's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from replicate.loops import LoopError, Plant, design_pi, setpoint_weight

TOLERANCE = 1e-8

ZOOM = np.linspace(0.0, 1.0, 17)


def poly(*factors: Sequence[float]) -> tuple[float, ...]:
    """Multiply polynomials, descending powers."""
    product = np.array([1.0])
    for factor in factors:
        product = np.polymul(product, factor)
    return tuple(product.tolist())


@dataclass(frozen=True)
class Case:
    """A plant num/den e^{-sL}, or e^{-sqrt(s)} where ``root``, and the range of its gains: |k|, ki <= reach."""

    num: tuple[float, ...] = (1.0,)
    den: tuple[float, ...] = (1.0,)
    dead_time: float = 0.0
    root: bool = False
    reach: float = 10.0

    @property
    def plant(self) -> Plant:
        if self.root:
            return Plant.from_function(lambda s: np.exp(-np.sqrt(s)))
        return Plant(self.num, self.den, self.dead_time)

    def parts(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Numerator with everything transcendental, and denominator polynomial."""
        shift = np.exp(-np.sqrt(s)) if self.root else np.exp(-s * self.dead_time)
        return np.polyval(self.num, s) * shift, np.polyval(self.den, s)


LAG3 = poly((1, 1), (1, 1), (1, 1))


def resonant(a: float) -> Case:
    return Case((9.0,), poly((1, 1), (1, a, 9)), reach=4.0)


def unstable(a: float) -> Case:
    return Case((a,), poly((1, a), (1, -1)), reach=40.0)


CASES = {
    "G1": Case(den=LAG3),
    "G2": Case(den=poly((1, 1), (0.2, 1), (0.04, 1), (0.008, 1))),
    "G3": Case(den=LAG3, dead_time=15.0, reach=2.0),
    "G4": Case(den=poly((1, 0), (1, 1), (1, 1)), reach=3.0),
    "G5": Case((-2.0, 1.0), LAG3, reach=3.0),
    "G7": Case(dead_time=1.0, reach=3.0),
    "G8": Case(den=(1.0, 0.0), dead_time=1.0, reach=3.0),
    "G9": Case(root=True, reach=60.0),
    "G10": Case(tuple(100 * np.polyadd((1, 0.05), (0.5, 0.5))), poly((1, 10), (1, 10), (1, 1), (1, 0.05)), reach=20.0),
    "G11": Case((150.0,), poly((1, 10), (1, 10), (1, 1)), reach=20.0),
    "G12, a=0": resonant(0.0),
    "G12, a=0.1": resonant(0.1),
    "G12, a=0.2": resonant(0.2),
    "G12, a=0.5": resonant(0.5),
    "G12, a=1": resonant(1.0),
    "G12, a=2 (G6)": resonant(2.0),
    "G13": Case(poly((1, 6), (1, 6)), poly((1, 0), (1, 1), (1, 1), (1, 36)), reach=5e3),
    "G14, a=4": unstable(4.0),
    "G14, a=8": unstable(8.0),
    "filtered dead time": Case(den=(0.27, 1.0), dead_time=1.0, reach=3.0),
    "lag with dead time": Case(den=(1.0, 1.0), dead_time=0.3, reach=10.0),
    "lag dominated": Case(den=(1.0, 1.0), dead_time=0.02, reach=1000.0),
    "lead with dead time": Case((1.5, 1.0), poly((1, 1), (0.4, 1)), dead_time=0.6, reach=5.0),
    "unstable with dead time": Case(den=(1.0, -1.0), dead_time=0.1, reach=30.0),
    "zero at the right": Case((-1.0, 1.0), poly((1, 1), (1, 1)), reach=3.0),
}


# ------------------------------------------------------------------------------------------------------- search


@dataclass(frozen=True)
class Bounds:
    """max |S| <= ms and max |T| <= mp, each if given; or the loop gain outside a circle about -center."""

    ms: float = np.inf
    mp: float = np.inf
    circle: tuple[float, float] | None = None

    def margin(self, value: np.ndarray) -> np.ndarray:
        """Positive where the loop gain ``value`` keeps the bounds."""
        if self.circle is not None:
            center, radius = self.circle
            return np.abs(center + value) - radius
        to_point = np.abs(1.0 + value)
        if np.isinf(self.mp):
            return to_point - 1.0 / self.ms
        return np.asarray(np.minimum(to_point - 1.0 / self.ms, to_point - np.abs(value) / self.mp))


def frequencies(case: Case, per_decade: int) -> np.ndarray:
    """Dense frequencies: logarithmic, and linear over several turns of a dead time."""
    corners = [abs(r) for p in (case.num, case.den) for r in np.roots(p) if r] + [1.0]
    if case.dead_time:
        corners.append(1.0 / case.dead_time)
    low, high = 1e-3 * min(corners), 2e3 * max(corners)
    w = np.geomspace(low, high, int(per_decade * np.log10(high / low)))
    if case.dead_time:
        w = w[w < 1.0 / case.dead_time]
        w = np.concatenate([w, np.arange(1.0, 40.0, 6.0 / per_decade) / case.dead_time])
    # towards a resonance, where the Nyquist curve runs fast
    peaks = [r.imag for r in np.roots(case.den) if r.imag > 0 and abs(r.real) < 0.2 * r.imag]
    around = [p * (1.0 + sign * np.geomspace(1e-4, 0.1, per_decade)) for p in peaks for sign in (1.0, -1.0)]
    return np.unique(np.concatenate([w, *around]))


class Search:
    """Points of the (k, ki) plane, tested one by one."""

    def __init__(self, case: Case, bounds: Bounds, per_decade: int) -> None:
        self.case, self.bounds = case, bounds
        self.w = frequencies(case, per_decade)
        self.num, self.den = case.parts(1j * self.w)
        self.gain = self.num / self.den

    def keeps(self, k: float, ki: np.ndarray) -> np.ndarray:
        """Whether the bounds hold on all the frequencies, for one k and many ki: most fail on a few of them."""
        kept = np.ones(ki.size, dtype=bool)
        for part in (slice(None, None, 32), slice(None, None, 4), slice(None)):
            value = (k - 1j * ki[kept, None] / self.w[part]) * self.gain[part]
            kept[kept] = (self.bounds.margin(value) > 0.0).all(axis=1)
        return kept

    def stable(self, k: float, ki: float) -> bool:
        """Mikhailov's criterion: the characteristic function over (s + 1)^n does not turn between 0 and infinity."""
        s = 1j * self.w
        order = len(self.case.den)
        function = (s * self.den + (k * s + ki) * self.num) / (s + 1.0) ** order
        start = ki * self.case.num[-1]  # the value at s = 0
        turns = np.angle(np.concatenate([[function[0] / start], function[1:] / function[:-1]]))
        return start > 0.0 and abs(turns.sum()) < 0.5 * np.pi

    def smallest_margin(self, k: float, ki: float) -> float:
        """Return a margin that is positive only if it is between the frequencies too: local minima are zoomed into."""
        margin = self.bounds.margin((k - 1j * ki / self.w) * self.gain)
        smallest = float(margin.min())
        if smallest <= 0.0:
            return smallest
        low = np.nonzero((margin[1:-1] <= margin[:-2]) & (margin[1:-1] <= margin[2:]) & (margin[1:-1] < 0.02))[0] + 1
        for i in low:
            left, right = self.w[i - 1], self.w[i + 1]
            for _ in range(4):
                w = left + (right - left) * ZOOM
                num, den = self.case.parts(1j * w)
                inner = self.bounds.margin((k - 1j * ki / w) * num / den)
                j = min(max(int(inner.argmin()), 1), ZOOM.size - 2)
                left, right = w[j - 1], w[j + 1]
                smallest = min(smallest, float(inner[j]))
        return smallest


def scan(search: Search, gains: np.ndarray, integral: np.ndarray) -> dict[float, float]:
    """Return for every k the largest ki of a grid that is stable and keeps the bounds, where there is one.

    No pole crosses the axis where the bounds are kept: among neighbours on the grid the largest speaks for all.
    """
    found = {}
    for k in gains:
        kept = search.keeps(k, integral)
        tops = integral[kept & ~np.append(kept[1:], False)]
        top = next((float(ki) for ki in tops[::-1] if search.stable(k, ki)), None)
        if top is not None:
            found[float(k)] = top
    return found


def highest(search: Search, k: float, around: float) -> float:
    """Return the largest stable ki that keeps the bounds at one k, to rounding, near a value known from the scan."""
    grid = around * np.linspace(0.6, 1.3, 57)
    for low, high in zip(grid[::-1], [grid[-1] + (grid[1] - grid[0]), *grid[:0:-1]], strict=True):
        if search.smallest_margin(k, low) > 0.0 and search.stable(k, low):
            return float(brentq(lambda ki: search.smallest_margin(k, ki), low, high, xtol=1e-13 * low, rtol=1e-13))
    return 0.0


def brute_force(case: Case, bounds: Bounds, limits: tuple[float, float] = (-np.inf, np.inf)) -> tuple[float, float]:
    """Return (k, ki) of the largest ki in the half plane ki > 0, for k within limits; (nan, nan) if there is none."""
    coarse = Search(case, bounds, per_decade=60)
    gains = case.reach * np.sinh(np.linspace(-7.0, 7.0, 161)) / np.sinh(7.0)
    gains = gains[(gains > limits[0]) & (gains < limits[1])]
    integral = case.reach * np.geomspace(1e-5, 1.0, 141)
    tops = scan(coarse, gains, integral)
    if not tops:
        return float("nan"), float("nan")
    # the scan knows ki to one grid step only: every k that may hold the maximum is looked at again
    close = [k for k in tops if tops[k] * (integral[1] / integral[0]) ** 1.5 >= max(tops.values())]
    tops = {k: highest(coarse, k, tops[k]) for k in close}
    best = max(tops, key=lambda k: tops[k])
    i = int(np.argmin(np.abs(gains - best)))
    left, right = gains[max(i - 1, 0)], gains[min(i + 1, gains.size - 1)]
    fine = Search(case, bounds, per_decade=250)
    found = minimize_scalar(
        lambda k: -highest(fine, k, tops[best]),
        bounds=(left, right),
        method="bounded",
        options={"xatol": 1e-9 * (right - left)},
    )
    return float(found.x), -float(found.fun)


@cache
def searched(name: str, bounds: Bounds) -> tuple[float, float]:
    return brute_force(CASES[name], bounds)


# -------------------------------------------------------------------------------------------------------- tests


@pytest.mark.parametrize("name", CASES)
def test_the_largest_ki_with_bounded_sensitivity(name: str) -> None:
    ms = 2.0
    design = design_pi(CASES[name].plant, ms=ms)
    k, ki = searched(name, Bounds(ms=ms))
    assert design.status == "optimal"
    assert design.ki == pytest.approx(ki, rel=TOLERANCE)
    # the maximum is flat in k unless it is a corner: half the digits
    assert design.k == pytest.approx(k, rel=2e-3, abs=1e-4 * CASES[name].reach)


@pytest.mark.parametrize("name", ["G1", "G3", "G4", "G7", "G9", "G12, a=0", "G12, a=2 (G6)", "G14, a=8"])
def test_the_largest_ki_with_a_tighter_bound(name: str) -> None:
    design = design_pi(CASES[name].plant, ms=1.4)
    assert design.ki == pytest.approx(searched(name, Bounds(ms=1.4))[1], rel=TOLERANCE)


@pytest.mark.parametrize("name", ["G1", "G3", "G8", "G12, a=0.2", "G12, a=2 (G6)", "G14, a=8"])
def test_the_largest_ki_with_bounded_complementary_sensitivity(name: str) -> None:
    # the constraint of the search is |T| itself, not a circle
    design = design_pi(CASES[name].plant, mp=1.5)
    assert design.ki == pytest.approx(searched(name, Bounds(mp=1.5))[1], rel=TOLERANCE)


@pytest.mark.parametrize("name", ["G1", "G3", "G4", "G7", "G12, a=0.2"])
def test_the_largest_ki_outside_the_combined_circle(name: str) -> None:
    ms, mp = 2.0, 1.4
    # errata of the thesis: the circle whose diameter on the real axis runs from -Mp/(Mp - 1) to -(Ms - 1)/Ms
    center = (ms * (2 * mp - 1) - (mp - 1)) / (2 * ms * (mp - 1))
    radius = (ms + mp - 1) / (2 * ms * (mp - 1))
    design = design_pi(CASES[name].plant, ms=ms, mp=mp)
    assert design.ki == pytest.approx(searched(name, Bounds(circle=(center, radius)))[1], rel=TOLERANCE)
    both = Search(CASES[name], Bounds(ms=ms, mp=mp), per_decade=400)
    assert both.stable(design.k, design.ki)
    assert both.keeps(design.k, np.array([design.ki])).all()


def test_a_conditionally_stable_plant_has_two_solutions() -> None:
    case = CASES["G13"]
    design = design_pi(case.plant, ms=2.0)
    assert len(design.solutions) == 2
    fast, slow = design.solutions
    assert (design.k, design.ki) == (fast.k, fast.ki)
    _, ki = brute_force(Case(case.num, case.den, reach=5.0), Bounds(ms=2.0), limits=(0.0, 5.0))
    assert slow.ki == pytest.approx(ki, rel=TOLERANCE)


def test_the_fast_solution_is_gone_with_a_tighter_bound() -> None:
    case = CASES["G13"]
    design = design_pi(case.plant, ms=1.4)
    assert len(design.solutions) == 1
    assert all(np.isnan(brute_force(case, Bounds(ms=1.4), limits=(5.0, np.inf))))
    _, ki = brute_force(Case(case.num, case.den, reach=5.0), Bounds(ms=1.4))
    assert design.ki == pytest.approx(ki, rel=TOLERANCE)


def test_a_resonance_makes_corners_and_damping_makes_them_smooth() -> None:
    for a, frequencies_of_tangency in ((0.2, 2), (1.0, 2), (2.0, 1)):
        design = design_pi(resonant(a).plant, ms=2.0)
        assert design.case == ("corner" if frequencies_of_tangency == 2 else "smooth")
        assert len(design.frequencies) == frequencies_of_tangency
        num, den = resonant(a).parts(1j * np.array(design.frequencies))
        value = (design.k - 1j * design.ki / np.array(design.frequencies)) * num / den
        assert np.abs(1.0 + value) == pytest.approx(0.5, rel=1e-9)


@pytest.mark.parametrize("a", [1.5, 2.9])
def test_no_controller_where_the_phase_does_not_allow_one(a: float) -> None:
    # a/((s+a)(s-1)) stays outside the circle of Ms = 2 only if a >= 3 (example 7): here no k, ki does
    assert design_pi(unstable(a).plant, ms=2.0).status == "no-controller"
    assert all(np.isnan(brute_force(unstable(a), Bounds(ms=2.0))))
    assert design_pi(unstable(3.1).plant, ms=2.0).status == "optimal"


def test_a_first_order_lag_bears_any_integral_gain() -> None:
    design = design_pi(Plant([1.0], [1.0, 1.0]), ms=1.4)
    assert design.status == "unbounded"
    assert np.isnan(design.ki)
    # k = ki gives L = ki/s: S = s/(s + ki) never exceeds one, however large ki is
    search = Search(Case(den=(1.0, 1.0)), Bounds(ms=1.4), per_decade=60)
    assert all(search.stable(ki, ki) and search.keeps(ki, np.array([ki])).all() for ki in (1e1, 1e4, 1e7))


def test_the_setpoint_weight_makes_the_setpoint_gain_one() -> None:
    case = CASES["G1"]
    design = design_pi(case.plant, ms=2.0)
    w = np.linspace(0.5, 1.5, 200001)
    num, den = case.parts(1j * w)
    loop = (design.k - 1j * design.ki / w) * num / den
    peak = int(np.argmax(np.abs(loop / (1.0 + loop))))
    gain = (design.ki + 1j * w * design.b * design.k) / (design.ki + 1j * w * design.k) * loop / (1.0 + loop)
    assert 0.0 < design.b < 1.0
    # the peak is known to one step of w, and the gain is not stationary there
    assert abs(gain[peak]) == pytest.approx(1.0, abs=2.0 * float(np.max(np.abs(np.diff(np.abs(gain))))))


def test_the_setpoint_weight_is_cut_to_its_range() -> None:
    assert setpoint_weight(CASES["G1"].plant, -0.1, 0.1) == 0.0  # (25) divides by k
    assert setpoint_weight(CASES["G1"].plant, 0.1, 1.0, at=(0.5, 3.0)) == 0.0  # the root is imaginary
    assert setpoint_weight(CASES["G1"].plant, 0.1, 0.1, at=(0.0, 1.0)) == 1.0  # no resonance


@pytest.mark.parametrize("bounds", [{}, {"ms": 1.0}, {"ms": 0.5}, {"mp": 1.0}, {"ms": 2.0, "mp": 0.9}])
def test_a_bound_is_needed_and_must_exceed_one(bounds: dict[str, float]) -> None:
    with pytest.raises(LoopError):
        design_pi(CASES["G1"].plant, **bounds)
