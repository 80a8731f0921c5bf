"""The points of the parameter plane that the paper names, and the loops at them; τ = 0.5 throughout."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

from replicate.loops import Signal
from replicate.papers.krajewski import paper
from replicate.papers.krajewski.loci import corners
from replicate.papers.krajewski.normalised_loop import (
    crossover,
    gain_ratio,
    loop,
    margin_along_crossover,
    phase_margin,
    point,
)

TAU = 0.5
METRICS = ("overshoot", "rise_time", "settling_time", "delay_time")


@dataclass(frozen=True)
class NamedPoint:
    """A point as the paper gives it.

    Attributes
    ----------
    a, b
        With the digits of the text, where an overline marks a repeating one.
    caption_b
        b with the digits of the figure's caption, which has no overlines.
    defined_by
        What the text says the point is; `exact` computes it.
    m_phi, g, omega_A
        The specifications that define it, ``None`` where they do not; m_phi in degrees.
    """

    exhibit: str
    row: str
    a: float
    b: float
    caption_b: float
    defined_by: str
    m_phi: float | None
    g: float | None
    omega_A: float | None  # noqa: N815  -- the paper's symbol

    def exact(self) -> tuple[float, float]:
        """Return the coordinates that follow from the definition."""
        if self.defined_by == "margin and crossover" and self.omega_A and self.m_phi:
            a, b = point(TAU, self.omega_A, self.m_phi)  # (11)
            return float(a), float(b)
        if self.defined_by == "abscissa and crossover" and self.omega_A:
            return self.a, margin_along_crossover(TAU, self.omega_A, self.a)[0]  # (16)
        if self.defined_by == "bisector and crossover" and self.omega_A:
            return self.omega_A, self.omega_A  # section 4: the ellipse meets b = a at a = b = ω_A
        if self.defined_by == "margins" and self.m_phi and self.g:
            lower, upper = corners(TAU, self.m_phi, self.g)
            corner = lower if self.row == "lower" else upper
            return corner.a, corner.b
        return self.a, self.b


def _number(text: str) -> float | None:
    return float(Fraction(text)) if text else None


@cache
def named_points(exhibit: str) -> dict[str, NamedPoint]:
    """Return the points of a figure by row."""
    text = (paper.folder() / "points.csv").read_text(encoding="utf-8")
    found = {}
    for row in csv.DictReader(text.splitlines()):
        if row["exhibit"] == exhibit:
            a, b, caption_b = (float(Fraction(row[key])) for key in ("a", "b", "caption_b"))
            specified = [_number(row[key]) for key in ("m_phi", "g", "omega_A")]
            found[row["row"]] = NamedPoint(exhibit, row["row"], a, b, caption_b, row["defined_by"], *specified)
    return found


def text_point(exhibit: str, row: str) -> tuple[float, float]:
    """Return (a, b) with the digits of the text."""
    named = named_points(exhibit)[row]
    return named.a, named.b


def trials(exhibit: str) -> dict[str, tuple[str, str]]:
    """Return plant and controller at each point of a figure, with the digits of the text, for readers to try out."""
    loops = {row: loop(named.a, named.b, TAU) for row, named in named_points(exhibit).items()}
    return {row: (at.plant.notation(), at.controller.notation()) for row, at in loops.items()}


@cache
def response(a: float, b: float) -> Signal:
    """Return the exact unit step response at a point, until every mode has decayed to rounding."""
    return loop(a, b, TAU).step()


def margins_at(a: float, b: float) -> dict[str, float]:
    """Return m_phi (degrees), g and omega_A at a point."""
    return {
        "m_phi": float(phase_margin(a, b, TAU)),
        "g": gain_ratio(a, b, TAU),
        "omega_A": float(crossover(a, b)),
    }


@cache
def metrics_at(a: float, b: float) -> dict[str, float]:
    """Return overshoot (a fraction), rise time 10 to 90 %, 2 % settling time and time to half the final value."""
    y = response(a, b)
    overshoot = y.overshoot()
    return {
        # A monotone response ends within rounding of 1, on either side.
        "overshoot": overshoot if overshoot > 1e-12 else 0.0,
        "rise_time": y.rise_time(),
        "settling_time": y.settling_time(),
        "delay_time": y.delay_time(),
    }
