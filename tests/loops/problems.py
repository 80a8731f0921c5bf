"""Named control loops on which every part of the numerical core is tested.

The plants are those that the literature on PI and PID control keeps returning to (test batch of K. J.
Åström and T. Hägglund, "Benchmark systems for PID control", IFAC PID 2000: multiple lag, first order with
dead time, integrating, unstable, oscillating, heat conduction), plus pure dead time and the cases that
break solvers: very small and very large dead time, jumps, neutral loops. Gains follow simple published
rules (SIMC: S. Skogestad, J. Process Control 13, 2003; AMIGO: Åström and Hägglund, J. Process Control 14,
2004), rounded; all loops are stable unless the name says otherwise.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from loops.references import ReferenceLoop
from replicate.loops import PID, Loop, Plant

MULTIPLE_LAG_8 = (1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0)  # (s + 1)^8


@dataclass(frozen=True)
class Problem:
    """A loop, the times at which its responses are compared, and where it comes from."""

    reference: ReferenceLoop
    times: tuple[float, ...]
    comment: str

    @property
    def plant(self) -> Plant:
        """The plant under test."""
        r = self.reference
        return Plant(list(r.num), list(r.den), dead_time=r.dead_time)

    @property
    def controller(self) -> PID:
        """The controller under test."""
        r = self.reference
        return PID(
            k=r.k,
            ki=r.ki,
            kd=r.kd,
            b=r.b,
            c=r.c,
            derivative_filter=r.derivative_filter,
            measurement_filter=r.measurement_filter,
            measurement_filter_order=r.measurement_filter_order,
            setpoint_filter=r.setpoint_filter,
        )

    @property
    def loop(self) -> Loop:
        """The loop under test."""
        return Loop(self.plant, self.controller)


def _foptd(dead_time: float, k: float, ki: float, **more: Any) -> ReferenceLoop:
    return ReferenceLoop((1.0,), (1.0, 1.0), dead_time, k, ki, **more)


PROBLEMS: dict[str, Problem] = {
    "foptd-0.05": Problem(
        _foptd(0.05, 10.0, 25.0),
        (0.0825, 0.33, 1.27),
        "e^{-0.05s}/(s+1), SIMC: K = 10, Ti = 0.4; lag dominated",
    ),
    "foptd-0.2": Problem(
        _foptd(0.2, 2.5, 2.5, b=0.5),
        (0.33, 1.27, 4.1),
        "e^{-0.2s}/(s+1), SIMC: K = 2.5, Ti = 1, with b = 0.5",
    ),
    "foptd-1": Problem(_foptd(1.0, 0.6, 0.5), (1.5, 2.7, 7.3, 19.6), "e^{-s}/(s+1) under 0.6 + 0.5/s"),
    "foptd-5": Problem(
        _foptd(5.0, 0.1, 0.1), (7.2, 13.1, 33.0), "e^{-5s}/(s+1), SIMC: K = 0.1, Ti = 1; delay dominated"
    ),
    "foptd-50": Problem(_foptd(50.0, 0.2, 0.01), (51.3, 130.0, 320.0), "e^{-50s}/(s+1), AMIGO-like: K = 0.2, Ti = 20"),
    "no-dead-time": Problem(
        ReferenceLoop((1.0,), (1.0, 3.0, 3.0, 1.0), 0.0, 0.625, 0.3125, b=0.5),
        (0.4, 3.1, 20.0),
        "1/(s+1)^3 under PI, no dead time; gains are binary fractions so that sums of coefficients are exact",
    ),
    "lag-8": Problem(
        ReferenceLoop((1.0,), MULTIPLE_LAG_8, 0.0, 0.375, 0.0625), (3.0, 11.0, 40.0), "1/(s+1)^8 under PI"
    ),
    "lag-8-dead-time": Problem(
        ReferenceLoop((1.0,), MULTIPLE_LAG_8, 2.0, 0.3, 0.06), (5.0, 13.0, 34.5), "e^{-2s}/(s+1)^8 under PI"
    ),
    "integrating": Problem(
        ReferenceLoop((1.0,), (1.0, 0.0), 1.0, 0.35, 0.03, b=0.7), (1.5, 4.4, 20.3), "e^{-s}/s under PI"
    ),
    "double-integrating": Problem(
        ReferenceLoop((1.0,), (1.0, 0.0, 0.0), 0.5, 0.5, 0.0625, kd=1.0, b=0.0),
        (0.7, 2.3, 9.9),
        "e^{-0.5s}/s^2, SIMC for double integrators (series K = 1/4, Ti = Td = 4) in parallel form",
    ),
    "unstable-pi": Problem(
        ReferenceLoop((1.0,), (1.0, -1.0), 0.2, 2.5, 0.4, b=0.3), (0.3, 1.1, 6.1), "e^{-0.2s}/(s-1) under PI"
    ),
    "unstable-pid": Problem(
        ReferenceLoop((1.0,), (1.0, -1.0), 0.2, 3.0, 1.2, kd=0.2, b=0.2),
        (0.3, 1.1, 6.1),
        "e^{-0.2s}/(s-1) under PID with ideal derivative (neutral)",
    ),
    "dead-time": Problem(
        ReferenceLoop((1.0,), (1.0,), 1.0, 0.2, 0.4), (1.5, 2.5, 9.25), "e^{-s} under PI: the output jumps"
    ),
    "neutral": Problem(
        _foptd(1.0, 1.0, 0.7, kd=0.3, b=0.6),
        (0.5, 1.5, 2.5, 9.25),
        "e^{-s}/(s+1) under PID with ideal derivative: u jumps at every multiple of the dead time",
    ),
    "derivative-filter": Problem(
        _foptd(1.0, 1.0, 0.7, kd=0.4, derivative_filter=0.05, b=0.6, c=0.5, setpoint_filter=0.5),
        (0.5, 1.5, 2.5, 9.3),
        "e^{-s}/(s+1) under PID with filtered derivative, also on the set point, and a set-point filter",
    ),
    "measurement-filter": Problem(
        _foptd(1.0, 0.9, 0.6, kd=0.3, measurement_filter=0.1, measurement_filter_order=2),
        (0.5, 1.5, 2.5, 9.3),
        "e^{-s}/(s+1) under PID with second-order measurement filter",
    ),
    "derivative-kick": Problem(
        _foptd(1.0, 1.0, 0.7, kd=0.3, c=1.0),
        (0.5, 1.5, 2.5, 9.25),
        "ideal derivative on the error: u has impulses, y jumps, at every multiple of the dead time",
    ),
    "biproper": Problem(
        ReferenceLoop((0.5, 0.4), (1.0, 1.0), 0.2, 1.0),
        (0.3, 0.5, 2.3),
        "(0.5s+0.4)/(s+1) e^{-0.2s} under unit feedback: |S| tends to 2 from below as w grows",
    ),
    "oscillating": Problem(
        ReferenceLoop((1.0,), (1.0, 0.02, 1.0), 3.0, 0.02, 0.1),
        (4.1, 10.2, 31.0),
        "e^{-3s}/(s^2+0.02s+1), damping 0.01: the dead time turns the resonance away from -1",
    ),
    "zero-right": Problem(
        ReferenceLoop((-1.0, 1.0), (1.0, 2.0, 1.0), 0.7, 0.3, 0.25),
        (0.9, 2.0, 8.5),
        "(1-s)/(s+1)^2 e^{-0.7s}",
    ),
    "unstable-loop": Problem(
        ReferenceLoop((2.0,), (1.0, 0.0), 1.0, 1.0),
        (1.5, 2.5, 7.75),
        "2e^{-s}/s under unit feedback: diverges",
    ),
}

STABLE = [name for name in PROBLEMS if name != "unstable-loop"]
INTEGRAL = [name for name in STABLE if PROBLEMS[name].reference.ki]

# e^{-sqrt(s)} under 3 + 5/s, and where its poles in the cut plane are to be looked for (a search on a grid)
ROOT_PI = (3.0, 5.0)
ROOT_POLES = (-1.3077 + 0.4109j, -8.2746 + 5.8215j, -87.5786 + 20.3559j)


def root_plant_function(s: np.ndarray) -> np.ndarray:
    """``e^{-sqrt(s)}`` in numpy."""
    return np.asarray(np.exp(-np.sqrt(s)))
