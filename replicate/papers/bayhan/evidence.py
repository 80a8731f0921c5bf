"""Two exhibits the paper does not have, which show how its tables were computed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import EXAMPLE_41, EXAMPLE_42, controllers
from replicate.papers.bayhan.readings import AUTHORS, GAINS, GAINS_ON_GRID, TEXT, TEXT_ON_GRID
from replicate.papers.bayhan.table_2 import table_2
from replicate.papers.bayhan.table_3 import table_3
from replicate.papers.bayhan.toolchain import sampled_response

if TYPE_CHECKING:
    import pandas as pd

TABLES = ((table_2, EXAMPLE_41), (table_3, EXAMPLE_42))
STEP_ROWS = tuple(f"{table.id}-{row}" for table, _ in TABLES for row in table.rows)
TIMES = ("settling_time", "delay_time", "rise_time")

Printed = dict[tuple[str, str], str]


def six_digits(number: float | str) -> str:
    """Round to the six significant digits of the paper's tables.

    Examples
    --------
    >>> six_digits("6.968"), six_digits(6.968004)
    ('6.96800', '6.96800')
    """
    return f"{float(number):#.6g}"


sample_grid = paper.table(
    "sample-grid",
    "The printed times count samples",
    printed=False,
    rows=STEP_ROWS,
    columns=("step", "settling_time", "off_settling", "delay_time", "off_delay", "rise_time", "off_rise"),
    caption="Each printed time in sample steps of its row, and how far it is from the nearest whole number "
    "of steps, in units of its sixth significant digit. A time read off samples is a whole number of "
    "steps, so it can be off by half a unit, from rounding, but not by more.",
    labels={
        **{key: f"Table {key[6]}, {key[8:]}" for key in STEP_ROWS},
        "step": "Step",
        "settling_time": "Settling",
        "delay_time": "Delay",
        "rise_time": "Rise",
        "off_settling": "off by",
        "off_delay": "off by",
        "off_rise": "off by",
    },
)


@sample_grid.reading("as-written", "Printed times in sample steps")
def in_steps() -> pd.DataFrame:
    """Divide every printed time by its row's sample step."""
    rows: dict[str, list[float]] = {}
    for table, process in TABLES:
        printed = paper.printed_cells(table.id)
        found = controllers(process, AUTHORS.convention, AUTHORS.variant)
        for row in table.rows:
            response = sampled_response(process, found[row].k, found[row].ki)
            if response is None:
                msg = f"{table.id}, {row}: the loop is unstable on the authors' grid: no sample step"
                raise ValueError(msg)
            step = response.spacing
            times = [float(printed[row, time]) for time in TIMES]
            off = [round((time - round(time / step) * step) / last_digit(time), 2) for time in times]
            counts = [time / step for time in times]
            pairs = zip(counts, off, strict=True)
            rows[f"{table.id}-{row}"] = [step, *(entry for pair in pairs for entry in pair)]
    return sample_grid.frame(rows)


def last_digit(value: float) -> float:
    """Return the weight of the sixth significant digit.

    Examples
    --------
    >>> last_digit(14.8902), last_digit(0.0387)
    (0.0001, 1e-07)
    """
    return float(f"1e{math.floor(math.log10(abs(value))) - 5}")


match_count = paper.table(
    "match-count",
    "Printed values reproduced, by assumption",
    printed=False,
    rows=tuple(assumption.id for assumption in (TEXT, TEXT_ON_GRID, GAINS, GAINS_ON_GRID, AUTHORS)),
    columns=("table_2", "table_3", "both", "within_1_percent", "printed"),
    caption="How many printed values of Tables 2 and 3 agree in all six significant digits, under "
    "each combination of integral gain (equation (3), or $1/T_i$) and method (exact, or Padé model and "
    "sample grid), and how many come within 1 % of the print.",
    labels={
        TEXT.id: "Equation (3), exact",
        TEXT_ON_GRID.id: "Equation (3), Padé and grid",
        GAINS.id: "$K_i = 1/T_i$, exact",
        GAINS_ON_GRID.id: "$K_i = 1/T_i$, Padé and grid",
        AUTHORS.id: "The same, original Cohen–Coon",
        "table_2": "Table 2",
        "table_3": "Table 3",
        "both": "Both",
        "within_1_percent": "Within 1 %",
        "printed": "Of",
    },
)


@match_count.reading("as-written", "Number of printed values reproduced")
def matches() -> pd.DataFrame:
    """Count the printed values that each combination of assumptions meets."""
    rows: dict[str, list[int]] = {}
    for assumption in (TEXT, TEXT_ON_GRID, GAINS, GAINS_ON_GRID, AUTHORS):
        equal, near, cells = [], 0, 0
        for table, process in TABLES:
            computed = assumption.rows(process, table.rows)
            printed = paper.printed_cells(table.id)
            pairs = [(text, computed[row][column]) for (row, column), text in printed.items()]
            equal.append(sum(agree(text, value) for text, value in pairs))
            near += sum(agree(text, value) or abs(value - float(text)) <= 0.01 * float(text) for text, value in pairs)
            cells += len(pairs)
        rows[assumption.id] = [*equal, sum(equal), near, cells]
    return match_count.frame(rows)


def agree(printed: str, computed: float) -> bool:
    """Whether a computed value agrees with a printed one in all six digits."""
    # A printed 0 is an overshoot, a fraction: it is taken as zero to six decimals.
    return six_digits(printed) == six_digits(computed) if float(printed) else abs(computed) < 0.5e-6
