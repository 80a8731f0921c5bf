"""Paper V: the two models of the paper mill, their controllers, and what the designs are compared with."""

from __future__ import annotations

from functools import cache
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, root

from replicate.exhibits.extrema import largest
from replicate.loops import PI, PID, Loop, PIDDesign, Plant, design_pi, design_pid, search_range
from replicate.loops.design.circles import Circle
from replicate.loops.design.nyquist_constraints import LoopJet
from replicate.papers.panagopoulos.part_2 import setpoint

Array = NDArray[np.float64]

# section 3: starch boiler, times in seconds
STARCH = Plant([1.34], [43.3**2, 2.0 * 43.3, 1.0], dead_time=12.9)
STARCH_MS = 1.6
STARCH_SETTINGS = (1.35, 40.0, 19.0)  # K, Ti, Td as printed
N = 8.0  # the mill's filter on the derivative term
STARCH_PI = PI.from_integral_time(0.80, 60.0)

# section 4: drying section, P2(s) e^{-sL} = Kp (T2 s + 1) / (s (T1 s + 1)) e^{-sL}
DRYING = Plant([0.008 * 30.0, 0.008], [5.0, 1.0, 0.0], dead_time=2.0)
DRYING_MS = 1.4
DRYING_SETTINGS = (5.21, 3.16, 1.02)
FILTER = 5.32  # Tf as printed
DRYING_PI = PI.from_integral_time(5.0, 5.0)


def starch_pid(*, filtered: bool = True) -> PID:
    """Return the printed starch controller, b = 1, with the mill's derivative filter or with an ideal derivative."""
    gain, ti, td = STARCH_SETTINGS
    return PID.ideal(gain, ti, td, derivative_filter=td / N if filtered else 0.0)


def drying_pid(setpoint_filter: float = FILTER) -> PID:
    """Return the printed drying controller, b = 1, with a set-point filter."""
    return PID.ideal(*DRYING_SETTINGS, setpoint_filter=setpoint_filter)


@cache
def starch_design(constraints: tuple[Literal["curvature", "phase"], ...]) -> PIDDesign:
    """Return the optimum for the starch boiler under the circle and the named constraints."""
    return design_pid(STARCH, ms=STARCH_MS, constraints=constraints)


@cache
def drying_design() -> PIDDesign:
    """Return the optimum for the drying section; the plant integrates, so there is no curvature constraint."""
    return design_pid(DRYING, ms=DRYING_MS)


def settings(design: PIDDesign) -> dict[str, float]:
    """Return K, Ti, Td and ki of a design."""
    return {"K": design.k, "Ti": design.integral_time, "Td": design.derivative_time, "ki": design.ki}


@cache
def starch_range() -> tuple[float, float]:
    """Return the frequencies on which the shape of the Nyquist curve is constrained."""
    start = design_pi(STARCH, ms=STARCH_MS)
    return search_range(STARCH, start.k, start.ki)


@cache
def _starch_on_range() -> tuple[Array, LoopJet]:
    """Return logarithms of frequencies on that range, and the plant there."""
    low, high = starch_range()
    grid = np.linspace(np.log(low), np.log(high), 200)
    return grid, LoopJet.of(STARCH, np.exp(grid))


def shape(gains: tuple[float, float, float], kind: Literal["curvature", "phase"]) -> float:
    """Return the largest signed curvature, or the largest slope of arg L over log w, on the starch search range.

    ``gains`` are k, ki, kd; a positive value violates the constraint of the supplement's (5).
    """
    grid, plant = _starch_on_range()

    def values(jet: LoopJet) -> Array:
        return -jet.values(kind, Circle.of(ms=STARCH_MS), np.array(gains))[0]

    return largest(lambda x: float(values(LoopJet.of(STARCH, np.exp([x])))[0]), grid, values(plant))[1]


