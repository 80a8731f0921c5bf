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
        "fig_1",
        "fig_2",
        "fig_3",
        "figs_4_5",
        "fit_quality",
        "exact_forms",
        "refit",
        "break_point",
        "bryant",
        "examples_2",
        "figs_6_7",
        "example_3_1",
        "eq_7",
        "coefficients_7",
        "tables",
        "definitions",
        "evidence",
        "fig_8",
        "appendix",
        "appendix_coefficients",
        "claims",
        "claims_pi",
        "claims_robustness",
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
    summary="Most numbers of the tables hold, and so do the rule (7b), its robustness and the fits. Wrong in the print "
    "or in the copy at hand: (7a), which lacks three zeros and must read $K_P = -0.0404p^2h + 0.0723p + 0.3852/h$, "
    "$K_I = -0.0525p^2 + 0.4104p/h - 0.00024/h^2$; the closed-form ISE, whose second numerator must begin with "
    "$K_I - K_P p$; and single digits. Misprinted: two load settling times of Table I, each in the other's row. In "
    "place of the fits there are closed forms, exact for most gains.",
)
