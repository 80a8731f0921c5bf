"""Table 1: settings, and the sensitivity that they specify and really give."""

from replicate.papers.ali import paper
from replicate.papers.ali.sensitivities import LABELS, add_readings

table_1 = paper.table(
    "table-1",
    "Settings for $KK_p = \\sqrt{2T/\\theta}$",
    rows=tuple(f"0.{tenths}" for tenths in range(1, 10)),
    columns=("KKp", "Ti", "Ms", "Ms_star"),
    caption="Rows: $\\theta/T$. $M_s^*$ is the specified maximum sensitivity, $M_s$ the true one; times in "
    "units of $T$, $T_d = \\theta/2$. Row 0.5 is a tie: $M_s^* = 2$ makes $q$ exactly zero, so the search is "
    "decided in exact fractions.",
    shared_labels=LABELS,
)
add_readings(table_1)
