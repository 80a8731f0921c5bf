"""Bayhan, Soylemez, Bostan: overshoot-free PI controller tuning based on pole assignment."""

from replicate.exhibits import Paper

paper = Paper(
    id="bayhan",
    package=__name__,
    title="Overshoot Free PI Controller Tuning Based on Pole Assignment",
    authors=("Nevra Bayhan", "Mehmet Turan Söylemez", "Tuğba Bostan"),
    # Venue and year are not on the page we have; they are how the paper is cited.
    citation="N. Bayhan, M. T. Söylemez and T. Bostan, “Overshoot free PI controller tuning based on pole "
    "assignment”, 5th International Conference on Electrical and Electronics Engineering (ELECO), Bursa, "
    "2007.",
    year=2007,
    modules=(
        "fig_1",
        "equations",
        "table_1",
        "inputs",
        "table_2",
        "fig_2",
        "table_3",
        "fig_3",
        "fig_4",
        "fig_5",
        "evidence",
        "grids_tried",
        "claims",
        "claims_formulas",
        "claims_choice_of_a",
        "claims_examples",
        "claims_table_1",
        "claims_pt326",
    ),
    numbered=(
        "fig-1",
        "table-1",
        "example-4-1",
        "table-2",
        "fig-2",
        "example-4-2",
        "table-3",
        "fig-3",
        "fig-4",
        "fig-5",
    ),
    summary="A tuning rule that gives the loop a double pole, compared with ten classical rules. The rule "
    "holds. The comparison does not: the classical rules were run with the integral gain $1/T_i$ where the "
    "paper's equation (3) says $K_p/T_i$. With $1/T_i$, on the authors' own Padé model and sample grid, the tables "
    "are reproduced digit for digit; computed as written, they are not.",
)
