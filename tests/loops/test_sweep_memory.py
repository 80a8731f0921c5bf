"""A million loops stay within two GiB: what a process needs for fewer grows no faster than the results themselves."""

from __future__ import annotations

import subprocess
import sys

MILLION = 1_000_000
LIMIT = 2 * 1024**3

CHILD = """
import resource, sys
import numpy as np
from replicate.loops import Plant, sweep
count = int(sys.argv[1])
random = np.random.default_rng(0)
gains = np.column_stack([random.uniform(0.2, 0.9, count), random.uniform(0.2, 0.7, count)])
names = ["overshoot", "peak_time", "settling_time", "iae", "ms", "gain_margin", "phase_margin", "total_variation"]
result = sweep(Plant.foptd(1.0, 1.0, 1.0), gains, metrics=names)
assert result["iae"].shape == (1, count)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024))
"""


def peak_memory(count: int) -> int:
    """Return the largest memory in bytes of a process of its own that sweeps ``count`` loops."""
    done = subprocess.run(
        [sys.executable, "-c", CHILD, str(count)], capture_output=True, text=True, check=True, timeout=300
    )
    return int(done.stdout)


def test_the_memory_of_a_million_loops_stays_below_two_gib() -> None:
    few, more = peak_memory(4_000), peak_memory(64_000)
    per_loop = (more - few) / 60_000
    # nine columns of results, the gains, a reason and a label for each loop, and nothing that grows faster
    assert few + per_loop * MILLION < LIMIT
