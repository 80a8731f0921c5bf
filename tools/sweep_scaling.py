"""How the cost of a sweep grows with its loops and with workers: seconds on a real Dask cluster on this machine.

python tools/sweep_scaling.py [MOST_LOOPS]

Prints a row for each number of loops and of workers, then, from two sizes of blocks, what a loop costs, what each block
costs beside its loops, and from both the cost of 10^9 loops.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from dask_cluster import cluster

from replicate.run.backends import DaskCluster
from replicate.sweeps import read_sweep_file, run_sweep

FILE = """
metrics = ["overshoot", "settling_time", "iae"]
plants = "e^{{-s}}/(s+1)"
block = {block}

[controllers]
k = {{ from = 0.1, to = 0.8, points = {k} }}
ki = {{ from = 0.1, to = 0.6, points = {ki} }}
"""
BLOCK = 10_000


def seconds(address: str, loops: int, folder: Path, block: int = BLOCK) -> float:
    """Return the time that a sweep takes."""
    file = folder / f"sweep-{loops}-{block}-{time.monotonic_ns()}.toml"
    file.write_text(FILE.format(block=block, k=loops // 100, ki=100), encoding="utf-8")
    sweep = read_sweep_file(file)
    begun = time.perf_counter()
    run_sweep(sweep, folder / file.stem, "csv", DaskCluster(address))
    return time.perf_counter() - begun


def main(most: int) -> None:
    """Print the table."""
    sizes = [size for size in (10_000, 100_000, 1_000_000) if size <= most]
    print("| loops | workers | s | µs per loop and worker |\n|---|---|---|---|")
    for workers in (1, 2):
        with tempfile.TemporaryDirectory() as name, cluster(Path(name), workers) as running:
            seconds(running.address, 10_000 * workers, Path(name))  # the workers import what they need
            for size in sizes:
                took = seconds(running.address, size, Path(name))
                print(f"| {size:,} | {workers} | {took:.1f} | {took / size * workers * 1e6:.0f} |")
            if workers == 1:
                large = seconds(running.address, 100_000, Path(name))
                small = seconds(running.address, 100_000, Path(name), BLOCK // 10)
    blocks = 100_000 / BLOCK
    overhead = (small - large) / (9 * blocks)
    each = (large - blocks * overhead) / 100_000
    print(
        f"\n{each * 1e6:.0f} µs for a loop, {overhead * 1e3:.0f} ms for a block of any size: 10^9 loops in blocks of "
        f"{BLOCK:,} take {(each + overhead / BLOCK) * 1e9 / 3600:.0f} hours of one such core"
    )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000)
