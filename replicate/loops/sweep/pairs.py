"""The metrics of pairs of a plant and a controller, loop by loop, for those who want all of them or nothing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from replicate.loops.controller import PID
from replicate.loops.plant import Plant
from replicate.loops.sweep.running import swept
from replicate.loops.sweep.sweep_result import PAIRWISE


def pair_metrics(
    loops: Sequence[tuple[Plant, PID]], metrics: Sequence[str], band: float = 0.02
) -> list[tuple[float, ...] | None]:
    """Return metrics of many loops, computed together where they share a plant.

    Parameters
    ----------
    loops
        Pairs of a plant and a controller, in any order.
    metrics
        Names of `replicate.loops.sweep.metric_names`, those of the package's own among them; real ones.
    band
        Half-width of the settling band; the level of ``load_last_above``.

    Returns
    -------
    list
        For each loop its metrics in the order asked; ``None`` for an unstable one, and one that lacks a metric.

    Examples
    --------
    >>> from replicate.loops import PI
    >>> plant = Plant([1.0], [1.0, 1.0], dead_time=1.0)
    >>> [stable, unstable] = pair_metrics([(plant, PI(0.5, 0.4)), (plant, PI(9.0, 9.0))], ["load_iae", "ms_frequency"])
    >>> round(stable[0], 6), round(stable[1], 6), unstable
    (2.5, 1.281281, None)
    """
    if not loops:
        return []
    found = swept([plant for plant, _ in loops], [one for _, one in loops], tuple(metrics), None, PAIRWISE, band)
    values = np.column_stack([found.values[name] for name in metrics])
    return [tuple(map(float, row)) if not np.isnan(row).any() else None for row in values]