def on_both_limits(gain: float) -> dict[str, float]:
    """Return the starch controller of a given K for which both limits are reached: Ms = 1.6, and level phase somewhere.

    Ti and Td follow from |1 + L| touching 1/Ms and from the largest phase slope on the search range being zero.
    """
    _, ti, td = STARCH_SETTINGS

    def equations(scaled: Array) -> Array:
        ki, kd = gain / (ti * scaled[0]), gain * td * scaled[1]
        loop = Loop(STARCH, PID(gain, ki, kd))
        return np.array([loop.sensitivity_peak().value / STARCH_MS - 1.0, shape((gain, ki, kd), "phase")])

    guess = np.array([1.0, 1.0])
    solution = root(equations, guess, method="hybr", options={"xtol": 1e-11})
    found_ti, found_td = ti * solution.x[0], td * solution.x[1]
    return {"Ti": float(found_ti), "Td": float(found_td), "ki": float(gain / found_ti)}


class SetpointFilter(NamedTuple):
    """Time constants of the set-point filter of the drying section by several formulas, for b = 1."""

    printed_formula: float
    corrected: float
    coarse_grid: float
    eq_16: float
    eq_16_mended: float
    never_above_one: float


def coarse_grid_peak(gains: tuple[float, float, float] | None = None) -> setpoint.Resonance:
    """Return the peak of |T| as paper II's tables found it: the largest of the 50 values on ``logspace(-2, 2)``."""
    return setpoint.Resonance.on_coarse_grid(Loop(DRYING, _controller(gains)))


def _controller(gains: tuple[float, float, float] | None) -> PID:
    return PID(*gains) if gains else drying_pid(0.0)


def setpoint_filters(gains: tuple[float, float, float] | None = None) -> SetpointFilter:
    """Evaluate the filter formulas of the supplement to paper II; ``gains`` (k, ki, kd) default to the printed ones."""
    controller = _controller(gains)
    peak = setpoint.Resonance.of(Loop(DRYING, controller))
    return SetpointFilter(
        printed_formula=setpoint.full_weight_filter_as_printed(controller, peak),
        corrected=setpoint.full_weight_filter_corrected(controller, peak),
        coarse_grid=setpoint.full_weight_filter_corrected(controller, coarse_grid_peak(gains)),
        eq_16=setpoint.filter_as_printed(controller, peak),
        eq_16_mended=setpoint.filter_corrected(controller, peak),
        never_above_one=_never_above_one(controller.k, controller.ki, controller.kd),
    )


def _never_above_one(k: float, ki: float, kd: float) -> float:
    """Return the smallest filter time constant with |G_sp| <= 1 at all frequencies.

    It is decided at low frequency, where the loop's two integrators make |G_sp| exceed one.
    """
    loop = Loop(DRYING, PID(k, ki, kd))

    def needed(log_w: Array) -> Array:
        s = 1j * np.exp(log_w)
        value = loop(s)
        gain = np.abs((ki + k * s) / (ki + k * s + kd * s**2) * value / (1.0 + value))
        return np.asarray(np.sqrt(np.maximum(gain**2 - 1.0, 0.0)) / np.abs(s))

    # the plant's velocity gain is P0(0) = Kp, so 1/G_sp = 1 + s^2 (kd + 1/Kp)/ki + O(s^3): the limit at zero frequency
    at_rest = float(np.sqrt(2.0 * (kd + DRYING.den[-2] / DRYING.num[-1]) / ki))
    grid = np.linspace(np.log(1e-3), np.log(3.0), 800)
    return max(at_rest, largest(needed, grid, needed(grid))[1])


def beside_the_peak(w: float) -> tuple[float, float]:
    """Return how far |T| is below Mp at a frequency (a fraction), and the mended formula's time constant there."""
    controller = drying_pid(0.0)
    loop = Loop(DRYING, controller)
    value = complex(loop(1j * w))
    size = abs(value / (1.0 + value))
    time_constant = setpoint.full_weight_filter_corrected(controller, setpoint.Resonance(w, size))
    return round(1.0 - size / loop.complementary_peak().value, 12) + 0.0, time_constant


def frequency_for_filter(time_constant: float) -> float:
    """Return the frequency below the peak of |T| at which the mended formula gives a time constant."""
    peak = Loop(DRYING, drying_pid(0.0)).complementary_peak().frequency
    return float(brentq(lambda w: beside_the_peak(w)[1] - time_constant, 0.8 * peak, peak, xtol=1e-14))
