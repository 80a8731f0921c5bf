"""What the tables print of a controller, computed from its gains."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from replicate.loops import PID
from replicate.papers.panagopoulos.part_2.load_experiment import MOST_LOOPS, load_experiment, loop_of
from replicate.papers.panagopoulos.part_2.setpoint import Resonance, filter_as_printed, weight

COLUMNS = ("k", "Ti", "Td", "b", "Tsp", "IE", "IE/IAE", "w0", "ts", "Mp")

LABELS = {
    "k": "$k$",
    "Ti": "$T_i$",
    "Td": "$T_d$",
    "b": "$b$",
    "Tsp": "$T_{sp}$",
    "IE": "IE",
    "IE/IAE": "IE/IAE",
    "w0": r"$\omega_0$",
    "ts": "$t_s$",
    "Mp": "$M_p$",
}

BAND = 0.02  # of the unit load step: the text gives no band; paper V of the thesis names 2 %


@dataclass(frozen=True)
class Properties:
    """One row of the tables.

    ``ts`` is the time after which the response to a unit load step stays within `BAND`.
    """

    k: float
    Ti: float
    Td: float
    b: float
    Tsp: float
    IE: float
    IAE: float
    w0: float
    ts: float
    Ms: float
    Mp: float

    @classmethod
    @lru_cache(MOST_LOOPS)
    def of(cls, process: str, controller: PID) -> Properties:
        """Compute them for a stable loop around one of the eight processes.

        Raises
        ------
        UnstableLoopError
            If the loop is unstable.
        """
        loop = loop_of(process, controller)
        sensitivity = loop.sensitivity_peak()
        peak = Resonance.of(loop)
        load = load_experiment(process, controller).output
        return cls(
            controller.k,
            controller.integral_time,
            controller.derivative_time,
            weight(controller, peak),
            filter_as_printed(controller, peak),
            1.0 / controller.ki,
            load.iae(),
            sensitivity.frequency,
            load.settling_time(BAND),
            sensitivity.value,
            peak.value,
        )

    def row(self) -> dict[str, float]:
        """Return the numbers by column key."""
        return {"IE/IAE": self.IE / self.IAE} | {c: getattr(self, c) for c in COLUMNS if c != "IE/IAE"}
