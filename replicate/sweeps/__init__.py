"""Sweeps that are too large for one call: a grid of loops from a file, computed and written block by block."""

from replicate.sweeps.running import run_sweep
from replicate.sweeps.sweep_file import SweepFile, read_sweep_file

__all__ = ["SweepFile", "read_sweep_file", "run_sweep"]
