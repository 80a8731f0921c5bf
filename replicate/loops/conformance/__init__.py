"""Exact values of hard control loops with dead time, and how many of their digits a library gets.

    python -m replicate.loops.conformance --library python-control

The values, `replicate/loops/goldens.json`, come from mpmath; any library may use them.
"""

from replicate.loops.conformance.digits import ATTAINABLE, Quantity, digits
from replicate.loops.conformance.goldens import Golden, goldens
from replicate.loops.conformance.library import Library, measure

__all__ = ["ATTAINABLE", "Golden", "Library", "Quantity", "digits", "goldens", "measure"]
