"""The process e^{-hs}/(s + p) of the paper, its PI controllers, and what the tables say of a loop."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from math import isnan

from replicate.loops import PI, Loop, Plant
from replicate.loops.sweep import late_load
from replicate.loops.sweep.pairs import pair_metrics
from replicate.loops.tune import TuningRule, load_rules

# When the load enters: 100 is named in the text for ph = 10; 25 and 5 are what the printed digits need.
LOAD_AT = {10.0: 100.0, 1.0: 25.0, 0.1: 5.0}
PRINTED, RESTORED, UNROUNDED = "printed", "restored", "unrounded"

# A rule of the tables is one or two cases, each with its own range of ph.
CASES = {
    "Proposed": ("7a", "7b"),
    "ISE": ("ISE-I", "ISE-II"),
    "Haalman": ("Haalman",),
    "Bryant": ("Bryant",),
    "ZN": ("ZN",),
    "CC": ("CC",),
    "ITAE": ("ITAE",),
}
NAMES = {
    "Proposed": "Proposed (7)",
    "ISE": "ISE set point",
    "ZN": "Ziegler-Nichols",
    "CC": "Cohen-Coon",
    "ITAE": "ITAE set point",
}


@cache
def _rules(variant: str) -> dict[str, TuningRule]:
    return load_rules(files(__package__) / "tuning_rules.toml", variant)


def plant(p: float, h: float) -> Plant:
    """Return e^{-hs}/(s + p); p = 0 is the astatic plant."""
    return Plant([1.0], [1.0, p], dead_time=h)


def case_gains(case: str, p: float, h: float, variant: str = PRINTED) -> tuple[float, float]:
    """Return (K_P, K_I) of one case of a rule, whatever its range."""
    symbols = {"p": p, "h": h, "K": 1.0 / p, "tau": 1.0 / p, "L": h}
    gains = _rules(variant)[case].evaluate(**symbols)
    return float(gains.kp), float(gains.ki)


def gains(rule: str, p: float, h: float, variant: str = PRINTED) -> tuple[float, float]:
    """Return (K_P, K_I) of a rule of the tables; where two cases meet, the first."""
    cases = [_rules(variant)[case] for case in CASES[rule]]
    fitting = [c for c in cases if c.holds is None or c.holds.contains(p=p, h=h)]
    return case_gains((fitting or cases[-1:])[0].id, p, h, variant)


def loop(rule: str, p: float, h: float, variant: str = PRINTED) -> Loop:
    """Return the loop of a rule."""
    kp, ki = gains(rule, p, h, variant)
    return Loop(plant(p, h), PI(kp, ki))


def settling_after_load(closed: Loop, load_at: float | None) -> float:
    """Return t_d: the last time, counted from the load step, at which |y - 1| > 0.02.

    Parameters
    ----------
    load_at
        When the load enters the running set-point response; ``None``: long after it has settled.
    """
    if load_at is None:
        return closed.load_step().settling_time(0.02)
    end = load_at + closed.horizon()
    return closed.respond(load=1.0, load_at=load_at, until=end).output.settling_time(0.02) - load_at


def specifications(closed: Loop, load_at: float | None) -> tuple[float, float, float, float]:
    """Return overshoot in per cent, t_s, t_d and M_s."""
    y = closed.step()
    return (
        100.0 * y.overshoot(),
        y.settling_time(0.02),
        settling_after_load(closed, load_at),
        float(closed.sensitivity_peak()),
    )


def specifications_of_many(
    p: float, h: float, controllers: Sequence[PI], load_at: float
) -> list[tuple[float, float, float, float] | None]:
    """Return `specifications` of many loops around one process; ``None`` for those that are not stable."""
    process = plant(p, h)
    found = pair_metrics([(process, pi) for pi in controllers], ("overshoot", "settling_time", "ms"), 0.02)
    settled = late_load.settling_after_load(process, controllers, load_at, 0.02)

    def settling_time(pi: PI, known: float) -> float:
        return settling_after_load(Loop(process, pi), load_at) if isnan(known) else known

    return [
        (100.0 * one[0], one[1], settling_time(pi, time), one[2]) if one else None
        for pi, one, time in zip(controllers, found, settled.tolist(), strict=True)
    ]
