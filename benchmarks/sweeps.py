"""Sweeps: loops per second beside python-control, and how the time grows with loops, dead time and order."""

from __future__ import annotations

import resource
from functools import partial
from typing import Any

import control
import numpy as np

from benchmarks import exact_loop
from benchmarks.common import Table, open_loop, processor_time, seconds, times
from benchmarks.exact_loop import KI, K
from replicate.loops import Plant, sweep

PLANT = Plant.foptd(1.0, 1.0, 1.0)
RESPONSE = ("overshoot", "peak_time", "settling_time", "iae")
FREQUENCY = ("ms", "gain_margin", "phase_margin")
AIMS = {RESPONSE: "1000", FREQUENCY: "150"}  # times as many loops per second
MANY = 20_000
SOME = 2_000


def gains(count: int) -> Any:
    """Return k and ki of ``count`` controllers, the first of which has an exact solution."""
    random = np.random.default_rng(1998)
    rows = np.column_stack([random.uniform(0.2, 0.9, count), random.uniform(0.2, 0.7, count)])
    rows[0] = K, KI
    return rows


def around(k: float, ki: float, count: int) -> Any:
    """Return controllers within 30 % of one."""
    random = np.random.default_rng(1998)
    return np.column_stack([k * random.uniform(0.7, 1.3, count), ki * random.uniform(0.7, 1.3, count)])


def tables() -> list[Table]:
    """Return the tables of sweeps."""
    return [_beside_control(), _with_loops(), _with_dead_time(), _with_order()]


def _beside_control() -> Table:
    table = Table(
        f"A sweep of {MANY} loops e^(-s)/(s + 1) under PI control, each loop beside python-control",
        (
            "metrics",
            "sweep, per loop",
            "python-control, per loop",
            "times as many loops per second",
            "aim",
            "largest error",
        ),
    )
    loop: Any = open_loop(K, KI, [1.0], [1.0, 1.0], 1.0)
    anchors = {
        RESPONSE: lambda: control.step_info(control.feedback(loop)),
        FREQUENCY: lambda: control.stability_margins(loop),
        ("rightmost_pole",): lambda: control.feedback(loop).poles(),
    }
    rows, exact = gains(MANY), exact_loop.metrics()
    for names, anchor in anchors.items():
        theirs = processor_time(anchor, 10)
        ours = processor_time(partial(sweep, PLANT, rows, metrics=names), 3) / MANY
        result = sweep(PLANT, rows[:10], metrics=names)
        error = max(abs(complex(result[name][0, 0]) / exact[name] - 1.0) for name in names)
        aim = AIMS.get(names, "")
        table.add(", ".join(names), seconds(ours), seconds(theirs), times(theirs / ours), aim, f"{error:.1e}")
    return table


def _with_loops() -> Table:
    table = Table("Number of loops", ("loops", "processor time", "per loop", "largest memory of the process so far"))
    for count in (1_000, 10_000, 100_000, 1_000_000):
        rows = gains(count)
        spent = processor_time(partial(sweep, PLANT, rows, metrics=RESPONSE), 1)
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        table.add(f"{count}", seconds(spent), seconds(spent / count), f"{memory:.0f} MiB")
    return table


def _with_dead_time() -> Table:
    table = Table(
        f"Dead time over time constant, {SOME} loops around the SIMC tuning", ("L/T", "responses", "frequencies")
    )
    for ratio in (0.02, 0.1, 1.0, 10.0, 100.0):
        lag = 1.0 / ratio
        k = lag / 2.0
        rows = around(k, k / min(lag, 8.0), SOME)
        plant = Plant.foptd(1.0, lag, 1.0)
        table.add(f"{ratio:g}", *(_per_loop(plant, rows, names) for names in (RESPONSE, FREQUENCY)))
    return table


def _with_order() -> Table:
    table = Table(f"Order of the plant e^(-s/2)/(s/n + 1)^n, {SOME} loops", ("n", "responses", "frequencies"))
    for order in (1, 2, 3, 4, 6, 8):
        plant = Plant([float(order**order)], np.poly([-float(order)] * order), dead_time=0.5)
        table.add(f"{order}", *(_per_loop(plant, around(0.4, 0.5, SOME), names) for names in (RESPONSE, FREQUENCY)))
    return table


def _per_loop(plant: Plant, rows: Any, names: tuple[str, ...]) -> str:
    return seconds(processor_time(partial(sweep, plant, rows, metrics=names), 2) / SOME)
