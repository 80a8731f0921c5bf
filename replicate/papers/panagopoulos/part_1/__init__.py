"""Paper I: design of PI controllers by non-convex optimisation, with its errata."""

MODULES: tuple[str, ...] = (
    "errata",
    "theorem_1",
    "table_1",
    "table_2",
    "table_3",
    "table_4",
    "table_5",
    "settling_evidence",
    "example_1",
    "example_2",
    "example_3",
    "example_4",
    "example_5",
    "example_6",
    "example_7",
    "example_8",
)
NUMBERED: tuple[str, ...] = (
    *(f"I-fig-{number}" for number in range(1, 10)),
    *(f"I-table-{number}" for number in range(1, 6)),
    *(f"I-example-{number}" for number in range(1, 9)),
)
