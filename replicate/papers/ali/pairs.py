"""A number of the proposed controller beside that of its competitor, with the competitor in either form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from replicate.exhibits.evidence import number
from replicate.loops import Signal
from replicate.papers.ali.examples import load_response, setpoint_response
from replicate.papers.ali.responses import PANELS, Comparison

KINDS = {"setpoint": "set point", "load": "load"}


class Pair(NamedTuple):
    """A number for the proposed controller and for its competitor."""

    proposed: float
    competitor: float

    def __str__(self) -> str:
        """Write both for an evidence text."""
        return f"{number(self.proposed)} against {number(self.competitor)}"


def outputs(comparison: Comparison, structure: str) -> tuple[Signal, Signal]:
    """Return the outputs of the proposed controller, in (2), and of the competitor in the given structure."""
    response = setpoint_response if comparison.kind == "setpoint" else load_response
    return (
        response(comparison.theta, "series", comparison.proposed).output,
        response(comparison.theta, structure, comparison.competitor).output,
    )


def pairs(comparison: Comparison, measure: Callable[[Signal], float]) -> dict[str, Pair]:
    """Measure both outputs, by the competitor's structure: that of (2), and the parallel form."""
    return {structure: Pair(*map(measure, outputs(comparison, structure))) for structure in PANELS}


def by_form(found: Mapping[str, Pair], forms: Mapping[str, str], between: str = "; ") -> str:
    """Write pairs with the names of the forms for an evidence text."""
    return between.join(f"{pair} ({forms[structure]})" for structure, pair in found.items())
