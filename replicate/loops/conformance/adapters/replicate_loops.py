"""The library that this file is part of."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from replicate.loops import PID, Loop, LoopError, Plant, Signal
from replicate.loops.conformance.goldens import Golden
from replicate.loops.conformance.library import Library

Value = float | complex
ComplexArray = NDArray[np.complex128]


class _Ours:
    @property
    def title(self) -> str:
        return f"replicate.loops {importlib.metadata.version('paper-replicate')}"

    @property
    def settings(self) -> Sequence[str]:
        return ("exact",)

    def values(self, golden: Golden, setting: str) -> Mapping[str, Value]:  # noqa: ARG002
        plant = golden.record["plant"]
        loop = Loop(Plant(plant["num"], plant["den"], plant["dead_time"]), PID(**golden.record["controller"]))
        found: dict[str, Value] = {"stable": float(loop.is_stable())}
        for name, ask in _questions(loop, golden):
            try:
                found[name] = ask()
            except LoopError:
                found[name] = float("nan")
        return found


def _questions(loop: Loop, golden: Golden) -> Iterator[tuple[str, Callable[[], Value]]]:
    """Yield the name of each value and what computes it."""
    poles = cache(lambda: loop.poles(len(golden.record["poles"])))
    for index in range(len(golden.record["poles"])):
        yield f"pole {index + 1}", partial(_pole, poles, index)
    if golden.stable:
        yield "sensitivity_peak", lambda: loop.sensitivity_peak().value
        yield "complementary_peak", lambda: loop.complementary_peak().value
        yield "gain_margin", lambda: loop.margins().gain
        yield "gain_reduction_margin", lambda: loop.margins().gain_reduction
        yield "phase_margin", lambda: loop.margins().phase
        yield "delay_margin", lambda: loop.margins().delay
    until = 1.01 * max(golden.times)
    y, d = cache(lambda: loop.step(until=until)), cache(lambda: loop.load_step(until=until))
    for t in golden.times:
        yield f"step({t:g})", partial(_value, y, t)
        yield f"load_step({t:g})", partial(_value, d, t)
    if "metrics" in golden.record:
        yield from _metrics(loop)


def _pole(poles: Callable[[], ComplexArray], index: int) -> complex:
    found = poles()
    return complex(found[index]) if index < found.size else complex("nan")


def _value(response: Callable[[], Signal], t: float) -> float:
    return float(response()(t))


def _metrics(loop: Loop) -> Iterator[tuple[str, Callable[[], Value]]]:
    y, d = cache(loop.step), cache(loop.load_step)
    yield "overshoot", lambda: y().overshoot()
    yield "peak_time", lambda: (y().peak() if y().final > 0.0 else y().trough()).time
    yield "rise_time", lambda: y().rise_time()
    yield "settling_time", lambda: y().settling_time()
    largest = cache(lambda: max((d().peak(), d().trough()), key=abs))
    yield "load_peak", lambda: largest().value
    yield "load_peak_time", lambda: largest().time
    yield "load_ie", lambda: d().ie() if d().final == 0.0 else -d().ie()
    yield "load_iae", lambda: d().iae()


def library() -> Library:
    """Return the adapter."""
    return _Ours()
