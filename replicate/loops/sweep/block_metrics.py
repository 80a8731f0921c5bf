"""The metrics of a block of loops, all at once, and which loops or questions are left to the single loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.plant import Plant
from replicate.loops.sweep.batch_poles import rightmost_poles
from replicate.loops.sweep.frequency_metrics import FrequencyMetrics
from replicate.loops.sweep.loop_columns import LoopColumns
from replicate.loops.sweep.marching import march
from replicate.loops.sweep.metric_names import LOAD, POLE, STABLE
from replicate.loops.sweep.one_loop import UNSTABLE
from replicate.loops.sweep.paces import FEWEST
from replicate.loops.sweep.response_metrics import ResponseMetrics
from replicate.loops.sweep.stability_counts import STABLE as IS_STABLE
from replicate.loops.sweep.stability_counts import UNDECIDED, stability

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Places = NDArray[np.intp]

AT_A_TIME = 512
SHORTER = (1, 2, 4)
OF_THE_LOOP = ("ms", "mp", "ms_frequency", "mp_frequency", "gain_margin", "phase_margin", "delay_margin")
IN_TIME = {"delay_margin": 1, "ms_frequency": -1, "mp_frequency": -1}  # the power of the unit of time in them
RELATIVE = ("overshoot", "rise_time", "delay_time")  # to the final value
OF_THE_SIZE = ("overshoot", "peak")  # no unit of time in them
OF_A_SQUARE = ("itae", "itse")  # squares of the unit of time
VARIATION = "total_variation"  # in the unit of the control signal
ABOVE = "last_above"  # the band: of a load response, which ends at zero
OF_A_RESPONSE = (*RELATIVE, "peak", "peak_time", "settling_time", "iae", "ise", "ie", *OF_A_SQUARE, VARIATION)


@dataclass(frozen=True)
class BlockMetrics:
    """What the loops of a block answered.

    Attributes
    ----------
    stable
        Shape (n,).
    values
        By name, shape (n,); ``nan`` where a value does not exist.
    reasons
        Pairs of flags and the reason why the flagged loops lack values.
    alone
        Loops to be asked one by one, whatever else is here.
    """

    stable: Flags
    values: dict[str, NDArray[Any]]
    reasons: list[tuple[Flags, str]]
    alone: Flags


def _of_the_loop(
    loops: LoopColumns,
    crossovers: Array,
    asked: list[str],
    values: dict[str, NDArray[Any]],
    chosen: Places,
    alone: Flags,
) -> None:
    """Enter what is asked of the stable loops in the frequency domain; few at a time, which suits the cache."""
    for start in range(0, chosen.size, AT_A_TIME):
        part = chosen[start : start + AT_A_TIME]
        found = FrequencyMetrics(loops.take(part), crossovers[:, part])
        for name in asked:
            values[name][part] = getattr(found, name)() * loops.time ** IN_TIME.get(name, 0)
        alone[part] |= found.doubtful


def answered(metrics: tuple[str, ...]) -> tuple[str, ...]:
    """Return the metrics that blocks can answer."""
    known = {
        STABLE,
        POLE,
        *OF_THE_LOOP,
        *OF_A_RESPONSE,
        *(LOAD + name for name in (*OF_A_RESPONSE, ABOVE)),
    }
    return tuple(name for name in metrics if name in known)


def is_batched(plant: Plant, form: PID, count: int) -> bool:
    """Whether loops of a plant and a form of controller can be computed as a block."""
    return (
        count >= FEWEST
        and type(plant) is Plant
        and bool(plant.num[-1] != 0.0)
        and bool(form.k or form.ki or form.kd)
        and _is_proper(plant, form)
    )


def _is_proper(plant: Plant, form: PID) -> bool:
    """Whether the loop gain stays finite at high frequency, without dead time: vanishes there."""
    num, den = form.measurement_filter_polynomials()
    excess = plant.den.size - plant.num.size + den.size - num.size
    ideal = bool(form.kd and not form.derivative_filter)
    # a loop without dead time is closed at once: what jumps there is left to the single loop
    return excess >= int(ideal) + int(not plant.dead_time) and not (ideal and form.c and not plant.dead_time)


def block_metrics(loops: LoopColumns, metrics: tuple[str, ...], until: float | None, band: float) -> BlockMetrics:
    """Return the metrics, which `answered` must contain, of loops for which `is_batched`."""
    decided, crossovers = stability(loops)
    stable, alone = decided == IS_STABLE, decided == UNDECIDED
    values: dict[str, NDArray[Any]] = {
        name: np.full(len(loops), np.nan) for name in metrics if name not in {STABLE, POLE}
    }
    reasons = [(~stable & ~alone, UNSTABLE)] if values else []
    if POLE in metrics:
        pole, proven = rightmost_poles(loops)
        values[POLE] = pole / loops.time
        alone |= ~proven
    chosen = np.nonzero(stable)[0]
    asked = [name for name in values if name in OF_THE_LOOP]
    if asked:
        _of_the_loop(loops, crossovers, asked, values, chosen, alone)
    for load in (False, True):
        asked = [name for name in values if name.startswith(LOAD) == load and name not in {POLE, *OF_THE_LOOP}]
        if not asked or chosen.size == 0:
            continue
        end = None if until is None else until / loops.time
        setpoint, step, part = 0.0 if load else 1.0, loops.gain if load else 0.0, chosen
        for shorter in SHORTER:  # again, with shorter pieces, for loops that need them
            if part.size == 0:
                break
            moved = any(name.endswith(VARIATION) for name in asked)
            responses = march(loops.take(part), setpoint, step, end, shorter, control=moved)
            if not responses.pieces:  # nothing here has a final value to settle to
                alone[part] = True
                break
            found = ResponseMetrics(responses)
            for name in asked:
                value, missing, why = _answer(found, name.removeprefix(LOAD), band, loops)
                values[name][part] = np.where(missing, np.nan, value)
                flags = np.zeros(len(loops), dtype=bool)
                flags[part] = missing & ~found.doubtful
                if flags.any():
                    reasons.append((flags, f"{name}: {why}"))
            again = responses.unresolved if shorter != SHORTER[-1] else np.zeros(part.size, dtype=bool)
            alone[part] |= found.doubtful & ~again
            part = part[again]
    return BlockMetrics(stable, values, reasons, alone)


def _answer(found: ResponseMetrics, name: str, band: float, loops: LoopColumns) -> tuple[Array, Flags, str]:
    """Return the values of a metric in the user's units, where they are missing, and why."""
    missing, why = np.zeros(found.count, dtype=bool), ""
    by = f"by t = {found.end * loops.time:g}"
    if name in RELATIVE and not found.final.any():  # the load responses of loops with integral action
        value, missing = np.full(found.count, np.nan), np.ones(found.count, dtype=bool)
        why = f"{name.replace('_', ' ')} is relative to the final value, which is 0 here"
    elif name in {"settling_time", ABOVE}:
        value, missing = found.settling_time(band, one_sided=name == ABOVE)
        why = f"the response has not settled within {band:g} of its final value {by}"
    elif name == "delay_time":
        value, missing = found.first_reach(0.5)
        why = f"the response does not reach 0.5 of its final value {by}"
    elif name == "rise_time":
        (low, _), (high, missing) = found.first_reach(0.1), found.first_reach(0.9)
        value, why = high - low, f"the response does not reach 0.9 of its final value {by}"
    else:
        value = getattr(found, name)()
    if name == VARIATION:
        return value / loops.gain * np.ones(found.count), missing, why
    power = 0 if name in OF_THE_SIZE else 2 if name in OF_A_SQUARE else 1
    return value * loops.time**power, missing, why
