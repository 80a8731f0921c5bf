"""Everything one asks of a response, and of a loop, in one record."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.records import Record
from replicate.loops.time_domain.total_variation import total_variation

if TYPE_CHECKING:
    from replicate.loops.loop import Loop
    from replicate.loops.time_domain.signal import Signal

T = TypeVar("T")
NAN = float("nan")
ROUNDING = 5e-14  # a fraction of the final value that only rounding errors have


@dataclass(frozen=True, eq=False)
class SignalSummary(Record):
    """The metrics of a response; ``nan`` where one does not exist (no final value, not settled, unstable).

    Attributes
    ----------
    final
        Steady-state value.
    peak, peak_time, trough, trough_time
        Largest and smallest value and when they are reached.
    overshoot, undershoot
        By how much the response goes beyond its final value, and beyond zero on the other side: fractions of the final
        value.
    rise_time, delay_time, settling_time
        From 10 to 90 %, to 50 %, and into a band of 2 % for good.
    settling_min, settling_max
        Smallest and largest value from the end of the rise on.
    ie, iae, ise, itae, itse
        Integrals of the error over the horizon.
    total_variation
        The sum of all ups and downs, the jump at t = 0 included.
    """

    final: float
    peak: float
    peak_time: float
    trough: float
    trough_time: float
    overshoot: float
    undershoot: float
    rise_time: float
    delay_time: float
    settling_time: float
    settling_min: float
    settling_max: float
    ie: float
    iae: float
    ise: float
    itae: float
    itse: float
    total_variation: float

    def to_dict(self) -> dict[str, float]:
        """Return the metrics by name."""
        return dict(_items(self))

    def __str__(self) -> str:
        return _table(_items(self))

    def _repr_html_(self) -> str:
        return html_table(_items(self))


@dataclass(frozen=True, eq=False)
class LoopSummary(Record):
    """A loop at a glance; ``nan`` where an unstable loop has no such thing.

    Attributes
    ----------
    stable
        Whether all closed-loop poles lie in the open left half-plane.
    rightmost_pole
        The slowest mode; ``nan`` if there is none.
    ms, ms_frequency, mp, mp_frequency
        Peaks of |S| and |T| and where they are.
    gain_margin, phase_margin, delay_margin
        Factor, degrees, time.
    step, load
        The responses to unit steps of the set-point and of a load at the plant input; None if the loop is unstable or
        static.
    """

    stable: bool
    rightmost_pole: complex
    ms: float
    ms_frequency: float
    mp: float
    mp_frequency: float
    gain_margin: float
    phase_margin: float
    delay_margin: float
    step: SignalSummary | None
    load: SignalSummary | None

    def to_dict(self) -> dict[str, object]:
        """Return everything by name, the metrics of the responses as ``step.overshoot`` and so on."""
        return dict(self._items())

    def _items(self) -> Iterator[tuple[str, object]]:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, SignalSummary):
                yield from ((f"{field.name}.{name}", number) for name, number in _items(value))
            elif field.name not in {"step", "load"}:
                yield field.name, value

    def __str__(self) -> str:
        return _table(self._items())

    def _repr_html_(self) -> str:
        return html_table(self._items())


def summarize_signal(signal: Signal, band: float = 0.02) -> SignalSummary:
    """Return all metrics of a response, with the given settling band."""
    band = checks.settling_band(band)

    def get(metric: Callable[[], float]) -> float:
        try:
            return float(metric())
        except LoopError:
            return NAN

    peak, trough = signal.peak(), signal.trough()
    final = signal.final
    relative = np.isfinite(final) and final != 0.0
    backwards = -float(trough) / final if final > 0.0 else -float(peak) / final if relative else NAN
    rise = get(signal.rise_time)
    low, high = _range_after(signal, signal.first_reach(0.9 * final)) if math.isfinite(rise) else (NAN, NAN)
    return SignalSummary(
        final=final,
        peak=peak.value,
        peak_time=peak.time,
        trough=trough.value,
        trough_time=trough.time,
        overshoot=get(signal.overshoot),
        undershoot=(backwards if backwards > ROUNDING else 0.0) if relative else NAN,
        rise_time=rise,
        delay_time=get(signal.delay_time),
        settling_time=get(lambda: signal.settling_time(band)),
        settling_min=low,
        settling_max=high,
        **{name: get(getattr(signal, name)) for name in ("ie", "iae", "ise", "itae", "itse")},
        total_variation=total_variation(signal),
    )


def _range_after(signal: Signal, start: float) -> tuple[float, float]:
    """Return the smallest and largest value on [start, horizon]."""
    stationary = [point.value for point in signal.extrema() if point.time >= start]
    breaks = signal.breaks[signal.breaks >= start]
    values = np.concatenate([stationary, signal(np.concatenate([[start], breaks]))])
    return float(values.min()), float(values.max())


def summarize_loop(loop: Loop) -> LoopSummary:
    """Return the summary of a loop; never raises for one that is unstable or static."""
    pole = _if_any(loop.rightmost_pole)
    pole = complex(NAN, NAN) if pole is None else pole
    if not loop.is_stable():
        return LoopSummary(
            stable=False, rightmost_pole=pole, ms=NAN, ms_frequency=NAN, mp=NAN, mp_frequency=NAN, gain_margin=NAN,
            phase_margin=NAN, delay_margin=NAN, step=None, load=None,
        )  # fmt: skip
    ms, mp, margins = loop.sensitivity_peak(), loop.complementary_peak(), loop.margins()
    step, load = _if_any(loop.step), _if_any(loop.load_step)
    return LoopSummary(
        stable=True,
        rightmost_pole=pole,
        ms=ms.value,
        ms_frequency=ms.frequency,
        mp=mp.value,
        mp_frequency=mp.frequency,
        gain_margin=margins.gain,
        phase_margin=margins.phase,
        delay_margin=margins.delay,
        step=None if step is None else summarize_signal(step),
        load=None if load is None else summarize_signal(load),
    )


def _if_any(quantity: Callable[[], T]) -> T | None:
    """Return what a loop has, or None: a static loop has neither poles nor a horizon."""
    try:
        return quantity()
    except LoopError:
        return None


def _items(record: SignalSummary) -> Iterator[tuple[str, float]]:
    return ((field.name, getattr(record, field.name)) for field in fields(record))


def _table(items: Iterator[tuple[str, object]] | Iterator[tuple[str, float]]) -> str:
    return "\n".join(f"{name:24} {_written(value)}" for name, value in items)


def html_table(items: Iterator[tuple[str, object]] | Iterator[tuple[str, float]]) -> str:
    """Return pairs of name and value as an HTML table with two columns."""
    rows = "".join(f"<tr><th>{name}</th><td>{_written(value)}</td></tr>" for name, value in items)
    return f"<table>{rows}</table>"


def _written(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, (float, complex)) else str(value)
