"""What the tables print of a controller, computed from its gains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from replicate.loops import PID
from replicate.loops.sweep.pairs import pair_metrics
from replicate.papers.panagopoulos.part_2.load_experiment import MOST_LOOPS, load_experiment, loop_of
from replicate.papers.panagopoulos.part_2.processes import PLANTS
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
    wmp: float

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
        settled = load.settling_time(BAND)
        return cls._of(controller, sensitivity.value, sensitivity.frequency, peak, load.iae(), settled)

    @classmethod
    def of_many(cls, loops: Sequence[tuple[str, PID]]) -> list[Properties | None]:
        """Compute them for many loops at once; ``None`` for those that are not stable."""
        metrics = ("ms", "ms_frequency", "mp", "mp_frequency", "load_iae", "load_settling_time")
        found = pair_metrics([(PLANTS[process], controller) for process, controller in loops], metrics, BAND)
        return [
            cls._of(controller, one[0], one[1], Resonance(one[3], one[2]), *one[4:]) if one else None
            for (_, controller), one in zip(loops, found, strict=True)
        ]

    @classmethod
    def _of(cls, controller: PID, ms: float, w0: float, peak: Resonance, iae: float, settled: float) -> Properties:
        return cls(
            controller.k,
            controller.integral_time,
            controller.derivative_time,
            weight(controller, peak),
            filter_as_printed(controller, peak),
            1.0 / controller.ki,
            iae,
            w0,
            settled,
            ms,
            peak.value,
            peak.frequency,
        )

    @property
    def peak(self) -> Resonance:
        """Where the complementary sensitivity has its peak."""
        return Resonance(self.wmp, self.Mp)

    def row(self) -> dict[str, float]:
        """Return the numbers by column key."""
        return {"IE/IAE": self.IE / self.IAE} | {c: getattr(self, c) for c in COLUMNS if c != "IE/IAE"}
