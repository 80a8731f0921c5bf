"""Simple models that tuning rules are made for, read off a plant or reduced from it by Skogestad's half rule."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.plant import Plant

ComplexArray = NDArray[np.complex128]

_LINKED = 0.02  # relative distance at which roots may be one multiple root, split by rounding


@dataclass(frozen=True)
class LagModel:
    """``gain e^{-Ls} / (s^integrators (T1 s + 1)(T2 s + 1)...)``, time constants descending.

    Attributes
    ----------
    gain
        Static gain, or the limit of ``s^integrators G(s)`` for s to 0.
    time_constants
        All positive, largest first.
    dead_time
        L, with what a reduction has added to it.
    integrators
        Number of poles at s = 0.

    Examples
    --------
    >>> LagModel(gain=2.0, time_constants=(4.0, 1.0), dead_time=0.5, integrators=0)  # 2 e^{-s/2}/((4s + 1)(s + 1))
    LagModel(gain=2.0, time_constants=(4.0, 1.0), dead_time=0.5, integrators=0)
    """

    gain: float
    time_constants: tuple[float, ...]
    dead_time: float
    integrators: int


def lag_model(plant: Plant) -> LagModel:
    r"""Return a plant as gain, lags and dead time; zeros in the right half-plane are dead time, :math:`1 - Ts`.

    Parameters
    ----------
    plant
        Rational up to its dead time, with real stable poles and integrators.

    Raises
    ------
    LoopError
        If the plant is not rational, has complex or unstable poles, or zeros in the left half-plane.

    Examples
    --------
    A zero to the right, 1 - s, is a dead time of 1:

    >>> lag_model(Plant([-2.0, 2.0], [4.0, 5.0, 1.0], dead_time=1.0))
    LagModel(gain=2.0, time_constants=(4.0, 1.0), dead_time=2.0, integrators=0)
    """
    checks.instance("the plant of a tuning rule", plant, Plant, "a Plant")
    if not plant.is_rational:
        msg = f"tuning rules are made for a rational plant with one dead time, not for {plant!r}"
        raise LoopError(msg)
    integrators = plant.integrators
    lags = _times(_clustered(np.roots(plant.den[: plant.den.size - integrators])), "pole")
    inverse = _times(-_clustered(np.roots(plant.num)), "zero, apart from one to the right,")
    gain = float(plant.num[-1] / plant.den[plant.den.size - 1 - integrators])
    return LagModel(gain, lags, plant.dead_time + sum(inverse), integrators)


def half_rule(plant: Plant, order: int = 1) -> LagModel:
    """Return the model with at most ``order`` lags (an integrator counts as one) by the half rule.

    Half of the largest neglected time constant is added to the smallest kept one, the other half and all smaller ones
    to the dead time; with nothing but integrators kept, all of it is dead time.

    Parameters
    ----------
    plant
        As for `lag_model`.
    order
        The number of lags.

    Raises
    ------
    LoopError
        As `lag_model`; or if the plant has more integrators than the model.

    References
    ----------
    S. Skogestad, J. Process Control 13 (2003) 291, section 2.

    Examples
    --------
    >>> half_rule(Plant([2.0], [4.0, 5.0, 1.0], dead_time=1.0))  # lags 4 and 1
    LagModel(gain=2.0, time_constants=(4.5,), dead_time=1.5, integrators=0)
    """
    model = lag_model(plant)
    room = checks.whole("the order of a model", order) - model.integrators
    if room < 0:
        msg = f"a model of order {order} cannot hold the plant's {model.integrators} integrators"
        raise LoopError(msg)
    kept, neglected = list(model.time_constants[:room]), model.time_constants[room:]
    delay = model.dead_time + sum(neglected)
    if kept and neglected:
        kept[-1] += 0.5 * neglected[0]
        delay -= 0.5 * neglected[0]
    return LagModel(model.gain, tuple(sorted(kept, reverse=True)), delay, model.integrators)


def exact_first_order(plant: Plant, rule: str) -> LagModel:
    """Return the model of a plant that is ``K e^{-Ls}/(Ts + 1)`` or ``K e^{-Ls}/s``, with dead time, itself.

    Raises
    ------
    LoopError
        If it is another one; the message names the rule and how to reduce the plant.
    """
    model = lag_model(plant)
    if len(model.time_constants) + model.integrators != 1 or plant.num.size > 1:
        advice = "tune.half_rule reduces a plant"
        msg = f"{rule} is made for K e^{{-Ls}}/(Ts+1) and K e^{{-Ls}}/s, not for {plant!r}; {advice}"
        raise LoopError(msg)
    if not model.dead_time:
        msg = f"{rule} needs a plant with dead time"
        raise LoopError(msg)
    return model


def direction(plant: Plant) -> float:
    """Return the sign of the plant's gain at low frequency, integrators taken out."""
    gain = plant.gain
    if math.isinf(gain):
        gain = float(plant.num[-1] * plant.den[plant.den.size - 1 - plant.integrators])
    return math.copysign(1.0, gain)


def _times(roots: ComplexArray, what: str) -> tuple[float, ...]:
    if np.any(roots.imag != 0.0) or np.any(roots.real >= 0.0):
        wrong = roots[(roots.imag != 0.0) | (roots.real >= 0.0)][0]
        msg = f"tuning rules are made for plants with real lags; every {what} must be real and stable, not {wrong:.4g}"
        raise LoopError(msg)
    return tuple(sorted((-1.0 / roots.real).tolist(), reverse=True))


def _clustered(roots: ArrayLike) -> ComplexArray:
    """Return roots with each multiple one, which rounding has split into a ring, replaced by its mean."""
    left = list(np.asarray(roots, dtype=complex))
    found: list[complex] = []
    while left:
        group, grown = [left.pop()], True
        while grown:
            near = [r for r in left if min(abs(r - g) for g in group) <= _LINKED * abs(r)]
            left = [r for r in left if r not in near]
            group += near
            grown = bool(near)
        mean = complex(np.mean(group))
        spread = max(abs(r - mean) for r in group)
        split_by_rounding = spread <= 30.0 * np.finfo(float).eps ** (1.0 / len(group)) * abs(mean)
        found += [complex(mean.real)] * len(group) if len(group) > 1 and split_by_rounding else group
    return np.array(found, dtype=complex)
