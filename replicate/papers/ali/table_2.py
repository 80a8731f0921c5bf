"""Table 2: the reduced gain for theta/T > 0.5."""

from replicate.papers.ali import paper
from replicate.papers.ali.sensitivities import LABELS, add_readings

table_2 = paper.table(
    "table-2",
    "Settings for $KK_p = (2T/\\theta)^{0.4}$",
    rows=("0.6", "0.7", "0.8", "0.9", "1.0"),
    columns=("KKp", "Ti", "Ms"),
    caption="Rows: $\\theta/T$. $T_i$ is that of Table 1, found with the larger gain $\\sqrt{2T/\\theta}$; "
    "Table 1 has no row 1.0, so its $T_i$ is found the same way here.",
    shared_labels=LABELS,
)
add_readings(table_2)
