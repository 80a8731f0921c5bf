"""Ali, Majhi: controller design for unstable first-order plants with dead time, based on sensitivity."""

from replicate.exhibits import Paper

paper = Paper(
    id="ali",
    package=__name__,
    title="Controller Design for Unstable FOPTD Plants based on Sensitivity",
    authors=("Ahmad Ali", "Somanath Majhi"),
    # Venue and year are not on the page we have; they are how the paper is cited.
    citation="A. Ali and S. Majhi, “Controller design for unstable FOPTD plants based on sensitivity”, "
    "Proceedings of the 17th IFAC World Congress, Seoul, 2008.",
    year=2008,
    modules=(
        "equations",
        "table_1",
        "table_2",
        "sensitivity_count",
        "tangency",
        "eq_11",
        "stability",
        "quoted_settings",
        "example_1",
        "figs_1_to_4",
        "example_2",
        "figs_5_to_8",
        "claims",
        "claims_tables",
        "claims_example_1",
        "claims_example_2",
    ),
    numbered=(
        "table-1",
        "table-2",
        "example-1",
        "example-2",
        *(f"fig-{number}" for number in range(1, 9)),
    ),
    summary="A PID rule for unstable plants with dead time: it cancels the pole of a Padé model and is meant to keep "
    "a specified distance from the critical point. The settings agree in all printed digits and are stable. The "
    "printed maximum sensitivities are not those of the printed controller, and the specified distance is not kept, "
    "because a square root was taken with the wrong sign.",
)
