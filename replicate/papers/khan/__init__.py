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
        "exact_forms",
        "refit",
        "break_point",
        "examples",
        "eq_7",
        "coefficients_7",
        "tables",
        "definitions",
        "evidence",
        "fig_8",
        "appendix",
        "claims",
        "claims_pi",
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
    summary="The tables, the rule (7b), its robustness and the fits hold: nearly every printed number comes out with "
    "the dead time exact. Rule (7a), for small dead times, has lost three zeros, and the closed-form ISE has a sign "
    "error: use them as corrected here. Two load settling times of Table I stand in each other's rows, and a few "
    "digits are wrong. In place of the fits there are closed forms, exact for most gains, and a smooth formula for "
    "all.",
)
