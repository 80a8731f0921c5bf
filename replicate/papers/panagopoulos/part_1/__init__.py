"""Paper I: design of PI controllers by non-convex optimisation, with its errata."""

MODULES: tuple[str, ...] = (
    "errata",
    "fig_1",
    "fig_2",
    "theorem_1",
    "fig_3",
    "fig_4",
    "table_1",
    "table_2",
    "fig_5",
    "table_3",
    "table_4",
    "table_5",
    "settling_evidence",
    "example_1",
    "example_2",
    "example_3",
    "example_4",
    "example_5",
    "fig_6",
    "fig_7",
    "example_6",
    "fig_8",
    "example_7",
    "fig_9",
    "example_8",
)
NUMBERED: tuple[str, ...] = (
    *(f"I-fig-{number}" for number in range(1, 10)),
    *(f"I-table-{number}" for number in range(1, 6)),
    *(f"I-example-{number}" for number in range(1, 9)),
)
