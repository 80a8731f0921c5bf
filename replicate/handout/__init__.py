"""Teaching handouts: a paper's problem, its idea, its numbers and its errors, with exercises, for a class."""

from replicate.handout.build import build_handouts, checked_format, with_handout
from replicate.handout.class_set import ClassSet, varying
from replicate.handout.form import Form
from replicate.handout.roster import read_roster
from replicate.handout.stress import stressed

__all__ = [
    "ClassSet",
    "Form",
    "build_handouts",
    "checked_format",
    "read_roster",
    "stressed",
    "varying",
    "with_handout",
]
