"""The pairs of controllers that Figures 1 to 8 compare."""

from __future__ import annotations

from replicate.papers.ali.examples import EXAMPLE_1, EXAMPLE_2, example_1, example_2
from replicate.papers.ali.responses import Comparison, Kind


def padma_sree(kind: Kind, until: float = 30.0) -> Comparison:
    """Return the comparison of Example 1."""
    settings = example_1()
    return Comparison(EXAMPLE_1, settings["proposed"], settings["padma-sree"], "Padma Sree", kind, until)


def visioli(kind: Kind, until: float = 6.0) -> Comparison:
    """Return the comparison of Example 2: Visioli's setting for the set point or the one for the load."""
    settings = example_2()
    return Comparison(EXAMPLE_2, settings["proposed"], settings[f"visioli-{kind}"], "Visioli", kind, until)
