"""Table 2: time-domain specifications of the eleven rules for Example 4.1."""

from functools import partial

from replicate.exhibits import rank
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import EXAMPLE_41, RULES, SPECIFICATIONS, trials
from replicate.papers.bayhan.readings import LABELS, add_readings

table_2 = paper.table(
    "table-2",
    "Time-domain specifications for Example 4.1",
    rows=RULES,
    columns=SPECIFICATIONS,
    caption="Unit step of the set point, $G(s) = e^{-s}/(s+1)$, $a = 0.85$, $\\tau_{cl} = 0.06$. Overshoot "
    "is a fraction; times count from the step and include the dead time (settling to 2 %, delay to 50 %, "
    "rise from 10 % to 90 %). The paper prints six significant digits and strips trailing zeros.",
    labels=LABELS,
    significant_digits=6,
)
add_readings(table_2, EXAMPLE_41)
table_2.trials = partial(trials, EXAMPLE_41, RULES)

for _column, _says in (("settling_time", "which rule settles first"), ("overshoot", "which rule overshoots least")):
    rank(table_2, _column, table_2.rows, f"the ranking by {_column.replace('_', ' ')}: {_says}")
