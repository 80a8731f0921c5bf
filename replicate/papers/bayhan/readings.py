"""The readings that Tables 2 and 3 share: what is assumed, and how a whole table follows from it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from replicate.exhibits import AS_WRITTEN, Table
from replicate.loops import PI
from replicate.loops.tune import PRINTED
from replicate.papers.bayhan.processes import Convention, Process, controllers, specifications
from replicate.papers.bayhan.toolchain import GRIDS_TRIED, sampled_specifications

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Assumption:
    """One combination of gains and method of computation."""

    id: str
    title: str
    convention: Convention
    method: Callable[[Process, PI], dict[str, float]]
    variant: str = PRINTED
    note: str = ""

    def rows(self, process: Process, rules: Sequence[str]) -> dict[str, dict[str, float]]:
        """Return the specifications of every rule, by name."""
        found = controllers(process, self.convention, self.variant)
        return {rule: self.method(process, found[rule]) for rule in rules}


TEXT = Assumption(
    AS_WRITTEN,
    "Equation (3), exact dead time",
    "Kp/Ti",
    specifications,
    note="The competing rules of Table 1 with $K_i = K_p/T_i$, as equation (3) says; the dead time is "
    "exact and the specifications are read from the continuous response.",
)
GAINS = Assumption(
    "ki-over-ti",
    "$K_i = 1/T_i$, exact dead time",
    "1/Ti",
    specifications,
    note="As written, but with $K_i = 1/T_i$ for the ten competing rules. The difference to *authors* is "
    "the effect of the Padé model and the sample grid alone; the difference to the paper's text is the "
    "effect of the wrong gain alone.",
)
AUTHORS = Assumption(
    "authors",
    "The authors' computation: $K_i = 1/T_i$, Padé model, sample grid",
    "1/Ti",
    sampled_specifications,
    variant="authors",
    note="Reconstructed from the printed digits. The ten competing rules run with $K_i = 1/T_i$ (the pole "
    "assignment has its own $K_i$); Cohen–Coon uses the rule's original fractions; the dead time is the "
    "second-order Padé approximation (7); the response is sampled on 1000 equal steps over $2\\ln "
    "50/|\\mathrm{Re}\\,p|$, with $p$ the dominant pole, and once more over 1.1 times the settling time if "
    "it settles in the first half; every specification is a sample, not an interpolation.",
)
READINGS = (TEXT, GAINS, AUTHORS)

# Two further combinations, to separate the effects; they are counted, not shown cell by cell.
TEXT_ON_GRID = Assumption("eq3-grid", "Equation (3), Padé model, sample grid", "Kp/Ti", sampled_specifications)
GAINS_ON_GRID = Assumption(
    "ki-over-ti-grid",
    "$K_i = 1/T_i$, Padé model, sample grid, Table 1 as printed",
    "1/Ti",
    sampled_specifications,
)


def add_readings(table: Table, process: Process) -> None:
    """Register the three readings with a table of specifications."""
    for assumption in READINGS:

        def compute(assumption: Assumption = assumption) -> pd.DataFrame:
            return table.frame(assumption.rows(process, table.rows))

        tried = {} if assumption is TEXT else {"integral gain": 2, "exact or sampled": 2, "Cohen–Coon rule": 2}
        if assumption is AUTHORS:
            tried |= {choice: len(values) for choice, values in GRIDS_TRIED.items()}
        table.reading(assumption.id, assumption.title, assumption.note, tried=tried)(compute)


LABELS = {
    "overshoot": "Overshoot",
    "settling_time": "Settling time",
    "delay_time": "Delay time",
    "rise_time": "Rise time",
}
