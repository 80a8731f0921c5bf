"""The checkable formulas of section 6 on what a change of the process does to a design."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.loops import PI, Loop, Plant
from replicate.papers.krajewski.claims import claims
from replicate.papers.krajewski.points import TAU, text_point
from replicate.papers.krajewski.robustness import changed

GAIN, DEAD_TIME, TIME_CONSTANT = 1.2, 0.9, 1.1  # K'/K, L'/L and T'/T of a process like any other
ROUNDING = 1e-9


def _deviations() -> tuple[float, float, float, float]:
    """Return the deviations of phase margin and crossover frequency by (24), and of the loops.

    The design is that of Fig. 9 (a), for K = T = 1; the loops are compared as they are, not normalised.
    """
    a, b = text_point("fig-9", "a")
    controller = PI(b, a)  # (23)
    loops = [
        Loop(Plant([1.0], [1.0, 1.0], dead_time=TAU), controller),
        Loop(Plant([GAIN], [TIME_CONSTANT, 1.0], dead_time=TAU * DEAD_TIME), controller),
    ]
    old, new = (loop.margins() for loop in loops)
    before = changed((a, b, TAU), 1.0, 1.0, 1.0)
    after = changed((a, b, TAU), GAIN, DEAD_TIME, TIME_CONSTANT)
    return (
        float(after.phase_margin - before.phase_margin),
        float(after.crossover - before.crossover),
        new.phase - old.phase,
        new.gain_crossover - old.gain_crossover,
    )


@claims.claim("eq-25", "(25) is the deviation of the phase margin from its old value.", where="section 6, (25)")
def eq_25() -> Finding:
    by_chart, _, true, _ = _deviations()
    return Finding(
        "undecided" if abs(by_chart - true) < ROUNDING else "fails",
        by_chart,
        "In our copy the old value has a prime, like the new one, in the paper or in the copy at hand; the text above "
        f"it says what is meant. Without it, for Fig. 9 (a) with $K$, $L$ and $T$ multiplied by {GAIN}, {DEAD_TIME} "
        "and "
        f"{TIME_CONSTANT}, (24) and (25) give {number(by_chart, 6)} degrees, as the loops themselves do.",
    )


@claims.claim(
    "eq-26",
    "(26) is the deviation of the actual crossover frequency from its old value.",
    where="section 6, (24), (26)",
)
def eq_26() -> Finding:
    _, by_chart, _, true = _deviations()
    return Finding(
        "holds" if abs(by_chart - true) < ROUNDING else "fails",
        by_chart,
        f"For the same change (24) and (26) give {number(by_chart, 6)}, as the loops themselves do: the crossover "
        "frequency "
        "of the normalised loop is divided by the new $T'$.",
    )
