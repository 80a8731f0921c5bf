"""The controllers of a sweep as arrays: their gains, and the few forms (filters, weights) that many share."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.sweep.axes import Axis

Array = NDArray[np.float64]

GAINS = ("k", "ki", "kd", "b")


@dataclass(frozen=True)
class ControllerTable:
    """Gains, shape (n,) each, and for each controller the number of its form.

    Two controllers have one form if they differ in the gains alone, and in no gain's being zero: the gains of a form
    are one or zero.
    """

    k: Array
    ki: Array
    kd: Array
    b: Array
    form: NDArray[np.intp]
    forms: tuple[PID, ...]

    @classmethod
    def of(cls, axis: Axis[PID]) -> ControllerTable:
        """Return the table of an axis of checked controllers."""
        if axis.numbers is not None:
            columns = [axis.numbers[:, i] if i < axis.numbers.shape[1] else None for i in range(4)]
            k, ki = (np.asarray(c, dtype=float) for c in columns[:2])
            kd = np.zeros_like(k) if columns[2] is None else columns[2]
            b = np.ones_like(k) if columns[3] is None else columns[3]
            base, bases = np.zeros(k.size, dtype=np.intp), [PID(1.0)]
        else:
            members = [axis[i] for i in range(len(axis))]
            k, ki, kd, b = (np.array([getattr(m, name) for m in members], dtype=float) for name in GAINS)
            known: dict[PID, int] = {}
            base = np.array([
                known.setdefault(form_of(m), len(known)) for m in members
            ], dtype=np.intp)  # fmt: skip
            bases = list(known)
        pattern = 4 * (k != 0.0) + 2 * (ki != 0.0) + (kd != 0.0)
        _, first, form = np.unique(8 * base + pattern, return_index=True, return_inverse=True)
        return cls(
            k,
            ki,
            kd,
            b,
            form,
            tuple(
                replace(bases[base[i]], k=float(k[i] != 0.0), ki=float(ki[i] != 0.0), kd=float(kd[i] != 0.0))
                for i in first
            ),
        )


def form_of(controller: PID) -> PID:
    """Return the form of a controller: the same with gains that count for nothing."""
    return PID(
        1.0, 0.0, 0.0, 1.0, controller.c, controller.derivative_filter, controller.measurement_filter,
        controller.measurement_filter_order, controller.setpoint_filter,
    )  # fmt: skip
