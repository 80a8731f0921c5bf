"""The design procedure of section 6 as a function, and one worked design for each dead time of the charts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PI, Loop, Plant
from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.normalised_loop import end_frequency, lag, point

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Design:
    """What the procedure of section 6 finds.

    Attributes
    ----------
    compatible
        Whether some stable loop has the crossover frequency and at least the phase margin.
    message
        The same in a sentence, with what would be compatible.
    tau
        Normalised dead time L/T (7c).
    a, b
        Normalised gains (7a), (7b) of the point P1, where the phase margin is exactly the one asked for; ``nan`` if the
        specifications are not compatible.
    k_p, k_i, t_i
        Controller parameters (23) in the plant's units; ``nan`` if the specifications are not compatible.
    highest_crossover
        The crossover frequency that the phase margin allows at most (21), in rad per unit of time.
    largest_phase_margin
        The phase margin that the crossover frequency allows at most, reached on the b axis (P2), in degrees.
    """

    compatible: bool
    message: str
    tau: float
    a: float
    b: float
    k_p: float
    k_i: float
    t_i: float
    highest_crossover: float
    largest_phase_margin: float

    def controller(self) -> PI:
        """Return the controller.

        Raises
        ------
        ValueError
            If the specifications are not compatible.
        """
        if not self.compatible:
            raise ValueError(self.message)
        return PI(k=self.k_p, ki=self.k_i)


def first_order_parameters(plant: Plant) -> tuple[float, float, float]:
    """Return K, L and T of a plant (1).

    Raises
    ------
    ValueError
        If the plant is not a first-order lag with dead time with positive parameters.
    """
    if not plant.is_rational or plant.num.size != 1 or plant.den.size != 2 or plant.den[1] == 0.0:
        msg = f"the plant must be a first-order lag with dead time, K exp(-Ls)/(1 + Ts), not {plant!r}"
        raise ValueError(msg)
    gain, time_constant = float(plant.num[0] / plant.den[1]), float(plant.den[0] / plant.den[1])
    if not (gain > 0.0 and time_constant > 0.0 and plant.dead_time > 0.0):
        msg = f"K, L and T must be positive, not K = {gain:g}, L = {plant.dead_time:g}, T = {time_constant:g}"
        raise ValueError(msg)
    return gain, plant.dead_time, time_constant


def design(plant: Plant, phase_margin: float, crossover: float) -> Design:
    """Design a PI controller for a phase margin and a gain crossover frequency (section 6).

    The paper asks for the crossover frequency exactly and for at least the phase margin; every point of an arc will do.
    This is its first point P1, at which the phase margin is exact. For another point of the arc ask for a larger phase
    margin.

    Parameters
    ----------
    plant
        A first-order lag with dead time, for example ``Plant.foptd(gain, time_constant, dead_time)``.
    phase_margin
        In degrees, between 0 and 180.
    crossover
        In rad per unit of the plant's time.

    Raises
    ------
    ValueError
        If the plant is of another kind or a specification is out of range.

    Examples
    --------
    >>> found = design(Plant.foptd(gain=2.0, time_constant=10.0, dead_time=5.0), phase_margin=45.0, crossover=0.2)
    >>> found.compatible, round(found.a, 4), round(found.b, 4)
    (True, 1.1023, 2.1671)
    >>> design(Plant.foptd(2.0, 10.0, 5.0), phase_margin=75.0, crossover=0.2).compatible
    False
    """
    K, L, T = first_order_parameters(plant)
    if not crossover > 0.0:
        msg = f"the crossover frequency must be positive, not {crossover:g}"
        raise ValueError(msg)
    tau, w = L / T, T * crossover  # (7c), (8)
    highest = end_frequency(tau, phase_margin)
    largest = 180.0 - float(np.degrees(lag(tau, w)))
    if w >= highest:
        remedy = f"ask for at most {largest:.4g} degrees" if largest > 0.0 else "ask for a lower one"
        msg = (
            f"not compatible: with a phase margin of {phase_margin:g} degrees the crossover frequency must "
            f"be below {highest / T:.4g}, not {crossover:g}; {remedy}, or take a PID controller"
        )
        nan = float("nan")
        return Design(False, msg, tau, nan, nan, nan, nan, nan, highest / T, largest)
    a, b = (float(x) for x in point(tau, w, phase_margin))  # (11)
    msg = f"compatible: phase margins from {phase_margin:g} up to {largest:.4g} degrees have this crossover frequency"
    return Design(True, msg, tau, a, b, b / K, a / (K * T), b * T / a, highest / T, largest)  # (23)


# The worked designs: one process of every τ, 60 degrees, and a crossover frequency whose lag over the dead time is half
# a radian. All of them are compatible.
GAIN, TIME_CONSTANT, PHASE_MARGIN, DEAD_TIME_ANGLE = 2.0, 10.0, 60.0, 0.5

worked_designs = paper.table(
    "design",
    "The design procedure, worked for ten processes",
    printed=False,
    rows=tuple(f"{tau:g}" for tau in TAUS),
    columns=(
        "omega_A",
        "omega_A_max",
        "m_phi_max",
        "a",
        "b",
        "K_P",
        "K_I",
        "T_I",
        "m_phi",
        "g",
        "Ms",
        "overshoot",
        "rise_time",
        "settling_time",
    ),
    caption="Process (1) with $K = 2$, $T = 10$ and $L = \\tau T$; specifications $m_\\varphi^\\star = "
    "60$ degrees and $\\hat\\omega_A^\\star = 0.5/L$. $\\omega_A$ is normalised; the columns after it say "
    "how far the specifications could have been raised. $m_\\varphi$, $g$, $M_s$ and the response are "
    "measured on the finished loop, times in the units of $T$ and $L$; overshoot is a fraction.",
    labels={
        "omega_A": "$\\omega_A^\\star$",
        "omega_A_max": "$\\omega_A^u$ (21)",
        "m_phi_max": "largest $m_\\varphi$",
        "K_P": "$K_P$",
        "K_I": "$K_I$",
        "T_I": "$T_I$",
        "a": "$a$",
        "b": "$b$",
        "m_phi": "$m_\\varphi$",
        "g": "$g$",
        "Ms": "$M_s$",
        "rise_time": "rise time",
        "settling_time": "settling time",
        **{f"{tau:g}": f"$\\tau = {tau:g}$" for tau in TAUS},
    },
    units={"m_phi": "degrees", "m_phi_max": "degrees"},
)
worked_designs.computed_trial = lambda row, numbers: (
    Plant.foptd(GAIN, TIME_CONSTANT, float(row) * TIME_CONSTANT).notation(),
    PI(numbers["K_P"], numbers["K_I"]).notation(),
)


@worked_designs.reading("as-written", "Section 6")
def work() -> pd.DataFrame:
    """Run the procedure and measure the loops it designs."""
    rows = {}
    for tau in TAUS:
        plant = Plant.foptd(GAIN, TIME_CONSTANT, tau * TIME_CONSTANT)
        found = design(plant, PHASE_MARGIN, DEAD_TIME_ANGLE / plant.dead_time)
        loop = Loop(plant, found.controller())
        margins, y = loop.margins(), loop.step()
        rows[f"{tau:g}"] = {
            "omega_A": DEAD_TIME_ANGLE / tau,
            "omega_A_max": TIME_CONSTANT * found.highest_crossover,
            "m_phi_max": found.largest_phase_margin,
            "a": found.a,
            "b": found.b,
            "K_P": found.k_p,
            "K_I": found.k_i,
            "T_I": found.t_i,
            "m_phi": margins.phase,
            "g": 1.0 / margins.gain,
            "Ms": loop.sensitivity_peak().value,
            "overshoot": y.overshoot(),
            "rise_time": y.rise_time(),
            "settling_time": y.settling_time(),
        }
    return worked_designs.frame(rows)
