"""The designs of this part, each computed once per process of the computer.

``stated`` is the problem of the text: the circle, negative curvature and falling phase on the search range, without
the curvature for the integrating and nearly integrating processes. ``ms-only`` leaves the circle alone.
"""

from __future__ import annotations

from functools import cache
from typing import Literal

from replicate.loops import PI, PID, PIDDesign, PIDesign, design_pi, design_pid
from replicate.papers.panagopoulos.part_2.printed_gains import printed_pid
from replicate.papers.panagopoulos.part_2.processes import NEAR_INTEGRATING, PLANTS, split

Problem = Literal["stated", "ms-only", "phase", "curvature-phase"]

_CONSTRAINTS: dict[Problem, tuple[Literal["curvature", "phase"], ...]] = {
    "ms-only": (),
    "phase": ("phase",),
    "curvature-phase": ("curvature", "phase"),
}


@cache
def pid_design(row: str, problem: Problem = "stated") -> PIDDesign:
    """Return the PID design of a table row, by its key."""
    name, ms = split(row)
    if problem == "stated":
        return pid_design(row, "phase" if name in NEAR_INTEGRATING else "curvature-phase")
    return design_pid(PLANTS[name], ms=ms, constraints=_CONSTRAINTS[problem])


@cache
def pi_design(row: str) -> PIDesign:
    """Return the PI design of paper I for the same process and the same Ms."""
    name, ms = split(row)
    return design_pi(PLANTS[name], ms=ms)


def optimal(row: str, problem: Problem = "stated") -> PID:
    """Return the controller of `pid_design`; its set-point weight is set elsewhere."""
    return pid_design(row, problem).controller


def pi_controller(row: str) -> PI:
    """Return the controller of `pi_design`."""
    return pi_design(row).controller


def printed(table: str, row: str) -> PID:
    """Return the controller that a table prints."""
    return printed_pid(table, row)
