"""Krajewski, Lepschy, Viaro: PI compensation of time delayed processes, design charts in the parameter plane."""

from replicate.exhibits import Paper

paper = Paper(
    id="krajewski",
    package=__name__,
    title="PI compensation of time delayed processes based on phase margin and crossover frequency",
    authors=("Wiesław Krajewski", "Antonio Lepschy", "Umberto Viaro"),
    citation="W. Krajewski, A. Lepschy and U. Viaro, “PI compensation of time delayed processes based on "
    "phase margin and crossover frequency”, Research Report RB/69/2001, Systems Research Institute, "
    "Polish Academy of Sciences, Warsaw, 2001.",
    year=2001,
    modules=(
        "fig_1",
        "fig_2",
        "fig_3",
        "fig_4",
        "fig_5",
        "table_1",
        "table_1_errors",
        "fig_6",
        "design",
        "robustness",
        "robustness_map",
        "fig_7",
        "combined_chart",
        "fig_8",
        "fig_9_to_12",
        "claims",
        "claims_loci",
        "claims_specifications",
        "claims_robustness",
        "claims_gain_margin",
        "claims_responses",
    ),
    numbered=(
        *(f"fig-{number}" for number in range(1, 13)),
        "table-1",
    ),
    summary="Charts from which a PI controller for a process with dead time is read off: loci of constant "
    "phase margin, gain margin and crossover frequency in the plane of the two normalised gains. The "
    "formulas and charts hold; one column of Table 1 is wrong, and three rules of thumb hold only in part.",
)
