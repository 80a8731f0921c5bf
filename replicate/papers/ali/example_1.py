"""Example 1: theta = 0.7, the proposed setting against Padma Sree's."""

from replicate.papers.ali import paper
from replicate.papers.ali.examples import (
    CAPTION,
    EXAMPLE_1,
    LABELS,
    QUANTITIES,
    add_readings,
    example_1,
)

example = paper.table(
    "example-1",
    "Example 1, $G(s) = e^{-0.7s}/(s-1)$",
    kind="example",
    printed=False,
    rows=QUANTITIES,
    columns=("proposed", "proposed-eq-11", "padma-sree"),
    caption=CAPTION + "The proposed setting is simulated as printed in Table 2; Padma Sree's is quoted from another "
    "paper and simulated as printed.",
    shared_labels=LABELS,
)
add_readings(
    example,
    EXAMPLE_1,
    example_1(),
    {},
)
