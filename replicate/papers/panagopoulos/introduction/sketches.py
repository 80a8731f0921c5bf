"""The introduction's figures and formulas: definitions and sketches, none of which states a number."""

from __future__ import annotations

from replicate.exhibits.drawn import FigureKind
from replicate.papers.panagopoulos import paper

FIGURES: tuple[tuple[str, str, FigureKind, str], ...] = (
    ("fig-1", "The problem of the PI and PID design", "diagram", "A block diagram; paper II prints it as Figure 1."),
    (
        "fig-2",
        "The output after a unit load step, its area shaded",
        "figure",
        "A sketch of an unnamed process. That the area is $1/k_i$ is a claim of paper I.",
    ),
    ("fig-3", "The circle that the Nyquist curve avoids", "figure", "A sketch of the constraint, without numbers."),
    ("fig-4", "The problem formulation of the design", "figure", "A sketch of the formula (0.2), without numbers."),
    ("fig-5", "Control with active damping", "diagram", "A block diagram; paper VI prints it as Figure 2."),
    (
        "fig-6",
        "What active damping needs of a frequency response",
        "figure",
        "A sketch; paper VI prints it as Figure 5.",
    ),
)
for _id, _title, _kind, _reason in FIGURES:
    paper.not_computable(_id, _title, _reason, kind=_kind)

paper.not_computable(
    "formula-0-1",
    "The controller (0.1)",
    "A definition. With $b$ and both filters it is the controller of all designs in this report.",
    kind="formula",
)
paper.not_computable(
    "formula-0-2",
    "The design problem (0.2)",
    "A definition: the largest $k_i$ outside a circle. Papers I and II solve it, and their tables check it.",
    kind="formula",
)
