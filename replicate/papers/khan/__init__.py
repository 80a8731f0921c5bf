"""Khan and Lehman: set-point PI controllers for systems with large normalized dead time."""

from replicate.exhibits import Paper

paper = Paper(
    id="khan",
    package=__name__,
    title="Setpoint PI Controllers for Systems with Large Normalized Dead Time",
    authors=("Babar Z. Khan", "Brad Lehman"),
    citation="B. Z. Khan and B. Lehman, “Setpoint PI controllers for systems with large normalized dead time”, "
    "IEEE Transactions on Control Systems Technology 4 (1996).",
    year=1996,
    modules=(
        "diagrams",
        "fig_3",
        "figs_4_5",
        "fit_quality",
        "refit",
        "break_point",
        "examples",
        "eq_7",
        "tables",
        "definitions",
        "fig_8",
        "appendix",
        "claims",
    ),
    numbered=(
        "fig-1",
        "fig-2",
        "fig-3",
        "fig-4",
        "fig-5",
        "fig-6",
        "fig-7",
        "fig-8a",
        "fig-8b",
        "fig-8c",
        "fig-8d",
        "table-1",
        "table-2",
        "example-2-1",
        "example-2-2",
        "example-2-3",
        "example-3-1",
    ),
    summary="The tables, the tuning rule (7b) and the fits hold: nearly every printed number comes out with the dead "
    "time exact. The rule (7a) for small dead times lost three zeros in print, the closed-form ISE has a sign error, "
    "two load settling times of Table I stand in each other's rows, and a few digits are wrong. Use the restored (7a) "
    "and the corrected J.",
)
