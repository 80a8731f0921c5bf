"""How a paper describes itself: the words for its exhibits, its printed values, and what computing them gives."""

from replicate.exhibits.claims import Claim, Claims, ClaimVerdict, Consequence, Finding
from replicate.exhibits.comparisons import bound, rank
from replicate.exhibits.drawn import Chart, Figure, FigureKind
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.near import Near
from replicate.exhibits.notation import Notation
from replicate.exhibits.paper import Paper
from replicate.exhibits.readings import AS_WRITTEN, Reading
from replicate.exhibits.vocabulary import Exhibit, NotComputable, Table, TableKind

__all__ = [
    "AS_WRITTEN",
    "Chart",
    "Claim",
    "ClaimVerdict",
    "Claims",
    "Consequence",
    "Exercises",
    "Exhibit",
    "Figure",
    "FigureKind",
    "Finding",
    "Near",
    "NotComputable",
    "Notation",
    "Paper",
    "Reading",
    "Table",
    "TableKind",
    "bound",
    "rank",
]
