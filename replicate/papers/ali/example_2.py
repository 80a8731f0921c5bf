"""Example 2: theta = 0.2, the proposed setting against Visioli's two."""

from replicate.papers.ali import paper
from replicate.papers.ali.examples import (
    CAPTION,
    EXAMPLE_2,
    LABELS,
    QUANTITIES,
    add_readings,
    example_2,
)
from replicate.papers.ali.sensitivities import designed

example = paper.table(
    "example-2",
    "Example 2, $G(s) = e^{-0.2s}/(s-1)$",
    kind="example",
    rows=QUANTITIES,
    columns=("proposed", "proposed-eq-11", "visioli-setpoint", "visioli-load"),
    caption=CAPTION + "Settings are simulated as printed (the proposed one is shown unrounded); Visioli's are quoted "
    "from another paper, one for the set point and one for the load, and each is tried on both.",
    shared_labels=LABELS,
)
add_readings(
    example,
    EXAMPLE_2,
    example_2(),
    {"proposed": designed("table-1", "0.2")},
)
