"""Teaching handouts: a paper's problem, its idea, its numbers and its errors, with exercises, for a class."""

from replicate.handout.build import build_handouts, with_handout
from replicate.handout.class_set import ClassSet, varying
from replicate.handout.exercise_heads import check_sheet
from replicate.handout.form import Form
from replicate.handout.formats import BANKS, SLIDES, checked_format
from replicate.handout.own_exercises import own_exercises
from replicate.handout.roster import read_roster
from replicate.handout.sheet import Sheet, language, read_points, read_selection
from replicate.handout.stress import stressed

__all__ = [
    "BANKS",
    "SLIDES",
    "ClassSet",
    "Form",
    "Sheet",
    "build_handouts",
    "check_sheet",
    "checked_format",
    "language",
    "own_exercises",
    "read_points",
    "read_roster",
    "read_selection",
    "stressed",
    "varying",
    "with_handout",
]
