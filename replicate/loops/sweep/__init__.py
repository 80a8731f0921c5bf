"""Many loops at once: plants and controllers as a grid or in pairs, exact metrics out, no dense responses kept."""

from replicate.loops.sweep.running import sweep
from replicate.loops.sweep.sweep_result import SweepResult

__all__ = ["SweepResult", "sweep"]
