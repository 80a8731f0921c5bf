"""Records of numbers some of which do not exist."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import numpy as np


class Record:
    """Base of frozen dataclasses, with ``eq=False``, in which a number that does not exist (nan) equals itself."""

    def _identity(self) -> tuple[object, ...]:
        return tuple(comparable(getattr(self, field.name)) for field in fields(self))  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        return self._identity() == other._identity() if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._identity())


def comparable(value: Any) -> object:
    """Return what stands for a value in comparisons: numbers that do not exist are alike, arrays are their numbers."""
    if isinstance(value, np.ndarray):
        return value.shape, comparable(value.ravel().tolist())
    if isinstance(value, dict):
        return tuple((name, comparable(item)) for name, item in value.items())
    if isinstance(value, list | tuple):
        return tuple(comparable(item) for item in value)
    return None if isinstance(value, float | complex) and math.isnan(abs(value)) else value
