"""Exercises on control loops whose numbers vary, for the handouts of any paper: what lecturers of control ask again.

Each function registers one exercise with the paper's `Exercises`; the text around it is the paper's own.
"""

from replicate.teaching.bode_reading import bode_reading
from replicate.teaching.control_effort import control_effort
from replicate.teaching.nyquist_reading import nyquist_reading
from replicate.teaching.sketch import sketch
from replicate.teaching.step_test import step_test
from replicate.teaching.windup import windup

__all__ = ["bode_reading", "control_effort", "nyquist_reading", "sketch", "step_test", "windup"]
