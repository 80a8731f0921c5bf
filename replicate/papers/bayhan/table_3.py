"""Table 3: time-domain specifications for Example 4.2, the rules that the paper found stable."""

from functools import partial

from replicate.exhibits import rank
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import EXAMPLE_42, SPECIFICATIONS, trials
from replicate.papers.bayhan.readings import LABELS, add_readings

ROWS = ("PA", "ZN", "ISE", "IAE", "ITAE", "ITAESPC")

table_3 = paper.table(
    "table-3",
    "Time-domain specifications for Example 4.2",
    rows=ROWS,
    columns=SPECIFICATIONS,
    caption="Unit step of the set point, $G(s) = e^{-0.5s}/(0.1s+1)$, $a = 0.3$; the dead time is five "
    "time constants. Conventions as in Table 2.",
    labels=LABELS,
    significant_digits=6,
)
add_readings(table_3, EXAMPLE_42)
table_3.trials = partial(trials, EXAMPLE_42, ROWS)

for _column, _says in (("settling_time", "which rule settles first"), ("overshoot", "which rule overshoots least")):
    rank(table_3, _column, table_3.rows, f"the ranking by {_column.replace('_', ' ')}: {_says}")
