"""Table 1 of the supplement: measurement filters of first and second order, and the design repeated with them.

Every column is one filter. The design is made for F_y G; the loop then has the filter in the measurement.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import atan, degrees, inf, pi

import numpy as np
from scipy.optimize import minimize_scalar

from replicate.loops import PID, Constraint, Loop, PIDDesign, Plant, design_pi, design_pid, search_range
from replicate.papers.panagopoulos.part_2.printed_gains import printed_number
from replicate.papers.panagopoulos.part_2.processes import G4
from replicate.papers.panagopoulos.part_2.shape import largest_over

TABLE = "IIs-table-1"
MS = 1.4
UNFILTERED = "none"
HEADED = {"n1_N2": (1, 2), "n1_N5": (1, 5), "n1_N10": (1, 10), "n2_N2": (2, 2), "n2_N5": (2, 5), "n2_N10": (2, 10)}
COLUMNS = (*HEADED, UNFILTERED)
ROWS = ("argFy", "K", "Ti", "Td", "w0", "IAE", "Mn")
CUT = 100.0  # rad/s, the last frequency of logspace(-2, 2)
PREVIOUS = {"n2_N2": "n1_N10", "n2_N5": "n2_N2", "n2_N10": "n2_N5"}


@dataclass(frozen=True)
class Filter:
    """F_y = 1/(1 + s Tf)^n with Tf = 1/(n N w0), (6) and (8)."""

    order: int
    N: float
    w0: float

    @property
    def time_constant(self) -> float:
        """Tf of (8)."""
        return 1.0 / (self.order * self.N * self.w0)

    @property
    def phase(self) -> float:
        """The phase of F_y at w0, radians."""
        return -self.order * atan(1.0 / (self.order * self.N))

    def times(self, plant: Plant) -> Plant:
        """Return F_y G."""
        den = plant.den
        for _ in range(self.order):
            den = np.asarray(np.polymul(den, [self.time_constant, 1.0]), dtype=float)
        return Plant(plant.num, den, dead_time=plant.dead_time)

    def on(self, controller: PID) -> PID:
        """Return a controller with this filter on its measurement."""
        return PID(
            controller.k,
            controller.ki,
            controller.kd,
            b=controller.b,
            measurement_filter=self.time_constant,
            measurement_filter_order=self.order,
        )


@cache
def unfiltered() -> PIDDesign:
    """Return the design without filter."""
    return design_pid(G4, ms=MS)


@cache
def _design(filter_: Filter | None, margin: float) -> PIDDesign:
    plant = filter_.times(G4) if filter_ else G4
    start = design_pi(plant, ms=MS)
    low, high = search_range(plant, start.k, start.ki)
    return design_pid(plant, ms=MS, constraints=(Constraint("curvature", low, high, margin), "phase"))


def by_the_text(column: str) -> tuple[Filter | None, PID]:
    """Return filter and design as the text describes them: N as headed, w0 of the design without filter."""
    if column == UNFILTERED:
        return None, unfiltered().controller
    order, n = HEADED[column]
    filter_ = Filter(order, n, unfiltered().frequency)
    return filter_, _design(filter_, 0.0).controller


def source_of_w0(column: str) -> str:
    """Return the column whose printed w0 is in the filter of a column."""
    return PREVIOUS.get(column, UNFILTERED)


def as_used(column: str, w0: float | None = None) -> Filter | None:
    """Return the filter that the printed numbers belong to, for the printed w0 or another one.

    N = 1 stands under the heading 2. First-order filters use the printed w0 of the design without filter. For
    second-order filters each column uses the w0 of the column before it, as if the variable had been overwritten.
    """
    if column == UNFILTERED:
        return None
    order, n = HEADED[column]
    return Filter(order, 1 if n == 2 else n, w0 or printed_number(TABLE, "w0", source_of_w0(column)))


def printed_pid(column: str) -> PID:
    """Return the controller that a column prints."""
    k, ti, td = (printed_number(TABLE, row, column) for row in ("K", "Ti", "Td"))
    return PID.ideal(k, ti, td)


@cache
def margin() -> float:
    """Return how far below zero the curvature stays in the printed designs with a filter: the mean over the columns."""
    found = []
    for column in HEADED:
        filter_ = as_used(column)
        assert filter_  # noqa: S101  -- every headed column has one
        plant = filter_.times(G4)
        start = design_pi(plant, ms=MS)
        span = search_range(plant, start.k, start.ki)
        found.append(-largest_over("curvature", plant, printed_pid(column), span))
    return sum(found) / len(found)


def reconstructed(column: str) -> tuple[Filter | None, PID]:
    """Return filter and design under the conventions that the printed numbers show."""
    filter_ = as_used(column)
    return filter_, _design(filter_, margin() if filter_ else 0.0).controller


def noise_gain(controller: PID, cut: float = inf) -> float:
    """Return Mn = sup over w <= cut of ``|Gc/(1 + G Gc)|``, the filter in Gc; infinite without filter."""
    if not controller.measurement_filter:
        return inf

    def gain(w: np.ndarray) -> np.ndarray:
        s = 1j * np.asarray(w)
        c = controller.feedback(s)
        return np.asarray(np.abs(c / (1.0 + c * G4(s))))

    top = min(cut, 1e4)
    w = np.geomspace(1e-2, top, 4000)
    sampled = gain(w)
    i = int(np.argmax(sampled))
    best = float(sampled[i])
    if 0 < i < w.size - 1:
        found = minimize_scalar(
            lambda x: -float(gain(np.array([x]))[0]),
            bounds=(w[i - 1], w[i + 1]),
            method="bounded",
            options={"xatol": 1e-12 * w[i]},
        )
        best = max(best, -float(found.fun))
    if cut == inf and controller.measurement_filter_order == 1:
        best = max(
            best, controller.kd / float(controller.measurement_filter_polynomials()[1][0])
        )  # the limit for w -> infinity
    return best


def numbers(filter_: Filter | None, controller: PID, *, gon: bool = False, cut: float = inf) -> dict[str, float]:
    """Return one column of the table."""
    phase = filter_.phase if filter_ else 0.0
    loop = Loop(G4, filter_.on(controller) if filter_ else controller)
    return {
        "argFy": phase * 200.0 / pi if gon else degrees(phase),
        "K": controller.k,
        "Ti": controller.integral_time,
        "Td": controller.derivative_time,
        "w0": loop.sensitivity_peak().frequency,
        "IAE": loop.load_step().iae(),
        "Mn": noise_gain(loop.controller, cut),
    }
