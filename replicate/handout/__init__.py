"""Teaching handouts: a paper's problem, its idea, its numbers and its errors, with exercises, for a class."""

from replicate.handout.build import build_handouts, checked_format, with_handout

__all__ = ["build_handouts", "checked_format", "with_handout"]
