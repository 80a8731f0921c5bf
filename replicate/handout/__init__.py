"""Teaching handouts: a paper's problem, its idea, its numbers and its errors, with exercises, for a class."""

from replicate.handout.build import handouts, with_handout
from replicate.handout.class_set import ClassSet
from replicate.handout.form import Form
from replicate.handout.formats import BANKS, SLIDES, checked_format
from replicate.handout.making import Order, check_order, make, stress_test
from replicate.handout.own_code import LONGEST_RUN
from replicate.handout.own_exercises import own_exercises
from replicate.handout.roster import read_roster
from replicate.handout.sheet import Sheet, read_points, read_selection
from replicate.handout.stress import stressed

__all__ = [
    "BANKS",
    "LONGEST_RUN",
    "SLIDES",
    "ClassSet",
    "Form",
    "Order",
    "Sheet",
    "check_order",
    "checked_format",
    "handouts",
    "make",
    "own_exercises",
    "read_points",
    "read_roster",
    "read_selection",
    "stress_test",
    "stressed",
    "with_handout",
]
