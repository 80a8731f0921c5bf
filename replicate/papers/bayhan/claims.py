"""The checkable sentences of the paper's text: what their checks share."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from typing import Literal

from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import EXAMPLE_41, EXAMPLE_42, PT326, RULES, Process, controllers, specifications
from replicate.papers.bayhan.readings import AUTHORS, TEXT
from replicate.papers.bayhan.toolchain import sampled_specifications

claims = paper.claims()

PROCESSES = (EXAMPLE_41, EXAMPLE_42, PT326)

Source = Literal["text", "authors"]  # equation (3) and exact dead time, or as the authors computed


@cache
def stable_rules(process: Process, source: Source) -> dict[str, dict[str, float]]:
    """Return the specifications of every rule whose loop settles."""
    assumption, method = (TEXT, specifications) if source == "text" else (AUTHORS, sampled_specifications)
    found = controllers(process, assumption.convention, assumption.variant)
    rows = {rule: method(process, found[rule]) for rule in RULES}
    return {rule: row for rule, row in rows.items() if not math.isnan(row["settling_time"])}


def column(process: Process, source: Source, name: str) -> dict[str, float]:
    """Return one specification of every rule whose loop settles."""
    return {rule: row[name] for rule, row in stable_rules(process, source).items()}


def ascending(values: Mapping[str, float]) -> dict[str, float]:
    """Return named numbers, the smallest first."""
    return dict(sorted(values.items(), key=lambda item: item[1]))
