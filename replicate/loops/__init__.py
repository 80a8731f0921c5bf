"""Control loops with dead time, exactly.

Plants with dead time, PI and PID controllers, and the loops made of them: time responses by a spectral method of steps,
metrics read from the piecewise polynomial, poles, sensitivity peaks and margins with the exact dead time.
"""

from replicate.loops.controller import PI, PID
from replicate.loops.design.circles import Circle
from replicate.loops.design.design_pi import design_pi
from replicate.loops.design.design_pid import design_pid, search_range
from replicate.loops.design.nyquist_constraints import Constraint
from replicate.loops.design.pi_result import PIDesign
from replicate.loops.design.pid_result import PIDDesign
from replicate.loops.design.setpoint_weights import pid_setpoint_weight, setpoint_weight
from replicate.loops.errors import ImproperLoopError, LoopError, NotSettledError, UnstableLoopError
from replicate.loops.frequency_domain.gamma_norm import Weight, gamma_norm, stability_margin
from replicate.loops.frequency_domain.margins import Margins
from replicate.loops.frequency_domain.nu_gap import WindingCount, chordal_distance, nu_gap, winding_count
from replicate.loops.loop import Loop
from replicate.loops.numerics.peaks import FrequencyPeak, Peak
from replicate.loops.plant import Plant
from replicate.loops.prediction.smith_predictor import SmithPredictor
from replicate.loops.step_responses import step_responses
from replicate.loops.sweep import SweepResult, sweep
from replicate.loops.time_domain.signal import Response, Signal

__all__ = [
    "PI",
    "PID",
    "Circle",
    "Constraint",
    "FrequencyPeak",
    "ImproperLoopError",
    "Loop",
    "LoopError",
    "Margins",
    "NotSettledError",
    "PIDDesign",
    "PIDesign",
    "Peak",
    "Plant",
    "Response",
    "Signal",
    "SmithPredictor",
    "SweepResult",
    "UnstableLoopError",
    "Weight",
    "WindingCount",
    "chordal_distance",
    "design_pi",
    "design_pid",
    "gamma_norm",
    "nu_gap",
    "pid_setpoint_weight",
    "search_range",
    "setpoint_weight",
    "stability_margin",
    "step_responses",
    "sweep",
    "winding_count",
]
